//! One path of a hand-in again, with every call that it made.
//!
//! Any path can be computed again from its seed, pixel and sample. The host writes down each call of the hand-in's code
//! ([`host::protocol::Call`]); [`vertices`] works out what a path that is weighted by the balance heuristic carries at
//! each of its vertices.

mod place;
mod vertices;

use arty::integrator::Settings;
use host::protocol::{Call, ReplayJob, Replayed};
use verdict::replay::{Named, Path, Step};

use harness::build::HandInProgram;
use harness::host_process::{Fault, HostProcess};
use verdict::error::Result;

pub use place::Place;
pub use vertices::vertices;

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
