//! Convolutions of FLIP. All kernels are sums of separable kernels, so that each is two one-dimensional passes.
//! Pictures are extended by their border pixels.

use std::f64::consts::PI;

/// A single-channel image.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f64>,
}

impl Plane {
    /// Convolves each row with one kernel and then each column with another; both have odd lengths.
    fn convolve(&self, horizontal: &[f64], vertical: &[f64]) -> Self {
        self.across_rows(horizontal).along_columns(vertical)
    }

    /// Convolves each row.
    fn across_rows(&self, kernel: &[f64]) -> Self {
        let radius = kernel.len() / 2;
        let mut values = vec![0.0; self.values.len()];
        for (row, sums) in self.values.chunks(self.width).zip(values.chunks_mut(self.width)) {
            let mut widened = vec![row[0]; radius];
            widened.extend_from_slice(row);
            widened.resize(self.width + 2 * radius, row[self.width - 1]);
            for (shift, &weight) in kernel.iter().enumerate() {
                add(sums, weight, &widened[shift..]);
            }
        }
        Self { values, ..*self }
    }

    /// Convolves all columns at once, by summing rows.
    fn along_columns(&self, kernel: &[f64]) -> Self {
        let radius = (kernel.len() / 2) as isize;
        let mut values = vec![0.0; self.values.len()];
        for (y, sums) in values.chunks_mut(self.width).enumerate() {
            for (shift, &weight) in (-radius..=radius).zip(kernel) {
                let from = y.saturating_add_signed(shift).min(self.height - 1);
                add(sums, weight, &self.values[from * self.width..]);
            }
        }
        Self { values, ..*self }
    }
}

/// Adds `weight` times the first values of `others`.
fn add(sums: &mut [f64], weight: f64, others: &[f64]) {
    sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += weight * other);
}

/// Contrast sensitivity of a channel of YCxCz: a sum of Gaussians a·√(π/b)·exp(−π²d²/b), d in degrees, normalised.
#[derive(Clone, Copy)]
pub(super) struct Sensitivity(&'static [(f64, f64)]);

/// Table 1 of the paper: (a, b) for achromatic, red–green and blue–yellow contrast.
pub(super) const SENSITIVITIES: [Sensitivity; 3] = [
    Sensitivity(&[(1.0, 0.0047)]),
    Sensitivity(&[(1.0, 0.0053)]),
    Sensitivity(&[(34.1, 0.04), (13.5, 0.025)]),
];

/// The largest b, which determines the radius of all kernels.
const WIDEST: f64 = 0.04;

/// Filters a channel with a contrast sensitivity.
pub(super) fn perceive(plane: &Plane, Sensitivity(gaussians): Sensitivity, pixels_per_degree: f64) -> Plane {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
    let mut total = 0.0;
    let mut sum = vec![0.0; plane.values.len()];
    for &(a, b) in gaussians {
        let along: Vec<f64> = (-radius..=radius)
            .map(|i| (-PI * PI * (f64::from(i) / pixels_per_degree).powi(2) / b).exp())
            .collect();
        let scale = a * (PI / b).sqrt();
        total += scale * along.iter().sum::<f64>().powi(2);
        let seen = plane.convolve(&along, &along);
        sum.iter_mut().zip(&seen.values).for_each(|(sum, value)| *sum += scale * value);
    }
    let values = sum.into_iter().map(|value| value / total).collect();
    Plane { values, ..*plane }
}

/// A feature that the eye detects.
#[derive(Clone, Copy)]
pub(super) enum Feature {
    /// Steps: the first derivative of a Gaussian.
    Edge,
    /// Dots and lines: its second derivative.
    Point,
}

/// Magnitude of a feature in each pixel, over both directions. The detectors are 0.082° wide.
pub(super) fn features(plane: &Plane, feature: Feature, pixels_per_degree: f64) -> Vec<f64> {
    let deviation = 0.5 * 0.082 * pixels_per_degree;
    let radius = (3.0 * deviation).ceil() as i32;
    let positions = (-radius..=radius).map(f64::from);
    let across: Vec<f64> =
        positions.clone().map(|x| (-x * x / (2.0 * deviation * deviation)).exp()).collect();
    let mut along: Vec<f64> = positions
        .zip(&across)
        .map(|(x, gauss)| match feature {
            Feature::Edge => -x * gauss,
            Feature::Point => (x * x / (deviation * deviation) - 1.0) * gauss,
        })
        .collect();
    // Normalise the positive weights to 1 and the negative ones to −1. The sign depends on one coordinate only.
    let sum_across: f64 = across.iter().sum();
    let sum_of = |sign: f64| along.iter().map(|weight| (sign * weight).max(0.0)).sum::<f64>() * sum_across;
    let (positive, negative) = (sum_of(1.0), sum_of(-1.0));
    along.iter_mut().for_each(|weight| *weight /= if *weight > 0.0 { positive } else { negative });
    let (in_x, in_y) = (plane.convolve(&along, &across), plane.convolve(&across, &along));
    in_x.values.iter().zip(&in_y.values).map(|(x, y)| x.hypot(*y)).collect()
}
