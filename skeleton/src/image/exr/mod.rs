//! OpenEXR files: linear data in one part with named layers.
//!
//! Layers are distinguished by the names of their channels (see [`channel_names`]). Viewers without support for layers show
//! the main image.

use std::collections::BTreeMap;

use super::{Image, channel_names};
use crate::math::Rgb;

mod read;
#[cfg(test)]
mod tests;
mod write;

/// Sample format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits: lossless, including NaN and infinity.
    Full,
    /// 16 bits, for viewing: about three digits; finite values are clamped to ±65504.
    Half,
}

/// The contents of an OpenEXR file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExrFile {
    /// Width of all channels.
    pub width: usize,
    /// Height of all channels.
    pub height: usize,
    /// For each channel `width * height` samples, row by row from the top, each row from the left.
    pub channels: BTreeMap<String, Vec<f32>>,
    /// Text attributes: the standard ones `software`, `comments`, `owner` and `capDate`, and custom ones.
    ///
    /// If `software` is missing, the name and version of this program are written.
    pub metadata: BTreeMap<String, String>,
}

impl ExrFile {
    /// A file with one image.
    pub fn new(image: &Image) -> Self {
        let file = Self { width: image.width(), height: image.height(), ..Self::default() };
        file.with_layer("", image)
    }

    /// Adds or replaces a layer.
    ///
    /// # Panics
    ///
    /// If the layer has another size than the image.
    pub fn with_layer(mut self, name: &str, layer: &Image) -> Self {
        assert_eq!(
            (layer.width(), layer.height()),
            (self.width, self.height),
            "all layers have the same size"
        );
        for (index, channel) in channel_names(name).into_iter().enumerate() {
            let samples = layer.pixels().iter().map(|pixel| pixel.to_array()[index]).collect();
            self.channels.insert(channel, samples);
        }
        self
    }

    /// Adds or replaces a text attribute. Custom names start with `arty:` by convention, to avoid conflicts.
    pub fn with_metadata(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.metadata.insert(name.into(), value.into());
        self
    }

    /// A layer; the empty name is the main image. `None` unless all three channels exist.
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
