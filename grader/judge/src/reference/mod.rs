//! Reference images: what scenes look like, and how noisy correct estimators are in them.
//!
//! A reference is an EXR of the size that is judged. For each limit on the number of bounces (and once more
//! for next event estimation alone, where that is checked) it holds, per pixel
//! and channel, the mean and the variance of that mean, and for each technique the relative deviation and the
//! skewness of one sample. Its metadata say which scene it shows, by the hash of the scene's content: a reference
//! whose scene has changed is refused.

mod file;
mod make;
mod oracle;

use std::collections::BTreeMap;

use arty::integrator::Technique;

use crate::statistics::bias::Expected;
use verdict::rubric::View;

pub use file::{load, save};
pub use make::{Effort, Wanted, make, picture};
pub use oracle::Oracle;

/// Width and height of references for judging, in pixels.
pub const SIZE: (u32, u32) = (16, 16);

/// What is known of one scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// The hash of the scene's content.
    pub scene_hash: String,
    /// By which light is shown.
    pub views: BTreeMap<View, ReferenceView>,
    /// How it was made, for the reader of the file.
    pub provenance: BTreeMap<String, String>,
}

/// The image that light makes which is scattered up to a number of times. All lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceView {
    /// Mean of each pixel.
    pub mean: Vec<[f64; 3]>,
    /// Variance of that mean.
    pub variance_of_mean: Vec<[f64; 3]>,
    /// How a correct estimator is distributed, by technique.
    pub techniques: BTreeMap<&'static str, Moments>,
}

/// How single samples are distributed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moments {
    /// Standard deviation of one sample, relative to the mean.
    pub deviation: Vec<[f64; 3]>,
    /// Skewness of one sample.
    pub skewness: Vec<[f64; 3]>,
}

impl ReferenceView {
    /// What a correct estimator of this technique gives; `None` if the reference does not have the technique.
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
