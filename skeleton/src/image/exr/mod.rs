//! Images to compute with: OpenEXR files of one part with named layers.
//!
//! The layers share one part and are told apart by the names of their channels (see [`channel_names`]),
//! which every viewer that knows layers understands, and one that does not shows the main image.

use std::collections::BTreeMap;

use super::{Image, channel_names};
use crate::math::Rgb;

mod read;
#[cfg(test)]
mod tests;
mod write;

/// How exactly samples are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits: every value is read back as it was, NaN and infinity included.
    Full,
    /// 16 bits, for images that are only looked at: about three digits, and finite values beyond ±65504
    /// become that.
    Half,
}

/// What an OpenEXR file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExrFile {
    /// Number of columns of every channel.
    pub width: usize,
    /// Number of rows of every channel.
    pub height: usize,
    /// `width * height` samples by the channel's name, row by row from the top, each row from the left.
    pub channels: BTreeMap<String, Vec<f32>>,
    /// Texts by name: the standard's `software`, `comments`, `owner` and `capDate`, and any of our own.
    ///
    /// Where `software` is missing, it is written as the name and version of this program.
    pub metadata: BTreeMap<String, String>,
}

impl ExrFile {
    /// A file that shows one image.
    pub fn new(picture: &Image) -> Self {
        let file = Self { width: picture.width(), height: picture.height(), ..Self::default() };
        file.with_layer("", picture)
    }

    /// This file with one more layer, in place of an earlier one of that name.
    ///
    /// # Panics
    ///
    /// If the layer has another size than the image.
    pub fn with_layer(mut self, name: &str, layer: &Image) -> Self {
        assert_eq!((layer.width(), layer.height()), (self.width, self.height), "all layers have one size");
        for (index, channel) in channel_names(name).into_iter().enumerate() {
            let samples = layer.pixels().iter().map(|pixel| pixel.to_array()[index]).collect();
            self.channels.insert(channel, samples);
        }
        self
    }

    /// This file with one more entry of its metadata, in place of an earlier one of that name.
    ///
    /// Names of our own should start with `arty:`, so that they never clash with anyone else's.
    pub fn with_metadata(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.metadata.insert(name.into(), value.into());
        self
    }

    /// One layer, or None if the file has not all three of its channels; the empty name is the main image.
    pub fn layer(&self, name: &str) -> Option<Image> {
        let mut image = Image::new(self.width, self.height);
        let [red, green, blue] = channel_names(name).map(|channel| self.channels.get(&channel));
        let (red, green, blue) = (red?, green?, blue?);
        for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
            *pixel = Rgb::new(*red.get(index)?, *green.get(index)?, *blue.get(index)?);
        }
        Some(image)
    }
}
