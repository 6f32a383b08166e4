//! The protocol between the grader and the process that runs a submission.
//!
//! A message is its length in bytes (`u32`, little endian) followed by that many bytes of postcard.

use std::borrow::Cow;
use std::io::{self, Read, Write};

use arty::integrator::Settings;
use arty::math::Vec3;
use arty::scene::SceneDescription;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

mod audit;
mod directions;

pub use audit::{AuditBsdf, AuditJob, AuditLight, AuditRun, AuditSampling, AuditScene, AuditedRun};
pub use directions::{DirectionJob, SampledDirection, SampledDirections};

/// Maximum length of a message in bytes. Scenes are the longest messages: a million triangles take about 60 MB.
pub const MAX_MESSAGE: u32 = 512 << 20;

/// A request to the host.
#[derive(Debug, Serialize, Deserialize)]
pub enum Request<'a> {
    /// Build this scene. Later requests refer to it by its index, in the order of building.
    Scene(Cow<'a, SceneDescription>, Switches),
    /// Render batches of a scene.
    Render(Cow<'a, RenderJob>),
    /// Trace paths through small scripted scenes.
    Probe(Cow<'a, ProbeJob>),
    /// Trace one path of a scene and record every call.
    Replay(ReplayJob),
    /// Measure factors of the estimator in scripted scenes.
    Audit(Cow<'a, AuditJob>),
    /// Sample directions of a scene's environment.
    Directions(Cow<'a, DirectionJob>),
}

/// Replays one path of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReplayJob {
    /// Index of the scene, in the order of building.
    pub scene: u32,
    /// Settings of the submission's path tracer.
    pub settings: Settings,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// The seed of its batch.
    pub seed: u64,
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// Index of the sample.
    pub sample: u64,
}

/// Independent renderings of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderJob {
    /// Index of the scene, in the order of building.
    pub scene: u32,
    /// Settings of the submission's path tracer.
    pub settings: Settings,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// One seed per batch.
    pub seeds: Vec<u64>,
    /// Index of the first sample per pixel and batch.
    pub first_sample: u64,
    /// Samples per pixel and batch.
    pub samples: u64,
}

impl RenderJob {
    /// A job that renders one batch per seed with `samples` samples per pixel, starting with sample 0.
    pub fn new(
        scene: u32,
        settings: Settings,
        [width, height]: [u32; 2],
        seeds: Vec<u64>,
        samples: u64,
    ) -> Self {
        Self { scene, settings, width, height, seeds, first_sample: 0, samples }
    }
}

/// Switches of a scene, which is built accordingly. By default everything is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Switches {
    /// False if the lights of the scene are black for paths that hit them.
    pub emission_on_hit: bool,
}

impl Default for Switches {
    fn default() -> Self {
        Self { emission_on_hit: true }
    }
}

/// Traces paths through scripted scenes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ProbeJob {
    /// Settings of the submission's path tracer.
    pub settings: Settings,
    /// The scenes.
    pub scenes: Vec<ScriptedScene>,
    /// Number of paths per scene. They differ only in the random numbers of the submission.
    pub samples: u64,
    /// Seed of these random numbers.
    pub seed: u64,
    /// True if these numbers are stratified over all paths of a scene; then `samples` is a power of two, at most 2²⁰.
    pub stratified: bool,
}

/// A scene with scripted densities and BSDFs. Its geometry is real.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ScriptedScene {
    /// Content of the scene. Its camera is not used.
    pub scene: SceneDescription,
    /// One per material; `None` keeps the BSDF of the material.
    pub bsdfs: Vec<Option<ScriptedBsdf>>,
    /// One per light, those of the description first; `None` keeps the sampling of the light.
    pub lights: Vec<Option<ScriptedLight>>,
    /// Origin of the camera ray, in world space.
    pub origin: Vec3,
    /// Direction of the camera ray, in world space; a unit vector.
    pub direction: Vec3,
}

/// A BSDF with the same value for all directions above the horizon. Its density is one of three.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScriptedBsdf {
    /// The point in world space towards which every sampled direction points.
    pub target: Vec3,
    /// Value in every channel, 1/sr; for a delta distribution the value of its one direction.
    pub f: f32,
    /// Density per solid angle of the sampled direction and those near it; for a delta distribution its probability.
    /// Positive.
    pub pdf: f32,
    /// Density per solid angle of the direction to the viewer and those near it. No effect for a delta distribution.
    pub pdf_at_viewer: f32,
    /// Density per solid angle of all other directions. No effect for a delta distribution.
    pub pdf_elsewhere: f32,
    /// True if it is a delta distribution.
    pub is_delta: bool,
}

/// A triangle light of which always the same point is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScriptedLight {
    /// The point on the light, in world space.
    pub point: Vec3,
    /// Density per area with which that point is sampled. Positive.
    pub pdf_area: f32,
    /// Density per area of every point that a path hits. Positive.
    pub pdf_area_on_hit: f32,
}

/// Argument with which the grader starts a host that does not confine itself.
pub const UNCONFINED: &str = "--unconfined";

/// A response of the host: `Started` first, then exactly one per request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Response {
    /// The host is ready for requests. It says nothing about its confinement, which the grader knows.
    Started,
    /// The scene is built.
    SceneReady,
    /// The batches are rendered.
    Rendered(Rendered),
    /// The paths of each scripted scene.
    Probed(Vec<Vec<ProbedPath>>),
    /// The recording of one path.
    Replayed(Replayed),
    /// The submission panicked.
    Panicked {
        /// Message of the panic.
        message: String,
    },
    /// The request was invalid. Since the grader sends only valid requests, this response comes from a submission.
    Rejected {
        /// The reason.
        message: String,
    },
    /// The results of an audit's runs.
    Audited(Vec<AuditedRun>),
    /// The sampled directions.
    Directions(SampledDirections),
}

