//! PNG files: 8-bit sRGB, for viewing.

use std::path::Path;

use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder};

use super::{Image, write_aside};
use crate::diagnostic::Diagnostic;
use crate::math::Rgb;
use crate::srgb::{exposure_factor, linear_to_srgb_u8};

/// The colour of NaN pixels, which should not be mistaken for dark ones: magenta.
const NOT_A_NUMBER: [u8; 3] = [255, 0, 255];

/// Writes an image as PNG with an exposure in stops, clamped to [0, 1].
///
/// Pixels with a NaN are magenta; infinite channels are at the maximum.
///
/// # Errors
///
/// If the image has no pixels or is too large for PNG, or as [`write_aside`]; an existing file is kept then.
pub fn write_png(path: &Path, image: &Image, exposure: f32) -> Result<(), Diagnostic> {
    let side = |length: usize| {
        // PNG does not use the highest bit.
        u32::try_from(length).ok().filter(|length| (1..1 << 31).contains(length)).ok_or_else(|| {
            let (width, height) = (image.width(), image.height());
            Diagnostic::about(path, format!("a PNG file cannot hold {width} x {height} pixels"))
        })
    };
    let (width, height) = (side(image.width())?, side(image.height())?);
    let factor = exposure_factor(exposure);
    let bytes: Vec<u8> = image.pixels().iter().flat_map(|pixel| displayed(*pixel, factor)).collect();
    write_aside(path, |file| {
        PngEncoder::new(file).write_image(&bytes, width, height, ExtendedColorType::Rgb8)
    })
}

/// The sRGB levels of a pixel, multiplied by the exposure factor.
fn displayed(pixel: Rgb, factor: f32) -> [u8; 3] {
    let channels = pixel.to_array();
    if channels.iter().any(|channel| channel.is_nan()) {
        return NOT_A_NUMBER;
    }
    channels.map(|channel| linear_to_srgb_u8(channel * factor))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(pixels: Vec<Rgb>, exposure: f32) -> Vec<[u8; 3]> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("picture.png");
        write_png(&path, &Image::from_pixels(pixels.len(), 1, pixels), exposure).expect("writing works");
        let read = ::image::open(&path).expect("a PNG file");
        assert_eq!(read.color(), ::image::ColorType::Rgb8);
        read.into_rgb8().pixels().map(|pixel| pixel.0).collect()
    }

    #[test]
    fn linear_values_are_encoded_as_srgb() {
        let pixels = [0.0, 0.003_130_8, 0.18, 0.5, 1.0, 7.0, -1.0].map(Rgb::gray);
        let levels = [0, 10, 118, 188, 255, 255, 0].map(|level| [level; 3]);
        assert_eq!(written(pixels.to_vec(), 0.0), levels);
        assert_eq!(written(vec![Rgb::new(1.0, 0.18, 0.0)], 0.0), [[255, 118, 0]]);
    }

    #[test]
    fn exposure_is_in_stops() {
        assert_eq!(written(vec![Rgb::gray(0.045)], 2.0), [[118; 3]]);
        assert_eq!(written(vec![Rgb::gray(0.36)], -1.0), [[118; 3]]);
    }

    #[test]
    fn nan_is_magenta_and_infinity_is_white() {
        let (nan, infinity) = (f32::NAN, f32::INFINITY);
        let pixels = vec![
            Rgb::new(0.0, nan, 0.0),
            Rgb::gray(infinity),
            Rgb::gray(-infinity),
            Rgb::new(infinity, 0.0, 0.0),
        ];
        assert_eq!(written(pixels.clone(), 0.0), [[255, 0, 255], [255; 3], [0; 3], [255, 0, 0]]);
        assert_eq!(written(pixels, -3.0)[1], [255; 3], "infinity stays white at any exposure");
    }

    #[test]
    fn rows_are_written_from_top_to_bottom() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("picture.png");
        let mut image = Image::new(2, 3);
        image[(1, 0)] = Rgb::WHITE;
        write_png(&path, &image, 0.0).expect("writing works");
        let read = ::image::open(&path).expect("a PNG file").into_rgb8();
        assert_eq!(read.dimensions(), (2, 3));
        assert_eq!(read.get_pixel(1, 0).0, [255; 3]);
        assert_eq!(read.get_pixel(0, 2).0, [0; 3]);
    }

    #[test]
    fn an_image_without_pixels_is_an_error_and_keeps_the_earlier_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("picture.png");
        std::fs::write(&path, "earlier").expect("writing works");
        let error = write_png(&path, &Image::new(0, 4), 0.0).expect_err("there is nothing to write");
        assert_eq!(error.message, "a PNG file cannot hold 0 x 4 pixels");
        assert_eq!(std::fs::read(&path).expect("the file is there"), b"earlier");
    }
}
