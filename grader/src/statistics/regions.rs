//! Tiles of an image at several scales.
//!
//! A mistake can darken everything by a percent or one corner by half. Small tiles see the one badly and the other
//! well, large tiles the other way round; so both are looked at.

/// Rec. 709 weights: a fourth channel beside red, green and blue.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The levels of the pyramid: 1, 4, 16 and 64 tiles.
pub const LEVELS: u32 = 4;

/// A weighted sum over the pixels and channels of an image, such as the mean of a tile.
#[derive(Clone, Debug)]
pub struct Region {
    /// What it is, for reports: "whole image, green".
    pub name: String,
    /// 2^level tiles stand beside each other.
    pub level: u32,
    /// The weight of each pixel and channel.
    pub weights: Vec<[f64; 3]>,
    /// True for the luminance of a tile, false for one of its channels.
    pub is_luminance: bool,
    /// True for a sum whose weights have either sign.
    pub is_pattern: bool,
}

/// All tiles of all levels, each as red, green, blue and luminance. Levels with tiles smaller than a pixel are
/// left out.
pub fn pyramid(width: u32, height: u32) -> Vec<Region> {
    let mut regions = Vec::new();
    for level in 0..LEVELS {
        let across = 1 << level;
        if across > width.min(height) {
            break;
        }
        for row in 0..across {
            for column in 0..across {
                let tile = Tile { width, height, across, row, column };
                let channels =
                    [("red", [1.0, 0.0, 0.0]), ("green", [0.0, 1.0, 0.0]), ("blue", [0.0, 0.0, 1.0])];
                for (name, channel) in channels {
                    regions.push(tile.region(level, name, channel, false));
                }
                regions.push(tile.region(level, "luminance", LUMINANCE, true));
            }
        }
    }
    regions
}

struct Tile {
    width: u32,
    height: u32,
    across: u32,
    row: u32,
    column: u32,
}

impl Tile {
    fn region(&self, level: u32, channel_name: &str, channel: [f64; 3], is_luminance: bool) -> Region {
        let range = |size: u32, index: u32| size * index / self.across..size * (index + 1) / self.across;
        let (columns, rows) = (range(self.width, self.column), range(self.height, self.row));
        let pixels = f64::from((columns.end - columns.start) * (rows.end - rows.start));
        let mut weights = vec![[0.0; 3]; (self.width * self.height) as usize];
        for y in rows.clone() {
            for x in columns.clone() {
                weights[(y * self.width + x) as usize] = channel.map(|weight| weight / pixels);
            }
        }
        let place = match level {
            0 => "whole image".to_owned(),
            _ => format!("pixels {}–{} × {}–{}", columns.start, columns.end - 1, rows.start, rows.end - 1),
        };
        Region { name: format!("{place}, {channel_name}"), level, weights, is_luminance, is_pattern: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tiles_of_each_level_cover_every_pixel_once() {
        let regions = pyramid(16, 12);
        assert_eq!(regions.len(), 4 * (1 + 4 + 16 + 64));
        for level in 0..LEVELS {
            let luminances = regions.iter().filter(|region| region.level == level && region.is_luminance);
            let mut cover = vec![0; 16 * 12];
            for region in luminances {
                let sum: f64 = region.weights.iter().flatten().sum();
                assert!((sum - 1.0).abs() < 1e-9, "{}", region.name);
                for (count, weights) in cover.iter_mut().zip(&region.weights) {
                    *count += u32::from(weights[1] > 0.0);
                }
            }
            assert!(cover.iter().all(|&count| count == 1), "level {level}");
        }
    }

    #[test]
    fn an_image_of_one_pixel_is_one_tile() {
        assert_eq!(pyramid(1, 1).len(), 4);
    }
}
