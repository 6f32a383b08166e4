//! Jobs of the audit: many short runs in scripted scenes.

use arty::integrator::Settings;
use arty::math::{Rgb, Vec3};
use arty::scene::SceneDescription;
use serde::{Deserialize, Serialize};

/// Runs in scripted scenes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AuditJob {
    /// The scenes.
    pub scenes: Vec<AuditScene>,
    /// The runs, in any order of their scenes.
    pub runs: Vec<AuditRun>,
}

/// A scene in which everything that a path can ask for has a scripted answer. Its geometry is real.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AuditScene {
    /// Content of the scene. Its camera is not used.
    pub scene: SceneDescription,
    /// One per material; `None` keeps the BSDF of the material.
    pub bsdfs: Vec<Option<AuditBsdf>>,
    /// One per light, those of the description first; `None` keeps the light as it is.
    pub lights: Vec<Option<AuditLight>>,
    /// Origin of the camera ray, in world space.
    pub origin: Vec3,
    /// Direction of the camera ray, in world space; a unit vector.
    pub direction: Vec3,
}

/// A BSDF with scripted values and densities.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AuditBsdf {
    /// The point in world space towards which every sampled direction points.
    pub target: Vec3,
    /// Value and density in all directions but the following ones.
    pub elsewhere: (Rgb, f32),
    /// Value and density of the sampled direction and near it; for a delta lobe, its value and probability.
    pub at_target: (Rgb, f32),
    /// Value and density near the direction to the viewer.
    pub at_viewer: (Rgb, f32),
    /// Outcome of sampling this BSDF.
    pub sampling: AuditSampling,
}

/// What sampling a scripted BSDF returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AuditSampling {
    /// The direction to its target.
    Target,
    /// The direction to its target; the BSDF is a delta distribution.
    Delta,
    /// The direction to its target from a delta lobe of a BSDF that is no delta distribution.
    DeltaLobe,
    /// Nothing.
    Nothing,
}

/// A light with scripted samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AuditLight {
    /// The sampled point of a triangle light, in world space.
    pub point: Vec3,
    /// Density per area of every sampled point of a triangle light. Positive.
    pub pdf_area: f32,
    /// Density per area of every point of a triangle light that a path hits. Positive.
    pub pdf_area_on_hit: f32,
    /// The only point towards which its samples are not black; `None` if there are others.
    pub bright_from: Option<Vec3>,
}

/// Paths of one scene. They differ only in the random numbers of the submission, which are stratified over them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AuditRun {
    /// Index of the scene.
    pub scene: u32,
    /// Settings of the submission's path tracer.
    pub settings: Settings,
    /// Seed of the submission's random numbers.
    pub seed: u32,
    /// False if `Hit::emission` returns black.
    pub emission_on_hit: bool,
    /// Number of paths: a power of two, at most 2²⁰.
    pub paths: u32,
    /// True if each of the submission's numbers is once the largest below 1, which biases the mean.
    pub with_extreme: bool,
}

/// The result of an [`AuditRun`]. It may hold any values, including NaN.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AuditedRun {
    /// Mean radiance of the paths.
    pub mean: [f64; 3],
    /// Standard deviation of their radiance.
    pub spread: [f64; 3],
    /// Minimum and maximum number of calls of `Scene::intersect` and `Scene::occluded` in a path.
    pub rays: [u32; 2],
    /// Minimum and maximum number of calls of `Light::sample_direct` in a path.
    pub light_samples: [u32; 2],
}

impl AuditJob {
    /// True if all runs can be made.
    pub fn is_valid(&self) -> bool {
        self.runs.iter().all(|run| {
            (run.scene as usize) < self.scenes.len() && run.paths.is_power_of_two() && run.paths <= 1 << 20
        })
    }
}
