//! Paths of a pixel: which are asked for, what they did.

pub mod calls;
mod describe;
mod overlay;
#[cfg(feature = "window")]
pub mod trace;
pub mod vertices;

use arty::camera::CameraDescription;
use arty::integrator::Settings;
use arty::math::Rgb;

use self::calls::RecordedPath;

pub use describe::describe;
pub use overlay::draw;

/// Number of paths that are drawn: that of the chosen sample, and faintly those after it.
pub const DRAWN: u64 = 16;

/// Number of samples among which the brightest is looked for.
pub const COMPARED: u64 = 1024;

/// A sample of a pixel whose path is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query {
    /// The camera. It stays the same when that of the window moves, so that a path can be looked at from all sides.
    pub camera: CameraDescription,
    /// Settings of the path tracer.
    pub settings: Settings,
    /// Column and row.
    pub pixel: (u32, u32),
    /// Number of the sample.
    pub sample: u64,
}

/// Paths of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// What was asked for.
    pub query: Query,
    /// The first [`COMPARED`] samples of the pixel.
    pub values: Vec<Rgb>,
    /// The paths of the sample asked for and of those after it; why there are none if the algorithm has panicked.
    pub paths: Result<Vec<RecordedPath>, String>,
}

impl Traced {
    /// The number of the brightest sample, NaN and infinity included; `None` without samples.
    pub fn brightest(&self) -> Option<u64> {
        let luminance = |value: &Rgb| if value.is_finite() { value.luminance() } else { f32::INFINITY };
        let (index, _) = self
            .values
            .iter()
            .enumerate()
            .rev()
            .max_by(|(_, a), (_, b)| luminance(a).total_cmp(&luminance(b)))?;
        Some(index as u64)
    }
}
