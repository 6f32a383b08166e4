use std::io::{self, Read};
use std::net::{TcpListener, TcpStream};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::*;
use crate::math::Rgb;

/// A packet as decoded by the viewer.
#[derive(Debug, PartialEq)]
enum Packet {
    Create {
        grab_focus: bool,
        name: String,
        size: [u32; 2],
        channels: Vec<String>,
    },
    Update {
        grab_focus: bool,
        name: String,
        channels: Vec<String>,
        corner: [u32; 2],
        size: [u32; 2],
        offsets: Vec<u64>,
        strides: Vec<u64>,
        data: Vec<f32>,
    },
}

/// The bytes of a packet, decoded as in tev's `Ipc.cpp`: little-endian, names terminated by a zero byte.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (first, rest) = self.0.split_first_chunk().expect("the packet is long enough");
        self.0 = rest;
        *first
    }

    fn flag(&mut self) -> bool {
        self.take::<1>()[0] == 1
    }

    fn number(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    fn text(&mut self) -> String {
        let end = self.0.iter().position(|byte| *byte == 0).expect("a text ends at a zero byte");
        let text = String::from_utf8(self.0[..end].to_vec()).expect("a text is UTF-8");
        self.0 = &self.0[end + 1..];
        text
    }

    fn packet(mut self) -> Packet {
        let kind = self.take::<1>()[0];
        let (grab_focus, name) = (self.flag(), self.text());
        let packet = match kind {
            4 => {
                let size = [self.number(), self.number()];
                let channels = (0..self.number()).map(|_| self.text()).collect();
                Packet::Create { grab_focus, name, size, channels }
            }
            6 => {
                let count = self.number() as usize;
                let channels = (0..count).map(|_| self.text()).collect();
                let corner = [self.number(), self.number()];
                let size = [self.number(), self.number()];
                let offsets = (0..count).map(|_| u64::from_le_bytes(self.take())).collect();
                let strides = (0..count).map(|_| u64::from_le_bytes(self.take())).collect();
                let data = (0..self.0.len() / 4).map(|_| f32::from_le_bytes(self.take())).collect();
                Packet::Update { grab_focus, name, channels, corner, size, offsets, strides, data }
            }
            _ => panic!("packet of kind {kind}"),
        };
        assert!(self.0.is_empty(), "something follows the packet");
        packet
    }
}

fn read_packet(stream: &mut TcpStream) -> io::Result<Packet> {
    let mut length = [0; 4];
    stream.read_exact(&mut length)?;
    // The length counts itself.
    let mut bytes = vec![0; u32::from_le_bytes(length) as usize - 4];
    stream.read_exact(&mut bytes)?;
    Ok(Bytes(&bytes).packet())
}

/// A viewer on a free port that decodes packets until the renderer disconnects.
fn viewer() -> (String, JoinHandle<Vec<Packet>>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    let packets = thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a renderer");
        std::iter::from_fn(|| read_packet(&mut stream).ok()).collect()
    });
    (address, packets)
}

fn counting(width: usize, height: usize) -> Image {
    let pixels = (0..width * height).map(|i| Rgb::new(i as f32, i as f32 + 0.25, i as f32 + 0.5));
    Image::from_pixels(width, height, pixels.collect())
}

#[test]
fn the_viewer_receives_the_image_and_its_layers() {
    let (address, packets) = viewer();
    let mut view = LiveView::open(&address, "a pic\0ture", 2, 1, &["", "variance"]).expect("it listens");
    view.show("", &counting(2, 1)).expect("it listens");
    view.show("variance", &Image::new(2, 1)).expect("it listens");
    drop(view);

    let texts = |texts: &[&str]| texts.iter().map(|text| text.to_string()).collect::<Vec<String>>();
    let update = |channels: &[&str], data: [f32; 6]| Packet::Update {
        grab_focus: false,
        name: "a picture".to_owned(),
        channels: texts(channels),
        corner: [0, 0],
        size: [2, 1],
        offsets: vec![0, 1, 2],
        strides: vec![3, 3, 3],
        data: data.to_vec(),
    };
    let expected = [
        Packet::Create {
            grab_focus: true,
            name: "a picture".to_owned(),
            size: [2, 1],
            channels: texts(&["R", "G", "B", "variance.R", "variance.G", "variance.B"]),
        },
        update(&["R", "G", "B"], [0.0, 0.25, 0.5, 1.0, 1.25, 1.5]),
        update(&["variance.R", "variance.G", "variance.B"], [0.0; 6]),
    ];
    assert_eq!(packets.join().expect("the viewer understood"), expected);
}

