//! Images: in memory, error metrics, files (OpenEXR, PNG), live view.

use std::ops::{Index, IndexMut};

use crate::math::Rgb;

pub mod error;
pub mod exr;
mod png;
mod save;
#[cfg(feature = "cli")]
pub mod tev;

pub use png::write_png;
pub use save::{check_writable, write_aside};

/// An image of linear RGB values, such as radiance or its variance.
///
/// `image[(x, y)]` is column `x`, counted from the left, of row `y`, counted from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: usize,
    height: usize,
    pixels: Vec<Rgb>,
}

impl Image {
    /// A black image.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![Rgb::BLACK; width * height] }
    }

    /// An image from its pixels, row by row from the top, each row from the left.
    ///
    /// # Panics
    ///
    /// If there are not `width * height` pixels.
    pub fn from_pixels(width: usize, height: usize, pixels: Vec<Rgb>) -> Self {
        assert_eq!(pixels.len(), width * height, "an image of {width} x {height} pixels");
        Self { width, height, pixels }
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row from the top, each row from the left.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// All pixels, mutable, in the same order as [`Image::pixels`].
    pub fn pixels_mut(&mut self) -> &mut [Rgb] {
        &mut self.pixels
    }

    /// The index of a pixel in [`Image::pixels`].
    fn position(&self, (x, y): (usize, usize)) -> usize {
        // Without this check a column beyond the right edge would be a pixel of the next row.
        assert!(x < self.width, "column {x} of an image of width {}", self.width);
        y * self.width + x
    }
}

impl Index<(usize, usize)> for Image {
    type Output = Rgb;

    fn index(&self, at: (usize, usize)) -> &Rgb {
        &self.pixels[self.position(at)]
    }
}

impl IndexMut<(usize, usize)> for Image {
    fn index_mut(&mut self, at: (usize, usize)) -> &mut Rgb {
        let position = self.position(at);
        &mut self.pixels[position]
    }
}

/// Names of the red, green and blue channel of a layer, by the convention of OpenEXR and tev.
///
/// The layer with the empty name is the main image with the channels `R`, `G` and `B`. Those of the layer `variance` are
/// `variance.R`, `variance.G` and `variance.B`.
pub fn channel_names(layer: &str) -> [String; 3] {
    ["R", "G", "B"].map(|channel| match layer {
        "" => channel.to_owned(),
        layer => format!("{layer}.{channel}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_ordered_row_by_row_from_the_top_left() {
        let pixels: Vec<Rgb> = (0..6).map(|i| Rgb::gray(i as f32)).collect();
        let mut image = Image::from_pixels(3, 2, pixels);
        assert_eq!(image[(2, 0)], Rgb::gray(2.0));
        assert_eq!(image[(0, 1)], Rgb::gray(3.0));
        image[(1, 1)] = Rgb::WHITE;
        assert_eq!(image.pixels()[4], Rgb::WHITE);
    }

    #[test]
    #[should_panic(expected = "column 3 of an image of width 3")]
    fn a_column_beyond_the_right_edge_is_not_a_pixel_of_the_next_row() {
        let _ = Image::new(3, 2)[(3, 0)];
    }

    #[test]
    fn channel_names_contain_the_layer() {
        assert_eq!(channel_names(""), ["R", "G", "B"]);
        assert_eq!(channel_names("variance"), ["variance.R", "variance.G", "variance.B"]);
    }
}