/// One path of a [`ProbeJob`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbedPath {
    /// Radiance that the path returned. It may be any value, including NaN.
    pub radiance: [f32; 3],
    /// Number of calls of `Scene::intersect`.
    pub rays: u32,
    /// Number of calls of `Scene::occluded`.
    pub shadow_rays: u32,
    /// Number of calls of `Light::sample_direct`.
    pub light_samples: u32,
}

/// The recorded path of a [`ReplayJob`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replayed {
    /// Radiance that the path returned. It may be any value, including NaN.
    pub radiance: [f32; 3],
    /// Calls of the submission, in order.
    pub calls: Vec<Call>,
    /// Number of further calls that were not recorded.
    pub left_out: u64,
}

/// A recorded call of the submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Call {
    /// Name of the function, such as `Scene::intersect`.
    pub function: String,
    /// Arguments, by name.
    pub given: Vec<(String, Vec<f32>)>,
    /// Result, by name; empty for `None`.
    pub got: Vec<(String, Vec<f32>)>,
}

/// The result of a [`RenderJob`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rendered {
    /// Mean of the samples of each batch and pixel, row by row from the top.
    pub batches: Vec<Vec<[f32; 3]>>,
    /// Number of samples that were NaN or infinite. They count as black in the means.
    pub non_finite: u64,
    /// Number of samples that were finite but negative.
    pub negative: u64,
    /// The first few of these samples.
    pub first_anomalies: Vec<AnomalousSample>,
    /// Number of calls of `Scene::intersect` and `Scene::occluded`.
    pub rays: u64,
    /// Processor time of the rendering over all threads, in seconds.
    pub cpu_seconds: f64,
}

impl Rendered {
    /// Appends more batches of the same scene.
    pub fn append(&mut self, more: Self) {
        self.batches.extend(more.batches);
        self.non_finite += more.non_finite;
        self.negative += more.negative;
        self.first_anomalies.extend(more.first_anomalies);
        self.rays += more.rays;
        self.cpu_seconds += more.cpu_seconds;
    }
}

/// A sample that is not radiance, and how to reproduce it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnomalousSample {
    /// Seed of its batch.
    pub seed: u64,
    /// Pixel column.
    pub x: u32,
    /// Pixel row.
    pub y: u32,
    /// Index of the sample.
    pub sample: u64,
    /// Value of the sample.
    pub value: [f32; 3],
}

/// Writes one message and flushes the writer.
pub fn write_message(writer: &mut impl Write, message: &impl Serialize) -> io::Result<()> {
    let bytes = postcard::to_stdvec(message).map_err(io::Error::other)?;
    let length = u32::try_from(bytes.len()).ok().filter(|&length| length <= MAX_MESSAGE);
    let length = length.ok_or_else(|| io::Error::other("the message is too long"))?;
    writer.write_all(&length.to_le_bytes())?;
    writer.write_all(&bytes)?;
    writer.flush()
}

/// Reads one message of at most `limit` bytes; `None` at the end of the stream.
pub fn read_message<T: DeserializeOwned>(reader: &mut impl Read, limit: u32) -> io::Result<Option<T>> {
    read_bytes(reader, limit)?.map(|bytes| decode(&bytes)).transpose()
}

/// Reads the bytes of one message, at most `limit` of them; `None` at the end of the stream.
pub fn read_bytes(reader: &mut impl Read, limit: u32) -> io::Result<Option<Vec<u8>>> {
    let mut length = [0; 4];
    if reader.read(&mut length[..1])? == 0 {
        return Ok(None);
    }
    reader.read_exact(&mut length[1..])?;
    let length = u32::from_le_bytes(length);
    if length > limit {
        let error = format!("a message of {length} bytes exceeds the limit of {limit}");
        return Err(io::Error::new(io::ErrorKind::InvalidData, error));
    }
    // Grow as bytes arrive: a length alone must not reserve memory.
    let mut bytes = Vec::new();
    reader.take(u64::from(length)).read_to_end(&mut bytes)?;
    if bytes.len() < length as usize {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(Some(bytes))
}

/// Decodes one message, which must use all of the bytes.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> io::Result<T> {
    let (message, rest) = postcard::take_from_bytes(bytes)
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
    if !rest.is_empty() {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "bytes after the message"));
    }
    Ok(message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_round_trip_and_damaged_ones_are_errors() {
        let response = Response::Panicked { message: "index out of bounds".to_owned() };
        let mut pipe = Vec::new();
        write_message(&mut pipe, &response).expect("a vector takes everything");
        let mut reader = pipe.as_slice();
        assert_eq!(read_message::<Response>(&mut reader, 1 << 20).expect("it is whole"), Some(response));
        assert_eq!(read_message::<Response>(&mut reader, 1 << 20).expect("the end is no error"), None);

        for length in 1..pipe.len() {
            assert!(
                read_message::<Response>(&mut &pipe[..length], 1 << 20).is_err(),
                "cut after {length} bytes"
            );
        }
        assert!(read_message::<Response>(&mut pipe.as_slice(), 4).is_err(), "longer than allowed");
        pipe[0] += 1;
        pipe.push(0);
        assert!(read_message::<Response>(&mut pipe.as_slice(), 1 << 20).is_err(), "trailing byte");
    }
}