#[test]
fn a_large_image_arrives_in_bands_that_cover_it() {
    let (width, height) = (1000, 700);
    let image = counting(width, height);
    let (address, packets) = viewer();
    let mut view = LiveView::open(&address, "large", width as u32, height as u32, &[""]).expect("it listens");
    view.show("", &image).expect("it listens");
    drop(view);

    let packets = packets.join().expect("the viewer understood");
    assert!(packets.len() > 2, "one packet to create it, and several to fill it");
    let mut next_row = 0;
    let mut received = Vec::new();
    for packet in &packets[1..] {
        let Packet::Update { corner, size, data, .. } = packet else { panic!("{packet:?}") };
        assert_eq!((corner, size[0] as usize), (&[0, next_row], width));
        assert_eq!(data.len(), 3 * width * size[1] as usize);
        next_row += size[1];
        received.extend_from_slice(data);
    }
    assert_eq!(next_row as usize, height);
    let sent: Vec<f32> = image.pixels().iter().flat_map(|pixel| pixel.to_array()).collect();
    assert_eq!(received, sent);
}

#[test]
fn an_image_without_pixels_sends_nothing() {
    let (address, packets) = viewer();
    let mut view = LiveView::open(&address, "empty", 0, 0, &[""]).expect("it listens");
    view.show("", &Image::new(0, 3)).expect("there is nothing to send");
    view.show("", &Image::new(3, 0)).expect("there is nothing to send");
    drop(view);
    assert_eq!(packets.join().expect("the viewer understood").len(), 1);
}

#[test]
fn without_a_viewer_opening_fails_quickly_and_names_the_address() {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    drop(listener);
    let start = Instant::now();
    let error = LiveView::open(&address, "x", 1, 1, &[""]).expect_err("nothing listens");
    assert!(start.elapsed() < Duration::from_secs(10));
    assert!(error.to_string().starts_with(&format!("cannot reach the tev viewer at {address} (")));
    for nonsense in ["127.0.0.1:", "127.0.0.1:99999", ":::", ""] {
        assert!(LiveView::open(nonsense, "x", 1, 1, &[""]).is_err(), "{nonsense}");
    }
}

#[test]
fn a_lost_viewer_is_reported_once() {
    let (sender, hang_up) = std::sync::mpsc::channel();
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    let viewer = thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a renderer");
        read_packet(&mut stream).expect("the first packet");
        hang_up.recv().expect("the test continues");
    });
    let mut view = LiveView::open(&address, "x", 64, 64, &[""]).expect("it listens");
    sender.send(()).expect("the viewer waits for this");
    viewer.join().expect("the viewer is gone");

    // The system may accept some data before it detects that the viewer is gone.
    let image = Image::new(64, 64);
    let first_error = (0..1000).find_map(|_| {
        thread::sleep(Duration::from_millis(1));
        view.show("", &image).err()
    });
    assert!(first_error.is_some_and(|error| error.to_string().contains("continuing without it")));
    for _ in 0..3 {
        view.show("", &image).expect("no second complaint");
    }
}

#[test]
fn a_viewer_that_stops_reading_delays_the_renderer_only_briefly() {
    // Nothing accepts the connection, but the system accepts data until its buffers are full.
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    let mut view = LiveView::open(&address, "x", 4096, 4096, &[""]).expect("the system answers");
    let image = Image::new(4096, 4096);
    let start = Instant::now();
    view.show("", &image).expect_err("200 megabytes are more than any buffer holds");
    view.show("", &image).expect("no second complaint");
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}
