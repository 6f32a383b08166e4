//! Live view in [tev](https://github.com/Tom94/tev).

use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};

use super::{Image, channel_names};

/// The default address of tev.
pub const DEFAULT_ADDRESS: &str = "127.0.0.1:14158";

/// The default port, for addresses without one.
const DEFAULT_PORT: u16 = 14158;

/// Timeout for connecting, and for each write.
const PATIENCE: Duration = Duration::from_secs(2);

/// Approximate number of pixels per packet, so that packets are small and the image appears gradually.
const PIXELS_PER_PACKET: usize = 1 << 18;

/// The viewer is not reachable, or no longer. Rendering continues without it, so this is a warning.
#[derive(Debug, thiserror::Error)]
#[error("cannot reach the tev viewer at {address} ({reason}); continuing without it")]
pub struct ViewerLost {
    address: String,
    reason: io::Error,
}

/// One image in a running viewer.
#[derive(Debug)]
pub struct LiveView {
    address: String,
    image_name: String,
    /// `None` once the connection is lost.
    client: Option<TevClient>,
}

impl LiveView {
    /// Creates a black image with the given layers (see [`channel_names`]) in the viewer at `address`,
    /// which is `host:port` or a host alone.
    ///
    /// # Errors
    ///
    /// If no viewer accepts the connection within two seconds (per address of the host; DNS lookup has its own timeout).
    pub fn open(
        address: &str,
        image_name: &str,
        width: u32,
        height: u32,
        layers: &[&str],
    ) -> Result<Self, ViewerLost> {
        let lost = |reason| ViewerLost { address: address.to_owned(), reason };
        let mut client = TevClient::wrap(connect(address).map_err(lost)?);
        // In the protocol, names end at a zero byte.
        let image_name = image_name.replace('\0', "");
        let channels: Vec<String> = layers.iter().flat_map(|layer| channel_names(layer)).collect();
        client
            .send(PacketCreateImage {
                image_name: &image_name,
                grab_focus: true,
                width,
                height,
                channel_names: &channels,
            })
            .map_err(lost)?;
        Ok(Self { address: address.to_owned(), image_name, client: Some(client) })
    }

    /// Sends `image`, which must have the size given to [`open`](Self::open), as one of the layers.
    ///
    /// # Errors
    ///
    /// The first failure to send data. Later calls do nothing.
    pub fn show(&mut self, layer: &str, image: &Image) -> Result<(), ViewerLost> {
        let Some(client) = &mut self.client else { return Ok(()) };
        send(client, &self.image_name, layer, image).map_err(|reason| {
            self.client = None;
            ViewerLost { address: self.address.clone(), reason }
        })
    }
}

/// Connects to the first address of the host that answers.
fn connect(address: &str) -> io::Result<TcpStream> {
    let candidates: Vec<_> = match address.contains(':') {
        true => address.to_socket_addrs()?.collect(),
        false => (address, DEFAULT_PORT).to_socket_addrs()?.collect(),
    };
    let mut outcome = Err(io::Error::new(io::ErrorKind::NotFound, "the host has no address"));
    for candidate in candidates {
        outcome = TcpStream::connect_timeout(&candidate, PATIENCE);
        if outcome.is_ok() {
            break;
        }
    }
    let stream = outcome?;
    stream.set_write_timeout(Some(PATIENCE))?;
    Ok(stream)
}

/// Sends all pixels of a layer.
fn send(client: &mut TevClient, image_name: &str, layer: &str, image: &Image) -> io::Result<()> {
    let width = image.width();
    // Packets without pixels are not allowed.
    if width == 0 {
        return Ok(());
    }
    let rows_per_packet = (PIXELS_PER_PACKET / width).max(1);
    for (band, pixels) in image.pixels().chunks(rows_per_packet * width).enumerate() {
        let data: Vec<f32> = pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
        client.send(PacketUpdateImage {
            image_name,
            grab_focus: false,
            channel_names: &channel_names(layer),
            // The channels are interleaved.
            channel_offsets: &[0, 1, 2],
            channel_strides: &[3, 3, 3],
            x: 0,
            y: (band * rows_per_packet) as u32,
            width: width as u32,
            height: (pixels.len() / width) as u32,
            data: &data,
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
