//! References: the expected image of a scene, and the noise of correct estimators.
//!
//! A reference is an EXR file of [`SIZE`]. For each view (maximum number of bounces, and `emission_on_hit`) it holds
//! the mean and the variance of that mean by pixel and channel, and for each technique the relative standard deviation
//! and the skewness of one sample. Its metadata record the hash of the scene's content: the reference of a scene that
//! has changed is refused.

mod file;
mod make;
mod oracle;
mod wanted;

use std::collections::BTreeMap;

use arty::integrator::Technique;

use crate::statistics::expected::Expected;
use verdict::rubric::View;

pub use file::{load, save};
pub use make::{Effort, make, picture};
pub use oracle::Oracle;
pub use wanted::{Wanted, wanted_of_all};

/// Width and height in pixels of references and of the pictures compared with them.
pub const SIZE: (u32, u32) = (16, 16);

/// The reference of one scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Hash of the scene's content.
    pub scene_hash: String,
    /// The views.
    pub views: BTreeMap<View, ReferenceView>,
    /// How it was rendered, for readers of the file.
    pub provenance: BTreeMap<String, String>,
}

/// The reference of one view. All lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceView {
    /// Mean of each pixel.
    pub mean: Vec<[f64; 3]>,
    /// Variance of that mean.
    pub variance_of_mean: Vec<[f64; 3]>,
    /// Moments of one sample of a correct estimator, by name of the technique.
    pub techniques: BTreeMap<&'static str, Moments>,
}

/// Moments of single samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moments {
    /// Standard deviation of one sample, relative to the mean.
    pub deviation: Vec<[f64; 3]>,
    /// Skewness of one sample.
    pub skewness: Vec<[f64; 3]>,
}

impl ReferenceView {
    /// Expected mean and noise of a correct estimator with this technique; `None` if the reference lacks the technique.
    pub fn expected(&self, technique: Technique) -> Option<Expected> {
        let moments = self.techniques.get(technique.name())?;
        let per_value = |f: &dyn Fn(usize, usize) -> f64| -> Vec<[f64; 3]> {
            (0..self.mean.len()).map(|pixel| std::array::from_fn(|channel| f(pixel, channel))).collect()
        };
        let deviation =
            |pixel: usize, channel: usize| moments.deviation[pixel][channel] * self.mean[pixel][channel];
        Some(Expected {
            mean: self.mean.clone(),
            error: self.variance_of_mean.iter().map(|variance| variance.map(f64::sqrt)).collect(),
            deviation: per_value(&deviation),
            asymmetry: per_value(&|pixel, channel| {
                moments.skewness[pixel][channel].max(0.0).cbrt() * deviation(pixel, channel)
            }),
        })
    }
}
