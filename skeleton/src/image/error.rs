//! How far an image is from a reference, in one number.
//!
//! All lists are pixels row by row, three channels each, linear. A reference that was rendered has noise of its own;
//! where its variance is given, it is subtracted, so that the mean of what is left is the error against the truth.
//! A single result can then be negative.

/// ε of [`relative_mse`]: keeps pixels that are almost black from deciding alone.
pub const RELATIVE_EPSILON: f64 = 0.01;

/// The share of pixels that [`trimmed_relative_mse`] leaves out.
pub const TRIMMED_SHARE: f64 = 0.001;

/// An image to compare with.
#[derive(Clone, Copy, Debug)]
pub struct Truth<'a> {
    /// Its pixels.
    pub mean: &'a [[f64; 3]],
    /// The variance of each of these values, to be subtracted; as many as pixels.
    pub variance: Option<&'a [[f64; 3]]>,
}

impl Truth<'_> {
    /// For each pixel the mean over its channels of `weight(r) · ((x − r)² − σ²)`.
    ///
    /// # Panics
    ///
    /// If the image has not as many pixels as the reference.
    fn pixel_errors(&self, picture: &[[f64; 3]], weight: impl Fn(f64) -> f64) -> Vec<f64> {
        assert_eq!(picture.len(), self.mean.len(), "pixels");
        let noise = |pixel: usize, channel: usize| self.variance.map_or(0.0, |list| list[pixel][channel]);
        let pixels = picture.iter().zip(self.mean).enumerate();
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
/// If the image has not as many pixels as the reference.
pub fn mse(picture: &[[f64; 3]], truth: Truth<'_>) -> f64 {
    mean(&truth.pixel_errors(picture, |_| 1.0))
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
/// If the image has not as many pixels as the reference.
pub fn relative_mse(picture: &[[f64; 3]], truth: Truth<'_>) -> f64 {
    mean(&truth.pixel_errors(picture, relative_weight))
}

/// [`relative_mse`] without the worst 0.1 % of the pixels (at least one): a few bright dots do not decide.
///
/// It is smaller than the error itself, the more so the fewer pixels there are.
///
/// # Panics
///
/// If the image has not as many pixels as the reference.
pub fn trimmed_relative_mse(picture: &[[f64; 3]], truth: Truth<'_>) -> f64 {
    let mut errors = truth.pixel_errors(picture, relative_weight);
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
        let picture = [[1.5, 0.0, 2.0], [0.0, 0.0, 0.1]];
        assert!((mse(&picture, truth(&reference)) - (0.25 + 0.01) / 6.0).abs() < 1e-15);
        let relative = (0.25 / 1.01 + 0.01 / 0.01) / 6.0;
        assert!((relative_mse(&picture, truth(&reference)) - relative).abs() < 1e-15);
        assert_eq!(mse(&[], truth(&[])), 0.0);
        assert_eq!(trimmed_relative_mse(&[], truth(&[])), 0.0);
    }

    #[test]
    fn the_noise_of_the_reference_is_subtracted() {
        let (reference, variance) = ([[2.0; 3]; 4], [[0.25; 3]; 4]);
        let noisy = Truth { mean: &reference, variance: Some(&variance) };
        assert_eq!(mse(&[[2.5; 3]; 4], noisy), 0.0);
        assert!(relative_mse(&[[2.0; 3]; 4], noisy) < 0.0, "less than the noise lets one expect");
    }

    #[test]
    fn the_worst_thousandth_of_the_pixels_is_left_out_but_no_more() {
        let reference = vec![[1.0; 3]; 2000];
        let mut picture = reference.clone();
        picture[7] = [1e6; 3];
        picture[1999] = [1e5; 3];
        assert_eq!(trimmed_relative_mse(&picture, truth(&reference)), 0.0);
        picture[3] = [2.0; 3];
        assert!((trimmed_relative_mse(&picture, truth(&reference)) - 1.0 / 1.01 / 1998.0).abs() < 1e-12);
    }
}
