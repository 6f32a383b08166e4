//! The texture that the exercise needs.

use std::io::Cursor;

use image::{ImageFormat, Rgb, RgbImage};

/// Tiles in two colours, each with a lighter rim and a gradient over it, so that a texture that is upside
/// down, mirrored or shifted looks different.
pub(crate) fn tiles() -> Vec<u8> {
    const SIZE: u32 = 128;
    const TILE: u32 = SIZE / 2;
    const RIM: u32 = 2;
    let image = RgbImage::from_fn(SIZE, SIZE, |x, y| {
        let (in_tile_x, in_tile_y) = (x % TILE, y % TILE);
        let is_rim = [in_tile_x, in_tile_y].iter().any(|&place| !(RIM..TILE - RIM).contains(&place));
        if is_rim {
            return Rgb([190, 186, 178]);
        }
        let is_dark = (x / TILE + y / TILE) % 2 == 1;
        let base: [u32; 3] = if is_dark { [46, 72, 92] } else { [196, 178, 150] };
        // From the tile's upper left to its lower right corner it loses a quarter of its value.
        let share = 512 - (in_tile_x + in_tile_y);
        Rgb(base.map(|value| u8::try_from(value * share / 512).unwrap_or(u8::MAX)))
    });
    let mut png = Cursor::new(Vec::new());
    image.write_to(&mut png, ImageFormat::Png).expect("memory takes every picture");
    png.into_inner()
}
