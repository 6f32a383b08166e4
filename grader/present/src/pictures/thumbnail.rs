//! A small picture of a submission, for the page of its class.

use arty::srgb::linear_to_srgb_u8;
use half::f16;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use verdict::pictures::Picture;

/// The scene that it shows: all three techniques give the same picture there, and most mistakes show.
pub(super) const SCENE: &str = "cornell_box";

/// Columns.
const WIDTH: usize = 80;

/// What stands for NaN and infinity, which would look like a dark or a bright pixel: magenta.
const NOT_A_NUMBER: [u8; 3] = [255, 0, 255];

/// A small PNG of what the last technique gives, which the others lead to; `None` if there is no such picture.
pub fn thumbnail(pictures: &[Picture]) -> Option<Vec<u8>> {
    let picture = pictures.iter().find(|picture| picture.scene == SCENE)?;
    let rendered = picture.rendered.last()?;
    let (columns, rows) = (picture.width, picture.height);
    if rendered.radiance.len() != 3 * columns * rows || columns == 0 || rows == 0 {
        return None;
    }
    let width = WIDTH.min(columns);
    let height = (rows * width / columns).max(1);
    let value = |x: usize, y: usize, c: usize| {
        f64::from(f16::from_bits(rendered.radiance[3 * (y * columns + x) + c]).to_f32())
    };
    // The mean of all pixels that lie in one of the small picture.
    let small = |x: usize, y: usize| -> [f64; 3] {
        let (left, right) = (x * columns / width, (x + 1) * columns / width);
        let (top, bottom) = (y * rows / height, (y + 1) * rows / height);
        let count = ((right - left) * (bottom - top)) as f64;
        std::array::from_fn(|c| {
            let pixels = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
            pixels.map(|(x, y)| value(x, y, c)).sum::<f64>() / count
        })
    };
    let pixels: Vec<[f64; 3]> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| small(x, y)).collect();
    png(&pixels, width, height)
}

/// Radiance as a PNG, clipped at the display's black and white; `None` if there are no pixels.
pub fn png(pixels: &[[f64; 3]], width: usize, height: usize) -> Option<Vec<u8>> {
    let shown = |pixel: &[f64; 3]| {
        if pixel.iter().all(|value| value.is_finite()) {
            pixel.map(|value| linear_to_srgb_u8(value as f32))
        } else {
            NOT_A_NUMBER
        }
    };
    let bytes: Vec<u8> = pixels.iter().flat_map(shown).collect();
    let mut png = Vec::new();
    PngEncoder::new(&mut png)
        .write_image(&bytes, width as u32, height as u32, ExtendedColorType::Rgb8)
        .ok()?;
    Some(png)
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::picture;

    #[test]
    fn a_thumbnail_is_a_png_of_the_scene_that_all_have() {
        assert_eq!(thumbnail(&[picture("veach_mis")]), None);
        let png = thumbnail(&[picture("veach_mis"), picture(SCENE)]).expect("the scene is there");
        let read = image::load_from_memory(&png).expect("a PNG").into_rgb8();
        assert_eq!(read.dimensions(), (2, 1));
        assert_eq!(read.get_pixel(0, 0).0, [255, 255, 188]);
    }
}
