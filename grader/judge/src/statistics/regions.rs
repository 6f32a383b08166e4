//! Regions of an image at several scales.
//!
//! A mistake can darken the whole image by a percent, or one corner by half. Large tiles detect the former, small
//! tiles the latter.

use verdict::check::{Channel, RegionId, RegionKind};

use super::expected::Expected;

/// Rec. 709 weights of luminance, which is tested like a fourth channel.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Luminance of a linear colour.
pub fn luminance(values: &[f64; 3]) -> f64 {
    (0..3).map(|channel| LUMINANCE[channel] * values[channel]).sum()
}

/// Number of levels of the pyramid, which have 1, 4, 16 and 64 tiles.
pub const LEVELS: u32 = 4;

/// A weighted sum over the pixels and channels of an image, such as the mean of a tile.
#[derive(Clone, Debug)]
pub struct Region {
    /// Identity of the region in reports.
    pub id: RegionId,
    /// Level of the pyramid: the image has 2^level tiles along each side.
    pub level: u32,
    /// Indices of the pixels, and weights of their channels.
    pub weights: Vec<(usize, [f64; 3])>,
}

/// All tiles of all levels, each for red, green, blue and luminance. Levels with tiles smaller than a pixel are
/// omitted.
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
                let channels = [
                    (Channel::Red, [1.0, 0.0, 0.0]),
                    (Channel::Green, [0.0, 1.0, 0.0]),
                    (Channel::Blue, [0.0, 0.0, 1.0]),
                ];
                for (channel, weights) in channels {
                    regions.push(tile.region(level, weights, RegionKind::Channel(channel)));
                }
                regions.push(tile.region(level, LUMINANCE, RegionKind::Luminance));
            }
        }
    }
    regions
}

/// The whole image, with pixels weighted by the inverse of a correct estimator's relative variance.
///
/// A plain mean is as noisy as its worst pixels, such as those on the edge of a visible light. The optimal estimate of
/// a relative error common to all pixels weights the ratio of a pixel to its mean m by 1/r², where r² is the relative
/// variance of one sample. Here the weight is 1/(r² + r̄²) with the median r̄², so that no pixel with hardly any noise
/// dominates.
pub fn weighted_image(expected: &Expected) -> Region {
    let means: Vec<f64> = expected.mean.iter().map(luminance).collect();
    let relative_variance = |(deviation, &mean): (&[f64; 3], &f64)| {
        if mean > 0.0 { (luminance(deviation) / mean).powi(2) } else { 0.0 }
    };
    let relative_variances: Vec<f64> = expected.deviation.iter().zip(&means).map(relative_variance).collect();
    let mut sorted: Vec<f64> =
        relative_variances.iter().zip(&means).filter(|(_, mean)| **mean > 0.0).map(|(r2, _)| *r2).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0).max(1e-12);
    let weight = |(&r2, &mean): (&f64, &f64)| if mean > 0.0 { 1.0 / (mean * (r2 + median)) } else { 0.0 };
    let raw: Vec<f64> = relative_variances.iter().zip(&means).map(weight).collect();
    // Normalised, as for a tile: the weighted sum of a constant grey image is its luminance relative to the mean.
    let total: f64 = raw.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let weights = raw
        .iter()
        .enumerate()
        .map(|(pixel, weight)| (pixel, LUMINANCE.map(|channel| channel * weight / total)))
        .collect();
    Region { id: RegionId { kind: RegionKind::Weighted, pixels: None }, level: 0, weights }
}

struct Tile {
    width: u32,
    height: u32,
    across: u32,
    row: u32,
    column: u32,
}

impl Tile {
    fn region(&self, level: u32, channel: [f64; 3], kind: RegionKind) -> Region {
        let range = |size: u32, index: u32| size * index / self.across..size * (index + 1) / self.across;
        let (columns, rows) = (range(self.width, self.column), range(self.height, self.row));
        let pixels = f64::from((columns.end - columns.start) * (rows.end - rows.start));
        let weight = channel.map(|weight| weight / pixels);
        let row = |y: u32| columns.clone().map(move |x| ((y * self.width + x) as usize, weight));
        let weights = rows.clone().flat_map(row).collect();
        let range = |range: &std::ops::Range<u32>| [range.start, range.end - 1];
        let pixels = (level > 0).then(|| [range(&columns), range(&rows)]);
        Region { id: RegionId { kind, pixels }, level, weights }
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
            let luminances = regions
                .iter()
                .filter(|region| region.level == level && region.id.kind == RegionKind::Luminance);
            let mut cover = vec![0; 16 * 12];
            for region in luminances {
                let sum: f64 = region.weights.iter().flat_map(|(_, weights)| weights).sum();
                assert!((sum - 1.0).abs() < 1e-9, "{:?}", region.id);
                for (pixel, _) in &region.weights {
                    cover[*pixel] += 1;
                }
            }
            assert!(cover.iter().all(|&count| count == 1), "level {level}");
        }
    }

    #[test]
    fn an_image_of_one_pixel_has_one_tile() {
        assert_eq!(pyramid(1, 1).len(), 4);
    }
}
