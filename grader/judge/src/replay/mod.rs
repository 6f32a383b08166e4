//! Replaying one path of a submission, with a recording of its calls.
//!
//! Any path can be reproduced from its seed, pixel and sample. The host records each call of the submission
//! ([`host::protocol::Call`]); [`vertices`] reconstructs the vertices of a path of the solution.

mod place;
mod vertices;

use arty::integrator::Settings;
use arty::scene::SceneDescription;
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use host::protocol::{Call, ReplayJob, Switches};
use verdict::replay::{NamedValue, RecordedCall, ReplayTarget, ReplayedPath};
use verdict::rubric::EmissionOnHit;

use harness::job::JobError;

pub use place::load;
pub use vertices::vertices;

/// Replays a path with a program, in the scene returned by [`load`].
///
/// # Errors
/// If the program gives no valid answer, or the grader itself fails.
pub fn follow(
    program: &SubmissionProgram,
    target: &ReplayTarget,
    description: &SceneDescription,
) -> Result<ReplayedPath, JobError> {
    let mut process = HostProcess::start(program, 1)?;
    let ReplayTarget { technique, max_bounces, size, seed, pixel, sample, emission_on_hit, .. } = *target;
    let settings = Settings { technique, max_bounces };
    let switches = Switches { emission_on_hit: emission_on_hit == EmissionOnHit::On };
    let scene = process.load_with(description, switches)?;
    let job = ReplayJob { scene, settings, size, seed, pixel, sample };
    let replayed = process.replay(job)?;
    Ok(ReplayedPath {
        radiance: replayed.radiance,
        calls: replayed.calls.into_iter().map(|call| step(call, description)).collect(),
        left_out: replayed.left_out,
    })
}

/// Converts a call, replacing the index of a surface by the name of its material.
fn step(call: Call, description: &SceneDescription) -> RecordedCall {
    let number =
        |name: &str| Some(call.got.iter().find(|(other, _)| other == name)?.1.first().copied()? as usize);
    let materials = &description.materials;
    let material = number("surface").zip(number("surfaces")).map(|(surface, surfaces)| {
        // One surface, shared by all triangle lights, may precede the materials.
        let first = surfaces.saturating_sub(materials.len());
        let index = surface.checked_sub(first);
        index.and_then(|index| materials.get(index)).map_or("(light)", |material| &material.name).to_owned()
    });
    let named = |(name, numbers): (String, Vec<f32>)| NamedValue { name, numbers, word: None };
    let got = call.got.into_iter().filter(|(name, _)| name != "surfaces").map(|(name, numbers)| {
        if name == "surface" {
            NamedValue { name: "material".to_owned(), numbers: Vec::new(), word: material.clone() }
        } else {
            NamedValue { name, numbers, word: None }
        }
    });
    RecordedCall {
        function: call.function,
        got: got.collect(),
        given: call.given.into_iter().map(named).collect(),
    }
}
