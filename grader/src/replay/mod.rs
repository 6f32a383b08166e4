//! One path of a hand-in again, with every call that it made.
//!
//! Any path can be computed again from its seed, pixel and sample. The host writes down each call of the hand-in's code
//! ([`host::protocol::Call`]); [`vertices`] works out what a path that is weighted by the balance heuristic carries at
//! each of its vertices, and [`print()`] shows both as tables.

mod place;
mod print;
mod vertices;

use arty::integrator::Settings;
use host::protocol::{Call, ReplayJob, Replayed};
use serde::Serialize;

use crate::build::HandInProgram;
use crate::error::Result;
use crate::host_process::{Fault, HostProcess};

pub use place::{Place, quote};
pub use print::print;
pub use vertices::{Vertex, vertices};

/// A path with every call.
#[derive(Clone, Debug, Serialize)]
pub struct Path {
    /// The radiance that it returned.
    #[serde(serialize_with = "numbers")]
    pub radiance: [f32; 3],
    /// Every call, in order.
    pub calls: Vec<Step>,
    /// Calls beyond those, which were not written down.
    pub left_out: u64,
}

/// One call, with names of materials instead of numbers of surfaces.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    /// What was called.
    pub function: String,
    /// What it was given.
    pub given: Vec<Named>,
    /// What it gave; nothing for `None`.
    pub got: Vec<Named>,
}

/// A value with its name.
#[derive(Clone, Debug, Serialize)]
pub struct Named {
    /// What it is.
    pub name: String,
    /// Its numbers, written out: JSON has no NaN.
    #[serde(serialize_with = "numbers")]
    pub numbers: Vec<f32>,
    /// Its name, where it is one: that of a material.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub word: Option<String>,
}

/// Numbers as JSON, with `"NaN"`, `"inf"` and `"-inf"` as text.
fn numbers<S: serde::Serializer>(
    values: impl AsRef<[f32]>,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    #[serde(untagged)]
    enum Number {
        Finite(f32),
        Other(String),
    }
    serializer.collect_seq(values.as_ref().iter().map(|&value| {
        if value.is_finite() { Number::Finite(value) } else { Number::Other(value.to_string()) }
    }))
}

/// Follows the path that `place` names with a program.
///
/// # Errors
/// What is not the program's doing.
pub fn follow(program: &HandInProgram, place: &Place) -> Result<std::result::Result<Path, Fault>> {
    let mut process = HostProcess::start(program, 1)?;
    let scene = match process.load(&place.description)? {
        Ok(scene) => scene,
        Err(fault) => return Ok(Err(fault)),
    };
    let Place { technique, max_bounces, size, seed, pixel, sample, switches, .. } = *place;
    let settings = Settings { technique, max_bounces };
    let job = ReplayJob { scene, settings, size, seed, pixel, sample, switches };
    Ok(process.replay(job)?.map(|replayed| path(replayed, place)))
}

fn path(replayed: Replayed, place: &Place) -> Path {
    let Replayed { radiance, calls, left_out } = replayed;
    Path { radiance, calls: calls.into_iter().map(|call| step(call, place)).collect(), left_out }
}

/// Puts the material's name in the place of the surface's number.
fn step(call: Call, place: &Place) -> Step {
    let number =
        |name: &str| Some(call.got.iter().find(|(other, _)| other == name)?.1.first().copied()? as usize);
    let materials = &place.description.materials;
    let material = number("surface").zip(number("surfaces")).map(|(surface, surfaces)| {
        // Before the materials there may be the one surface that all triangle lights share.
        let first = surfaces.saturating_sub(materials.len());
        let index = surface.checked_sub(first);
        index.and_then(|index| materials.get(index)).map_or("(light)", |material| &material.name).to_owned()
    });
    let named = |(name, numbers): (String, Vec<f32>)| Named { name, numbers, word: None };
    let got = call.got.into_iter().filter(|(name, _)| name != "surfaces").map(|(name, numbers)| {
        if name == "surface" {
            Named { name: "material".to_owned(), numbers: Vec::new(), word: material.clone() }
        } else {
            Named { name, numbers, word: None }
        }
    });
    Step { function: call.function, got: got.collect(), given: call.given.into_iter().map(named).collect() }
}

impl Step {
    /// A number that it gave.
    pub(self) fn number(&self, name: &str) -> Option<f64> {
        self.got(name)?.first().map(|&value| f64::from(value))
    }

    /// What it gave.
    pub(self) fn got(&self, name: &str) -> Option<&[f32]> {
        self.got.iter().find(|value| value.name == name).map(|value| value.numbers.as_slice())
    }
}
