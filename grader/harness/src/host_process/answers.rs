//! Checks answers of a process: whatever is not an answer to its job becomes a fault.

use std::time::Duration;

use arty::scene::SceneDescription;
use host::protocol::{RenderJob, Rendered, Replayed, Response};
use verdict::check::Fault;
use verdict::error::Error;
use verdict::text::clean;

use crate::job::JobError;

/// Turns the timeout of the first part of a job, which had this much time, into [`Fault::TooSlow`].
pub(super) fn of_first_part(error: JobError, time: Duration) -> JobError {
    match error {
        JobError::Submission(Fault::Timeout(seconds)) if seconds == time.as_secs_f64() => {
            Fault::TooSlow(seconds).into()
        }
        error => error,
    }
}

pub(super) fn malformed(what: &str) -> JobError {
    Fault::Malformed(what.to_owned()).into()
}

pub(super) fn unexpected(response: Response) -> JobError {
    match response {
        Response::Panicked { message } => Fault::Panic(clean(&message)).into(),
        // The host rejects only what the grader has made sure that it does not send.
        Response::Rejected { message } => malformed(&format!("it rejected a job: {}", short(&message))),
        Response::Started => malformed("it started again"),
        Response::SceneReady => malformed("it only said that a scene is ready"),
        Response::Replayed(_) => malformed("it sent a path that was not requested"),
        Response::Probed(_) => malformed("it sent paths that were not requested"),
        Response::Rendered(_) => malformed("it sent a rendering that was not requested"),
        Response::Audited(_) => malformed("it sent an audit that was not requested"),
        Response::Directions(_) => malformed("it sent directions that were not requested"),
    }
}

/// A text of a process, made harmless and shortened for people.
fn short(words: &str) -> String {
    let words = clean(words).replace('\n', " ");
    match words.char_indices().nth(LONGEST_WORDS) {
        Some((end, _)) => format!("{} …", &words[..end]),
        None => words,
    }
}

/// Maximum number of characters of a text that no process should send.
const LONGEST_WORDS: usize = 200;

pub(super) fn clean_words(mut path: Replayed) -> Replayed {
    for call in &mut path.calls {
        let names = call.given.iter_mut().chain(&mut call.got).map(|(name, _)| name);
        for word in names.chain([&mut call.function]) {
            *word = short(word);
        }
    }
    path
}

pub(super) fn check_shape(
    rendered: Rendered,
    batches: usize,
    pixels: usize,
) -> std::result::Result<Rendered, Fault> {
    let whole =
        rendered.batches.len() == batches && rendered.batches.iter().all(|batch| batch.len() == pixels);
    if !whole {
        return Err(Fault::Malformed("the number of batches or pixels is wrong".to_owned()));
    }
    if rendered.batches.iter().flatten().flatten().any(|value| !value.is_finite()) {
        return Err(Fault::Malformed("a mean is not finite".to_owned()));
    }
    Ok(rendered)
}

/// Compares the rays of a rendering with what its paths can need. A path without rays finds no light; one that samples
/// every light at every bounce, and traces a ray of its own for the BSDF, needs no more than `enough`.
pub(super) fn check_rays(
    rendered: Rendered,
    job: &RenderJob,
    lights: usize,
) -> std::result::Result<Rendered, Fault> {
    let means = rendered.batches.iter().flatten();
    let lit = means.filter(|mean| mean.iter().any(|&value| value != 0.0)).count() as u64;
    if rendered.rays < lit {
        return Err(Fault::TooFewRays);
    }
    let paths = job.seeds.len() as f64 * f64::from(job.width) * f64::from(job.height) * job.samples as f64;
    let bounces = f64::from(job.settings.max_bounces) + 1.0;
    let (rays, enough) = (rendered.rays as f64 / paths.max(1.0), bounces * (2.0 + lights.max(1) as f64));
    if rays > enough { Err(Fault::TooManyRays { rays, enough }) } else { Ok(rendered) }
}

/// Number of lights in a scene: those of its own, triangles that emit, and its environment.
pub(super) fn number_of_lights(scene: &SceneDescription) -> usize {
    let emits = |material: u32| {
        scene.materials.get(material as usize).is_some_and(|material| !material.emission.is_black())
    };
    let triangles = scene.meshes.iter().flat_map(|mesh| &mesh.triangles);
    let environment = usize::from(scene.environment.is_some());
    environment + scene.lights.len() + triangles.filter(|triangle| emits(triangle.material)).count()
}

/// The error of a job for which the machine had hardly any time.
pub(super) fn too_busy(wall: Duration) -> Error {
    Error::Harness(format!(
        "the machine is too busy: after {} s a submission has not had the processor time of a single job; grade again with \
         fewer --jobs",
        wall.as_secs()
    ))
}
