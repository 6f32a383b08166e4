//! Test for independence of the pixels of an image.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use verdict::check::PixelGroup;

use super::batches::Batches;

/// Maps a pixel (x, y) to its group.
type GroupOf = fn(u32, u32) -> (u32, u32);

/// Partitions of the pixels into groups.
const GROUPS: [(PixelGroup, GroupOf); 4] = [
    (PixelGroup::Image, |_, _| (0, 0)),
    (PixelGroup::Row, |_, y| (0, y)),
    (PixelGroup::Column, |x, _| (x, 0)),
    (PixelGroup::Tile, |x, y| (x / 4, y / 4)),
];

/// The result of the test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dependence {
    /// p-value under independence, corrected for the number of partitions.
    pub p_value: f64,
    /// Variance of the sums over groups, relative to that of independent pixels.
    pub excess: f64,
    /// The partition with the strongest dependence.
    pub pixels: PixelGroup,
}

/// Tests whether pixels are correlated.
///
/// The batches of each pixel are standardised. The sum r of n independent pixels has the variance n, so that Σ r² / n
/// over all B batches and g groups follows χ² with g (B − 1) degrees of freedom; pixels that share random numbers give
/// up to n times that. Several partitions are tested (Bonferroni).
pub fn dependence(batches: &Batches, width: u32) -> Dependence {
    let count = batches.count();
    let pixels = batches.pixels();
    let residuals: Vec<Option<Vec<f64>>> = (0..pixels).map(|pixel| standardised(batches, pixel)).collect();
    let mut worst = Dependence { p_value: 1.0, excess: 1.0, pixels: GROUPS[0].0 };
    for (group, group_of) in GROUPS {
        let mut groups: std::collections::BTreeMap<(u32, u32), (u32, Vec<f64>)> = Default::default();
        for (pixel, residual) in residuals.iter().enumerate() {
            let Some(residual) = residual else { continue };
            let place = (pixel as u32 % width, pixel as u32 / width);
            let (members, sums) =
                groups.entry(group_of(place.0, place.1)).or_insert_with(|| (0, vec![0.0; count]));
            *members += 1;
            sums.iter_mut().zip(residual).for_each(|(sum, value)| *sum += value);
        }
        let larger = groups.values().filter(|(members, _)| *members > 1);
        let sum: f64 = larger
            .clone()
            .map(|(members, sums)| sums.iter().map(|sum| sum * sum).sum::<f64>() / f64::from(*members))
            .sum();
        let degrees_of_freedom = larger.count() as f64 * (count as f64 - 1.0);
        let Ok(distribution) = ChiSquared::new(degrees_of_freedom) else { continue };
        let p_value = (GROUPS.len() as f64 * distribution.sf(sum)).min(1.0);
        if p_value < worst.p_value {
            worst = Dependence { p_value, excess: sum / degrees_of_freedom, pixels: group };
        }
    }
    worst
}

/// The sum of the pixel's channels in each batch, minus its mean and divided by its standard deviation; `None` if it
/// does not vary.
fn standardised(batches: &Batches, pixel: usize) -> Option<Vec<f64>> {
    let count = batches.count() as f64;
    let mut sums = vec![0.0; batches.count()];
    for channel in 0..3 {
        sums.iter_mut().zip(batches.values(pixel, channel)).for_each(|(sum, value)| *sum += value);
    }
    let mean = sums.iter().sum::<f64>() / count;
    let squares: f64 = sums.iter().map(|value| (value - mean).powi(2)).sum();
    let deviation = (squares / (count - 1.0)).sqrt();
    // Variation up to this is rounding, not noise.
    (deviation > 1e-6 * mean.abs()).then(|| sums.iter().map(|value| (value - mean) / deviation).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use arty::sampler::Sampler;

    /// Tests exponential samples. `stream` maps a pixel to its stream of random numbers.
    fn seen(seed: u64, stream: impl Fn(u32) -> u32) -> Dependence {
        let value = |batch: u32, pixel: u32| {
            let u = Sampler::new(seed, (batch, stream(pixel)), 0).next_1d();
            [-(1.0 - u).ln() * (1.0 + pixel as f32); 3]
        };
        let images: Vec<Vec<[f32; 3]>> =
            (0..64).map(|batch| (0..256).map(|pixel| value(batch, pixel)).collect()).collect();
        let mut batches = Batches::default();
        batches.extend(&images, 1);
        dependence(&batches, 16)
    }

    #[test]
    fn independent_pixels_pass() {
        // At a level of 1e-3 more than one of forty is flagged once in 1,300 sets of seeds.
        let flagged = (0..40).filter(|&seed| seen(seed, |pixel| pixel).p_value < 1e-3).count();
        assert!(flagged <= 1, "{flagged} of 40");
    }

    #[test]
    fn shared_random_numbers_are_detected() {
        for (name, stream) in [
            ("all", (|_| 0) as fn(u32) -> u32),
            ("pairs in a row", |pixel| pixel / 2),
            ("sixteen in a row", |pixel| pixel / 16),
            ("columns", |pixel| pixel % 16),
        ] {
            for seed in 0..5 {
                let found = seen(seed, stream);
                assert!(found.p_value < 1e-6, "{name}: {found:?}");
            }
        }
    }
}
