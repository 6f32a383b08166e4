//! Error metrics: the difference between an image and a reference as one number.
//!
//! All slices are pixels row by row, three linear channels each. A rendered reference is noisy; if its variance is given, it
//! is subtracted, so that the expected result is the error against the ground truth. A single result can then be negative.

/// ε of [`relative_mse`]: limits the weight of almost black pixels.
pub const RELATIVE_EPSILON: f64 = 0.01;

/// Fraction of pixels that [`trimmed_relative_mse`] excludes.
pub const TRIMMED_SHARE: f64 = 0.001;

/// A reference.
#[derive(Clone, Copy, Debug)]
pub struct Truth<'a> {
    /// The pixels.
    pub mean: &'a [[f64; 3]],
    /// The variance of each value, to be subtracted; as long as `mean`.
    pub variance: Option<&'a [[f64; 3]]>,
}

impl Truth<'_> {
    /// For each pixel, the mean of `weight(r) · ((x − r)² − σ²)` over its channels.
    ///
    /// # Panics
    ///
    /// If the image and the reference have different numbers of pixels.
    fn pixel_errors(&self, image: &[[f64; 3]], weight: impl Fn(f64) -> f64) -> Vec<f64> {
        assert_eq!(image.len(), self.mean.len(), "pixels");
        let noise = |pixel: usize, channel: usize| self.variance.map_or(0.0, |list| list[pixel][channel]);
        let pixels = image.iter().zip(self.mean).enumerate();
        let of_pixel = |(pixel, (x, r)): (usize, (&[f64; 3], &[f64; 3]))| {
            let channels = 0..3;
            channels.map(|c| weight(r[c]) * ((x[c] - r[c]).powi(2) - noise(pixel, c))).sum::<f64>() / 3.0
        };
        pixels.map(of_pixel).collect()
    }
}

/// The mean squared error, mean((x − r)²) over pixels and channels. 0 for an image without pixels.
///
/// # Panics
///
/// If the image and the reference have different numbers of pixels.
pub fn mse(image: &[[f64; 3]], truth: Truth<'_>) -> f64 {
    mean(&truth.pixel_errors(image, |_| 1.0))
}

/// The weight of a squared difference in the relative error: 1 / (r² + ε), ε = [`RELATIVE_EPSILON`].
pub fn relative_weight(reference: f64) -> f64 {
    1.0 / (reference * reference + RELATIVE_EPSILON)
}

/// The relative mean squared error, mean((x − r)² / (r² + ε)) over pixels and channels, ε = 0.01.
///
/// Rousselle, Knaus, Zwicker: "Adaptive Sampling and Reconstruction using Greedy Error Minimization", 2011.
///
/// # Panics
///
/// If the image and the reference have different numbers of pixels.
pub fn relative_mse(image: &[[f64; 3]], truth: Truth<'_>) -> f64 {
    mean(&truth.pixel_errors(image, relative_weight))
}

/// [`relative_mse`] without the worst 0.1 % of the pixels (at least one), so that a few fireflies do not dominate.
///
/// It underestimates the error, the more the fewer pixels there are.
///
/// # Panics
///
/// If the image and the reference have different numbers of pixels.
pub fn trimmed_relative_mse(image: &[[f64; 3]], truth: Truth<'_>) -> f64 {
    let mut errors = truth.pixel_errors(image, relative_weight);
    errors.sort_unstable_by(f64::total_cmp);
    let left_out = (TRIMMED_SHARE * errors.len() as f64).ceil() as usize;
    errors.truncate(errors.len().saturating_sub(left_out));
    mean(&errors)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(mean: &[[f64; 3]]) -> Truth<'_> {
        Truth { mean, variance: None }
    }

    #[test]
    fn errors_are_means_over_pixels_and_channels() {
        let reference = [[1.0, 0.0, 2.0], [0.0; 3]];
        let image = [[1.5, 0.0, 2.0], [0.0, 0.0, 0.1]];
        assert!((mse(&image, truth(&reference)) - (0.25 + 0.01) / 6.0).abs() < 1e-15);
        let relative = (0.25 / 1.01 + 0.01 / 0.01) / 6.0;
        assert!((relative_mse(&image, truth(&reference)) - relative).abs() < 1e-15);
        assert_eq!(mse(&[], truth(&[])), 0.0);
        assert_eq!(trimmed_relative_mse(&[], truth(&[])), 0.0);
    }

    #[test]
    fn the_noise_of_the_reference_is_subtracted() {
        let (reference, variance) = ([[2.0; 3]; 4], [[0.25; 3]; 4]);
        let noisy = Truth { mean: &reference, variance: Some(&variance) };
        assert_eq!(mse(&[[2.5; 3]; 4], noisy), 0.0);
        assert!(relative_mse(&[[2.0; 3]; 4], noisy) < 0.0, "less than expected from the noise");
    }

    #[test]
    fn the_worst_thousandth_of_the_pixels_is_excluded() {
        let reference = vec![[1.0; 3]; 2000];
        let mut image = reference.clone();
        image[7] = [1e6; 3];
        image[1999] = [1e5; 3];
        assert_eq!(trimmed_relative_mse(&image, truth(&reference)), 0.0);
        image[3] = [2.0; 3];
        assert!((trimmed_relative_mse(&image, truth(&reference)) - 1.0 / 1.01 / 1998.0).abs() < 1e-12);
    }
}
