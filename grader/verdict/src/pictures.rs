//! Pictures for the report page: what the submission renders with each technique, beside what the scene looks like.
//!
//! They are kept as the page shows them: radiance in half floats, all else in bytes.

use arty::integrator::Technique;
use half::f16;
use serde::{Deserialize, Serialize};

use arty::image::error::{Truth, mse, relative_mse};

use crate::smape::smape;

/// The scene that every report has a picture of, so that a class can be looked at as one wall.
pub const THUMBNAIL_SCENE: &str = "cornell_box";

/// A submission's pictures of a scene. All lists are row by row from the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// The scene.
    pub scene: String,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The seeds of the renderings of which each picture is the mean.
    pub seeds: Vec<u64>,
    /// Samples of each pixel in each of them.
    pub samples: u64,
    /// What is right: radiance as the bits of half floats, three for each pixel.
    pub reference: Vec<u16>,
    /// What the submission renders, technique by technique.
    pub rendered: Vec<Rendered>,
}

/// What a submission renders with one technique.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rendered {
    /// The technique.
    pub technique: Technique,
    /// Radiance as the bits of half floats, three for each pixel.
    pub radiance: Vec<u16>,
    /// For each pixel the difference of the means around it, in tenths of standard errors, from −127 to 127.
    pub z: Vec<i8>,
    /// For each pixel how different it looks, from 0 to 255.
    pub flip: Vec<u8>,
    /// Errors over the whole picture.
    pub error: ImageError,
}

/// **reference-image**: how far a picture with few samples is from the reference. Reported, and never deciding: most of
/// it is noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ImageError {
    /// The scene.
    pub scene: String,
    /// The technique.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// Samples of each pixel of the submission.
    pub samples: u64,
    /// Mean squared error, in radiance squared.
    pub mse: f64,
    /// The same, relative to the reference.
    pub relative_mse: f64,
    /// Symmetric mean absolute error, from 0 to 1.
    pub smape: f64,
    /// How different it looks, from 0 to 1: the mean of HDR-FLIP. None where a picture is too small for it.
    pub flip: Option<f64>,
}

impl Picture {
    /// The errors of what was rendered.
    pub fn errors(&self) -> impl Iterator<Item = ImageError> {
        self.rendered.iter().map(|rendered| rendered.error.clone())
    }

    /// Adds what was rendered with a technique. `z` is in standard errors; `flip`, from 0 to 1, may be empty.
    pub fn add(
        &mut self,
        technique: Technique,
        (rendered, reference): (&[[f64; 3]], &[[f64; 3]]),
        z: &[f64],
        flip: &[f64],
    ) {
        let truth = Truth { mean: reference, variance: None };
        let mean_flip = (!flip.is_empty()).then(|| flip.iter().sum::<f64>() / flip.len() as f64);
        let error = ImageError {
            scene: self.scene.clone(),
            technique,
            max_bounces: self.max_bounces,
            samples: self.seeds.len() as u64 * self.samples,
            mse: mse(rendered, truth),
            relative_mse: relative_mse(rendered, truth),
            smape: smape(rendered, reference),
            flip: mean_flip,
        };
        self.rendered.push(Rendered {
            technique,
            radiance: half_bits(rendered),
            // Conversions of numbers beyond a type's range end at its limits.
            z: z.iter().map(|z| (10.0 * z).round().max(-127.0) as i8).collect(),
            flip: flip.iter().map(|flip| (255.0 * flip).round() as u8).collect(),
            error,
        });
    }
}

/// Radiance as the bits of half floats. What is finite stays finite, so that infinity can be shown as what it is.
pub fn half_bits(pixels: &[[f64; 3]]) -> Vec<u16> {
    let within = |value: f64| {
        if value.is_finite() { value.clamp(f16::MIN.to_f64(), f16::MAX.to_f64()) } else { value }
    };
    pixels.iter().flatten().map(|&value| f16::from_f64(within(value)).to_bits()).collect()
}
