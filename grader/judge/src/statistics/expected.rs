//! What a correct estimator gives: its means and its noise.

use serde::{Deserialize, Serialize};

use super::batches::Batches;

/// Expected means, and the noise of a correct estimator. All lists are by pixel and channel.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Expected {
    /// Mean.
    pub mean: Vec<[f64; 3]>,
    /// Standard error of `mean`: the noise of the reference. Zero for a closed form.
    pub error: Vec<[f64; 3]>,
    /// Standard deviation of one sample of a correct estimator.
    pub deviation: Vec<[f64; 3]>,
    /// Cube root of the third central moment of one sample of a correct estimator; zero if that is negative.
    pub asymmetry: Vec<[f64; 3]>,
}

impl Expected {
    /// The same means, with the noise raised to that of the batches over the whole image.
    ///
    /// A correct program may be much noisier than the one that rendered the reference. Where it has not drawn any of
    /// its rare bright samples yet, neither its own variance nor that of the reference shows them, but other pixels
    /// do. Let κ be its variance relative to the reference's, summed over all pixels relative to m² + m̄² (mean of the
    /// pixel and mean of the image), so that neither bright nor dark pixels dominate. If κ > 1, all distributions are
    /// widened by √κ.
    pub fn with_noise_of(&self, batches: &Batches) -> Self {
        let count = 3.0 * self.mean.len().max(1) as f64;
        let image_mean = self.mean.iter().flatten().sum::<f64>() / count;
        let (mut own, mut reference) = (0.0, 0.0);
        for (pixel, mean) in self.mean.iter().enumerate() {
            for (channel, mean) in mean.iter().enumerate() {
                let scale = mean.powi(2) + image_mean.powi(2);
                if scale > 0.0 {
                    own += batches.variance(pixel, channel) / scale;
                    reference += self.deviation[pixel][channel].powi(2) / scale;
                }
            }
        }
        let factor = if reference > 0.0 { (own / reference).max(1.0).sqrt() } else { 1.0 };
        let scaled = |values: &[[f64; 3]]| values.iter().map(|value| value.map(|v| v * factor)).collect();
        Self { deviation: scaled(&self.deviation), asymmetry: scaled(&self.asymmetry), ..self.clone() }
    }

    /// The expectation if all emission is scaled by `factor`.
    pub fn brightened(&self, factor: f64) -> Self {
        let scaled = |values: &[[f64; 3]]| values.iter().map(|value| value.map(|v| v * factor)).collect();
        Self {
            mean: scaled(&self.mean),
            error: scaled(&self.error),
            deviation: scaled(&self.deviation),
            asymmetry: scaled(&self.asymmetry),
        }
    }
}
