//! HDR-FLIP: the difference that a viewer perceives when alternating between two pictures.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating
//! Images", HPG 2020; Andersson, Nilsson, Shirley, Akenine-Möller: "Visualizing Errors in Rendered High Dynamic Range
//! Images", Eurographics Short Papers 2021. Implemented from the papers: the existing Rust bindings of the authors'
//! program compare 8-bit pictures only and need a C++ compiler.

mod color;
mod filter;

use color::{from_ycxcz, hyab, luminance, to_hunt_lab, to_ycxcz};
use filter::{Feature, Plane, SENSITIVITIES, features, perceive};

/// Pixels per degree of visual angle, for a viewer 0.7 m from a screen that is 0.7 m and 3840 pixels wide.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * std::f64::consts::PI / 180.0;

/// The HDR-FLIP difference of two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct HdrFlip {
    /// Difference of each pixel, from 0 (none) to 1.
    pub map: Vec<f64>,
    /// Mean of the map.
    pub mean: f64,
    /// The exposures compared, in stops: the first, the last and their number.
    pub exposures: (f64, f64, usize),
}

/// Compares two linear HDR pictures: the maximum difference over a range of exposures. Values that are negative or not
/// finite count as 0. `None` if there are no pixels, or not `width · height`.
pub fn hdr_flip(
    picture: &[[f64; 3]],
    reference: &[[f64; 3]],
    width: usize,
    height: usize,
) -> Option<HdrFlip> {
    let count = width.checked_mul(height).filter(|&count| count > 0)?;
    if picture.len() != count || reference.len() != count {
        return None;
    }
    let (first, last) = exposures(reference);
    let steps = ((last - first).ceil() as usize).max(2);
    let mut map = vec![0.0_f64; count];
    for step in 0..steps {
        let exposure = first + (last - first) * step as f64 / (steps - 1) as f64;
        let shown = |pixels: &[[f64; 3]]| -> Vec<[f64; 3]> {
            pixels.iter().map(|pixel| pixel.map(|value| tone_map(value, exposure))).collect()
        };
        let difference = flip(&shown(picture), &shown(reference), width, height);
        map.iter_mut().zip(difference).for_each(|(max, value)| *max = max.max(value));
    }
    let mean = map.iter().sum::<f64>() / count as f64;
    Some(HdrFlip { map, mean, exposures: (first, last, steps) })
}

/// Narkowicz' fit of the ACES tone curve, (k₀x² + k₁x) / (k₂x² + k₃x + k₄), with a factor of 0.6 on x.
const ACES: [f64; 5] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];

/// Tone-maps a value at an exposure in stops, to [0, 1].
fn tone_map(value: f64, exposure: f64) -> f64 {
    let x = if value.is_finite() { value.max(0.0) * exposure.exp2() } else { 0.0 };
    let [k0, k1, k2, k3, k4] = ACES;
    ((k0 * x * x + k1 * x) / (k2 * x * x + k3 * x + k4)).clamp(0.0, 1.0)
}

/// The exposures, in stops, that map the brightest pixel and the median pixel to 0.85.
fn exposures(reference: &[[f64; 3]]) -> (f64, f64) {
    const SHOWN: f64 = 0.85;
    let [k0, k1, k2, k3, k4] = ACES;
    let (a, b, c) = (k0 - SHOWN * k2, k1 - SHOWN * k3, -SHOWN * k4);
    let bright = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    let mut values: Vec<f64> = reference
        .iter()
        .map(|&pixel| luminance(pixel))
        .map(|y| if y.is_finite() { y.max(0.0) } else { 0.0 })
        .collect();
    values.sort_unstable_by(f64::total_cmp);
    // The median may be black, which no exposure maps to 0.85.
    let (median, max) =
        (quantile_half(&values).max(f64::EPSILON), values[values.len() - 1].max(f64::EPSILON));
    ((bright / max).log2(), (bright / median).log2())
}

/// The median of a sorted, non-empty list.
fn quantile_half(sorted: &[f64]) -> f64 {
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}

/// The FLIP map of two linear pictures with values in [0, 1].
fn flip(picture: &[[f64; 3]], reference: &[[f64; 3]], width: usize, height: usize) -> Vec<f64> {
    let (seen, expected) =
        (PerceivedImage::new(picture, width, height), PerceivedImage::new(reference, width, height));
    let combined = (0..picture.len()).map(|pixel| {
        let difference = |a: &[f64], b: &[f64]| (a[pixel] - b[pixel]).abs();
        let feature =
            difference(&seen.edges, &expected.edges).max(difference(&seen.points, &expected.points));
        let feature = (feature / 2.0_f64.sqrt()).sqrt();
        color_difference(seen.colors[pixel], expected.colors[pixel]).powf(1.0 - feature)
    });
    combined.collect()
}

/// A picture after the model of human perception.
struct PerceivedImage {
    /// Colours in L*a*b* with the Hunt adjustment.
    colors: Vec<[f64; 3]>,
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl PerceivedImage {
    fn new(picture: &[[f64; 3]], width: usize, height: usize) -> Self {
        let opponent: Vec<[f64; 3]> = picture.iter().map(|&color| to_ycxcz(color)).collect();
        let plane = |values: Vec<f64>| Plane { width, height, values };
        let filtered: [Plane; 3] = std::array::from_fn(|channel| {
            let values = opponent.iter().map(|pixel| pixel[channel]).collect();
            perceive(&plane(values), SENSITIVITIES[channel], PIXELS_PER_DEGREE)
        });
        let color = |pixel: usize| {
            to_hunt_lab(from_ycxcz(std::array::from_fn(|channel| filtered[channel].values[pixel])))
        };
        // Features are detected before filtering, on a scale from 0 to 1.
        let gray = plane(opponent.iter().map(|pixel| (pixel[0] + 16.0) / 116.0).collect());
        Self {
            colors: (0..picture.len()).map(color).collect(),
            edges: features(&gray, Feature::Edge, PIXELS_PER_DEGREE),
            points: features(&gray, Feature::Point, PIXELS_PER_DEGREE),
        }
    }
}

/// Difference of two colours from 0 to 1, where the smaller differences use the range up to 0.95.
fn color_difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    const EXPONENT: f64 = 0.7;
    const KNEE: f64 = 0.4;
    const SHARE: f64 = 0.95;
    let (green, blue) = (to_hunt_lab([0.0, 1.0, 0.0]), to_hunt_lab([0.0, 0.0, 1.0]));
    let max = hyab(green, blue).powf(EXPONENT);
    let knee = KNEE * max;
    let difference = hyab(a, b).powf(EXPONENT);
    if difference < knee {
        difference * SHARE / knee
    } else {
        SHARE + (difference - knee) / (max - knee) * (1.0 - SHARE)
    }
}

#[cfg(test)]
mod tests;
