//! What the grader and the process that runs a submission say to each other.
//!
//! Each message is its length in bytes (`u32`, little endian) and that many bytes of postcard.

use std::borrow::Cow;
use std::io::{self, Read, Write};

use arty::integrator::Settings;
use arty::math::Vec3;
use arty::scene::SceneDescription;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

/// The longest message that is read, in bytes. Scenes are the longest: a million triangles take about 60 MB.
pub const MAX_MESSAGE: u32 = 512 << 20;

/// A job for the host.
#[derive(Debug, Serialize, Deserialize)]
pub enum Request<'a> {
    /// Build this scene; later jobs refer to it by its place in the order of building.
    Scene(Cow<'a, SceneDescription>),
    /// Render batches of a scene.
    Render(Cow<'a, RenderJob>),
    /// Follow paths through small scripted scenes.
    Probe(Cow<'a, ProbeJob>),
    /// Follow one path of a scene and write down every call.
    Replay(ReplayJob),
}

/// One path of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReplayJob {
    /// Which scene, counted from 0 in the order in which they were sent.
    pub scene: u32,
    /// What the submission's path tracer is made with.
    pub settings: Settings,
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// The seed of its batch.
    pub seed: u64,
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// The number of the sample.
    pub sample: u64,
    /// Which ways of finding light are enabled.
    pub switches: Switches,
}

/// Independent renderings of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderJob {
    /// Which scene, counted from 0 in the order in which they were sent.
    pub scene: u32,
    /// What the submission's path tracer is made with.
    pub settings: Settings,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// One seed per batch.
    pub seeds: Vec<u64>,
    /// The number of the first sample of each pixel in each batch.
    pub first_sample: u64,
    /// Samples of each pixel in each batch.
    pub samples: u64,
    /// Which ways of finding light are enabled.
    pub switches: Switches,
}

impl RenderJob {
    /// A job that renders one batch for each seed, `samples` per pixel, beginning with the first sample.
    pub fn new(
        scene: u32,
        settings: Settings,
        [width, height]: [u32; 2],
        seeds: Vec<u64>,
        samples: u64,
    ) -> Self {
        let (first_sample, switches) = (0, Switches::default());
        Self { scene, settings, width, height, seeds, first_sample, samples, switches }
    }
}

/// Which ways of finding light are enabled. By default all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Switches {
    /// False if the emission of lights that are hit is black.
    pub emission_on_hit: bool,
}

impl Default for Switches {
    fn default() -> Self {
        Self { emission_on_hit: true }
    }
}

/// Paths through scripted scenes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ProbeJob {
    /// What the submission's path tracer is made with.
    pub settings: Settings,
    /// The scenes, one after the other.
    pub scenes: Vec<ScriptedScene>,
    /// How many paths are followed in each: they differ in the submission's own random numbers only.
    pub samples: u64,
    /// The seed of these random numbers.
    pub seed: u64,
    /// True if these numbers fill [0, 1) evenly over all paths of a scene; then `samples` is a power of two, at most 2²⁰.
    pub stratified: bool,
}

/// A scene of which densities and BSDFs are scripted; its geometry is true.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ScriptedScene {
    /// The scene. Its camera is not used.
    pub scene: SceneDescription,
    /// One for each material; `None` leaves it as it is.
    pub bsdfs: Vec<Option<ScriptedBsdf>>,
    /// One for each light, those of the description first; `None` leaves it as it is.
    pub lights: Vec<Option<ScriptedLight>>,
    /// Where the camera's ray starts, in world space.
    pub origin: Vec3,
    /// Where it goes: a unit vector.
    pub direction: Vec3,
}

/// A BSDF with the same value and density for all directions above the horizon.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScriptedBsdf {
    /// The point (world space) to which every direction goes that is drawn.
    pub target: Vec3,
    /// Its value in every channel, 1/sr; for a delta distribution that of the one direction.
    pub f: f32,
    /// Its density per solid angle; for a delta distribution the probability of the one direction. Greater than 0.
    pub pdf: f32,
    /// True if it is a delta distribution.
    pub is_delta: bool,
}

