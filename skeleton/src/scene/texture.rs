//! Texture lookup.

use super::Texture;
use crate::math::{Rgb, Vec2};
use crate::srgb::srgb_to_linear_u8;

impl Texture {
    /// The linear colour at texture coordinates `uv`, by bilinear interpolation between texel centres. (0, 0) is the lower
    /// left corner; the texture repeats in both directions.
    pub(crate) fn lookup(&self, uv: Vec2) -> Rgb {
        let (u, v) = (uv.x - uv.x.floor(), uv.y - uv.y.floor());
        let x = u * self.width as f32 - 0.5;
        let y = (1.0 - v) * self.height as f32 - 0.5;
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |dx: i64, dy: i64| {
            let column = (x.floor() as i64 + dx).rem_euclid(i64::from(self.width)) as usize;
            let row = (y.floor() as i64 + dy).rem_euclid(i64::from(self.height)) as usize;
            let [r, g, b] = self.texels[row * self.width as usize + column];
            Rgb::new(srgb_to_linear_u8(r), srgb_to_linear_u8(g), srgb_to_linear_u8(b))
        };
        let top = (1.0 - fx) * texel(0, 0) + fx * texel(1, 0);
        let bottom = (1.0 - fx) * texel(0, 1) + fx * texel(1, 1);
        (1.0 - fy) * top + fy * bottom
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texel_centres_are_exact_and_the_texture_repeats() {
        let texture =
            Texture { width: 2, height: 2, texels: vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]] };
        let near = |uv: (f32, f32), color: Rgb| {
            let difference = texture.lookup(Vec2::new(uv.0, uv.1)) - color;
            assert!(difference.map(f32::abs).max_channel() < 1e-5, "{uv:?}: {difference:?}");
        };
        near((0.25, 0.75), Rgb::new(1.0, 0.0, 0.0)); // upper left
        near((0.25, 0.25), Rgb::new(0.0, 0.0, 1.0)); // lower left
        near((-3.75, 5.25), Rgb::new(0.0, 0.0, 1.0)); // the same, repeated
        near((0.5, 0.75), Rgb::new(0.5, 0.5, 0.0)); // halfway between two texels
        near((0.0, 0.75), Rgb::new(0.5, 0.5, 0.0)); // across the seam
    }
}
