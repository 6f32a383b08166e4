//! What the window shows: everything that the picture depends on.

use arty::camera::CameraDescription;
use arty::cli::{Algorithm, DebugView};
use arty::integrator::{Integrator, Settings};
use arty::scene::Scene;

/// Makes the integrator for an algorithm and a scene, as `arty::cli::run` does.
pub type Make = fn(Algorithm, &Scene) -> Box<dyn Integrator>;

/// A picture to render, or two to compare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: CameraDescription,
    /// The algorithm of the picture, or of its left part.
    pub algorithm: Algorithm,
    /// What the right part shows; `None` without a wipe.
    pub against: Option<Against>,
    /// How the two parts share the time.
    pub balance: Balance,
}

/// What the right part of a wipe shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The picture of another algorithm.
    Algorithm(Algorithm),
    /// The reference.
    Reference,
}

/// How two pictures side by side share the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Balance {
    /// Both have as many samples.
    EqualSamples,
    /// Both have had as much time.
    EqualTime,
}

impl View {
    /// The algorithms to render with: one, or two for a wipe between two of them.
    pub fn algorithms(&self) -> Vec<Algorithm> {
        let right = match self.against {
            Some(Against::Algorithm(algorithm)) => Some(algorithm),
            Some(Against::Reference) | None => None,
        };
        std::iter::once(self.algorithm).chain(right).collect()
    }
}

/// The name of an algorithm in titles and file names: that of the technique, or of what is shown.
pub fn name(algorithm: Algorithm) -> &'static str {
    match algorithm {
        Algorithm::Debug(DebugView::Normals) => "normals",
        Algorithm::Debug(DebugView::Albedo) => "albedo",
        Algorithm::PathTracer(Settings { technique, .. }) => technique.name(),
    }
}
