//! An image that grows before one's eyes: live view in [tev](https://github.com/Tom94/tev).

use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};

use super::{Image, channel_names};

/// Where tev listens unless told otherwise.
pub const DEFAULT_ADDRESS: &str = "127.0.0.1:14158";

/// The port of [`DEFAULT_ADDRESS`], for an address that names only a host.
const DEFAULT_PORT: u16 = 14158;

/// How long to wait for the viewer to accept a connection, and then each time to take some data.
const PATIENCE: Duration = Duration::from_secs(2);

/// Pixels are sent in bands of rows of about this many, so that a packet stays small and the image
/// appears bit by bit.
const PIXELS_PER_PACKET: usize = 1 << 18;

/// The viewer cannot be reached, or can no longer. Rendering goes on without it, hence this is a warning.
#[derive(Debug, thiserror::Error)]
#[error("the tev viewer at {address} cannot be reached ({reason}); rendering goes on without it")]
pub struct ViewerLost {
    address: String,
    reason: io::Error,
}

/// One image in a running viewer.
#[derive(Debug)]
pub struct LiveView {
    address: String,
    picture_name: String,
    /// None once the viewer was lost.
    client: Option<TevClient>,
}

impl LiveView {
    /// Creates a black image with the given layers (see [`channel_names`]) in the viewer at `address`,
    /// which is `host:port` or a host alone.
    ///
    /// # Errors
    ///
    /// If no viewer takes the connection within two seconds (for each address that the host has; looking up a
    /// host by name has a time limit of its own).
    pub fn open(
        address: &str,
        picture_name: &str,
        width: u32,
        height: u32,
        layers: &[&str],
    ) -> Result<Self, ViewerLost> {
        let lost = |reason| ViewerLost { address: address.to_owned(), reason };
        let mut client = TevClient::wrap(connect(address).map_err(lost)?);
        // The protocol ends names at a zero byte.
        let picture_name = picture_name.replace('\0', "");
        let channels: Vec<String> = layers.iter().flat_map(|layer| channel_names(layer)).collect();
        client
            .send(PacketCreateImage {
                image_name: &picture_name,
                grab_focus: true,
                width,
                height,
                channel_names: &channels,
            })
            .map_err(lost)?;
        Ok(Self { address: address.to_owned(), picture_name, client: Some(client) })
    }

    /// Shows `image`, which has the size of the image, as one of its layers.
    ///
    /// # Errors
    ///
    /// The first time that the viewer does not take the data. Later calls do nothing.
    pub fn show(&mut self, layer: &str, image: &Image) -> Result<(), ViewerLost> {
        let Some(client) = &mut self.client else { return Ok(()) };
        send(client, &self.picture_name, layer, image).map_err(|reason| {
            self.client = None;
            ViewerLost { address: self.address.clone(), reason }
        })
    }
}

/// Connects to the first of the host's addresses that answers.
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
fn send(client: &mut TevClient, picture_name: &str, layer: &str, image: &Image) -> io::Result<()> {
    let width = image.width();
    // A packet without pixels is not allowed.
    if width == 0 {
        return Ok(());
    }
    let rows_per_packet = (PIXELS_PER_PACKET / width).max(1);
    for (band, pixels) in image.pixels().chunks(rows_per_packet * width).enumerate() {
        let data: Vec<f32> = pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
        client.send(PacketUpdateImage {
            image_name: picture_name,
            grab_focus: false,
            channel_names: &channel_names(layer),
            // Red, green and blue of a pixel stand side by side.
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