/// A triangle light of which one point is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScriptedLight {
    /// The point in world space; on the light.
    pub point: Vec3,
    /// The density per area with which every point of the light claims to be drawn. Greater than 0.
    pub pdf_area: f32,
}

/// The argument with which the grader starts a host that does not lock itself in.
pub const UNCONFINED: &str = "--unconfined";

/// An answer of the host: exactly one to each request, after one that says that it is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Response {
    /// The host is ready for requests. How it is confined, the grader knows.
    Started,
    /// The scene is built.
    SceneReady,
    /// The batches are rendered.
    Rendered(Rendered),
    /// For each scripted scene what its paths found.
    Probed(Vec<Vec<ProbedPath>>),
    /// What one path called.
    Replayed(Replayed),
    /// The submission panicked.
    Panicked {
        /// What it said.
        message: String,
    },
    /// The request made no sense. The grader sends none that does not: whoever says so is a submission.
    Rejected {
        /// Why.
        message: String,
    },
}

/// One path of a [`ProbeJob`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbedPath {
    /// The radiance that it found. It may be anything, NaN too.
    pub radiance: [f32; 3],
    /// Calls of `Scene::intersect`.
    pub rays: u32,
    /// Calls of `Scene::occluded`.
    pub shadow_rays: u32,
    /// Calls of `Light::sample_direct`.
    pub light_samples: u32,
}

/// The path of a [`ReplayJob`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replayed {
    /// The radiance that it returned. It may be anything, NaN too.
    pub radiance: [f32; 3],
    /// Every call of the submission, in order.
    pub calls: Vec<Call>,
    /// Calls beyond those, which were not written down.
    pub left_out: u64,
}

/// A call of the submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Call {
    /// What was called, as in `Scene::intersect`.
    pub function: String,
    /// What it was given.
    pub given: Vec<(String, Vec<f32>)>,
    /// What it gave; nothing for `None`.
    pub got: Vec<(String, Vec<f32>)>,
}

/// The batches of a [`RenderJob`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rendered {
    /// For each batch and pixel (row by row from the top) the mean of its samples.
    pub batches: Vec<Vec<[f32; 3]>>,
    /// Samples that were NaN or infinite. They count as black in the means.
    pub non_finite: u64,
    /// Samples that were finite but negative.
    pub negative: u64,
    /// The first few of either kind.
    pub first_anomalies: Vec<AnomalousSample>,
    /// Processor time that rendering took, over all threads, in seconds.
    pub cpu_seconds: f64,
}

impl Rendered {
    /// Adds more batches of the same scene.
    pub fn append(&mut self, more: Self) {
        self.batches.extend(more.batches);
        self.non_finite += more.non_finite;
        self.negative += more.negative;
        self.first_anomalies.extend(more.first_anomalies);
        self.cpu_seconds += more.cpu_seconds;
    }
}

/// A sample that no correct estimator gives, and how to make it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnomalousSample {
    /// The seed of its batch.
    pub seed: u64,
    /// Pixel column.
    pub x: u32,
    /// Pixel row.
    pub y: u32,
    /// Number of the sample.
    pub sample: u64,
    /// Its value.
    pub value: [f32; 3],
}

/// Writes one message.
pub fn write_message(writer: &mut impl Write, message: &impl Serialize) -> io::Result<()> {
    let bytes = postcard::to_stdvec(message).map_err(io::Error::other)?;
    let length = u32::try_from(bytes.len()).ok().filter(|&length| length <= MAX_MESSAGE);
    let length = length.ok_or_else(|| io::Error::other("message too long"))?;
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
        return Err(io::Error::new(io::ErrorKind::InvalidData, format!("a message of {length} bytes")));
    }
    // Grow as the bytes come: a length alone must not make anyone reserve memory.
    let mut bytes = Vec::new();
    reader.take(u64::from(length)).read_to_end(&mut bytes)?;
    if bytes.len() < length as usize {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(Some(bytes))
}

/// The message that these bytes are.
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
    fn messages_survive_the_pipe_and_broken_ones_are_errors() {
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
