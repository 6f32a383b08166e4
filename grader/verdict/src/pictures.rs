//! Pictures for the report page: renderings of each technique beside the reference.
//!
//! They are stored the way the page shows them: radiance as half floats, everything else as bytes.

use arty::integrator::Technique;
use half::f16;
use serde::{Deserialize, Serialize};

use arty::image::error::{Truth, mse, relative_mse};

use crate::smape::smape;

/// Scene of the picture that every report has, for the overview of a class.
pub const THUMBNAIL_SCENE: &str = "cornell_box";

/// A submission's pictures of one scene. All lists are row by row from the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Name of the scene.
    pub scene: String,
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Seeds of the renderings that each picture averages.
    pub seeds: Vec<u64>,
    /// Samples per pixel of each rendering.
    pub samples: u64,
    /// The reference: radiance as the bits of half floats, three per pixel.
    pub reference: Vec<u16>,
    /// The submission's pictures, one per technique.
    pub rendered: Vec<Rendered>,
}

/// A submission's picture with one technique.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rendered {
    /// The technique.
    pub technique: Technique,
    /// Radiance as the bits of half floats, three per pixel.
    pub radiance: Vec<u16>,
    /// For each pixel the difference of the local means, in tenths of standard errors, clamped to ±127.
    pub z: Vec<i8>,
    /// For each pixel its HDR-FLIP difference, from 0 to 255.
    pub flip: Vec<u8>,
    /// Errors of the whole picture.
    pub error: ImageError,
    /// Paths of the pixel that differs most from the reference; `None` if they were not recorded.
    pub paths: Option<PixelPaths>,
}

/// Paths of one pixel, projected onto the picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PixelPaths {
    /// Column and row.
    pub pixel: [u32; 2],
    /// The samples that the picture averages there: all of the first seed, then all of the second, and so on.
    pub samples: Vec<DrawnPath>,
}

/// The path of one sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DrawnPath {
    /// Radiance that it returned.
    pub radiance: [f32; 3],
    /// Its rays after the first one, which is seen as a point.
    pub lines: Vec<PathLine>,
}

/// A ray in the picture. Positions are in pixels from the upper left, finite, and may be outside of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathLine {
    /// Bounce or shadow ray, and for a shadow ray, the outcome.
    pub kind: RayKind,
    /// Origin of the ray.
    pub from: [f32; 2],
    /// What it hits, or the point on a light that it is traced to.
    pub to: [f32; 2],
}

/// Kinds of rays of a path, with the outcome of shadow rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum RayKind {
    /// From one hit point to the next.
    Bounce,
    /// A shadow ray that arrives at the light.
    Arrives,
    /// A shadow ray that is blocked.
    Blocked,
    /// To a light sample without a shadow ray.
    Untested,
}

/// **reference-image**: error of a picture with few samples against the reference. It never affects a verdict, since
/// most of it is noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ImageError {
    /// Name of the scene.
    pub scene: String,
    /// Technique.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Samples per pixel.
    pub samples: u64,
    /// Mean squared error, in squared radiance.
    pub mse: f64,
    /// Relative MSE.
    pub relative_mse: f64,
    /// Symmetric mean absolute percentage error, from 0 to 1.
    pub smape: f64,
    /// Mean of HDR-FLIP, from 0 to 1; `None` if the picture is empty.
    pub flip: Option<f64>,
}

impl Picture {
    /// Errors of all techniques.
    pub fn errors(&self) -> impl Iterator<Item = ImageError> {
        self.rendered.iter().map(|rendered| rendered.error.clone())
    }

    /// Adds the picture of a technique. `z` is in standard errors; `flip`, from 0 to 1, may be empty.
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
            // `as` saturates.
            z: z.iter().map(|z| (10.0 * z).round().max(-127.0) as i8).collect(),
            flip: flip.iter().map(|flip| (255.0 * flip).round() as u8).collect(),
            error,
            paths: None,
        });
    }
}

/// Radiance as the bits of half floats. Finite values are clamped to finite ones, so that only infinity becomes
/// infinity.
pub fn half_bits(pixels: &[[f64; 3]]) -> Vec<u16> {
    let within = |value: f64| {
        if value.is_finite() { value.clamp(f16::MIN.to_f64(), f16::MAX.to_f64()) } else { value }
    };
    pixels.iter().flatten().map(|&value| f16::from_f64(within(value)).to_bits()).collect()
}
