//! Limits on the size of an answer and on the number of its parts.

use std::io::{self, Read};

use host::protocol::{MAX_MESSAGE, Request, Response, decode, read_bytes};

/// Limits of the answer to one request. Longer answers are not read, and answers with more parts not decoded, since one
/// byte of an answer can take many bytes of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Expected {
    bytes: u32,
    /// First byte of the kind of answer that has parts, and the number of parts.
    parts: Option<(u8, u64)>,
}

/// Maximum bytes of an answer without numbers, such as the message of a panic.
const WORDS: u64 = 16 << 10;

/// Bytes of one mean: three numbers.
const MEAN: u64 = 12;

/// Maximum bytes of one path: three numbers, and three counts of up to five bytes.
const PATH: u64 = 12 + 3 * 5;

/// Maximum bytes of one recorded call, and maximum number of calls.
const CALL: u64 = 1 << 10;
const CALLS: u64 = 10_000;

/// Bytes of a length.
const LENGTH: u64 = 10;

/// Kinds of answers, by their first byte.
const RENDERED: u8 = 2;
const PROBED: u8 = 3;
const AUDITED: u8 = 7;
const DIRECTIONS: u8 = 8;

/// Maximum bytes of one run of an audit: six numbers, and four counts of up to five bytes.
const AUDITED_RUN: u64 = 6 * 8 + 4 * 5;

/// Maximum bytes of a sampled direction, five numbers, and bytes of a density.
const DIRECTION: u64 = 1 + 5 * 4;
const DENSITY: u64 = 4;

impl Expected {
    /// The message that a process has started.
    pub(super) fn start() -> Self {
        Self::of(0, None)
    }

    /// The answer to a request.
    pub(super) fn answer_to(request: &Request<'_>) -> Self {
        match request {
            Request::Scene(..) => Self::of(0, None),
            Request::Render(job) => {
                let pixels = u64::from(job.width) * u64::from(job.height);
                let batches = job.seeds.len() as u64;
                let bytes = pixels.saturating_mul(MEAN).saturating_add(LENGTH).saturating_mul(batches);
                Self::of(bytes, Some((RENDERED, batches)))
            }
            Request::Probe(job) => {
                let scenes = job.scenes.len() as u64;
                let bytes = job.samples.saturating_mul(PATH).saturating_add(LENGTH).saturating_mul(scenes);
                Self::of(bytes, Some((PROBED, scenes)))
            }
            Request::Audit(job) => {
                let runs = job.runs.len() as u64;
                Self::of(runs.saturating_mul(AUDITED_RUN), Some((AUDITED, runs)))
            }
            Request::Directions(job) => {
                let (samples, densities) = (u64::from(job.samples), job.directions.len() as u64);
                let bytes = samples * DIRECTION + densities * DENSITY + 2 * LENGTH;
                Self::of(bytes, Some((DIRECTIONS, samples)))
            }
            Request::Replay(_) => Self::of(CALL * CALLS, None),
        }
    }

    fn of(bytes: u64, parts: Option<(u8, u64)>) -> Self {
        let bytes = u32::try_from(bytes.saturating_add(WORDS)).unwrap_or(u32::MAX).min(MAX_MESSAGE);
        Self { bytes, parts }
    }

    /// Reads the answer; `None` at the end of the stream.
    pub(super) fn read(self, reader: &mut impl Read) -> io::Result<Option<Response>> {
        let Some(bytes) = read_bytes(reader, self.bytes)? else { return Ok(None) };
        let kind = bytes.first().copied();
        let counted = self.parts.filter(|(expected, _)| kind == Some(*expected));
        let right = match counted {
            Some((_, parts)) => length(&bytes[1..]) == Some(parts),
            // Those with parts that nobody asked for.
            None => !matches!(kind, Some(RENDERED | PROBED | AUDITED | DIRECTIONS)),
        };
        if !right {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "the number of its parts is wrong"));
        }
        decode(&bytes).map(Some)
    }
}

/// A length in postcard's encoding: seven bits per byte, lowest first.
fn length(bytes: &[u8]) -> Option<u64> {
    let mut value = 0;
    for (place, byte) in bytes.iter().take(9).enumerate() {
        value |= u64::from(byte & 0x7f) << (7 * place);
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use arty::integrator::{Settings, Technique};
    use arty::math::Vec3;
    use host::protocol::{
        AuditJob, AuditRun, AuditedRun, DirectionJob, ProbeJob, ProbedPath, RenderJob, Rendered,
        SampledDirection, SampledDirections, write_message,
    };

    use super::*;

    fn job(batches: u64) -> RenderJob {
        RenderJob {
            scene: 0,
            settings: Settings { technique: Technique::Nee, max_bounces: 1 },
            width: 20,
            height: 10,
            seeds: (0..batches).collect(),
            first_sample: 0,
            samples: 1,
        }
    }

    fn rendered(batches: Vec<Vec<[f32; 3]>>) -> Response {
        let first_anomalies = Vec::new();
        Response::Rendered(Rendered {
            batches,
            non_finite: 0,
            negative: 0,
            first_anomalies,
            rays: 0,
            cpu_seconds: 0.0,
        })
    }

    fn read(expected: Expected, response: &Response) -> io::Result<Option<Response>> {
        let mut pipe = Vec::new();
        write_message(&mut pipe, response)?;
        expected.read(&mut pipe.as_slice())
    }

    #[test]
    fn the_longest_true_answers_are_read() {
        for batches in [1, 3, 200] {
            let expected = Expected::answer_to(&Request::Render(Cow::Owned(job(batches))));
            let response = rendered(vec![vec![[1.0; 3]; 200]; batches as usize]);
            assert_eq!(read(expected, &response).expect("it is read"), Some(response));
        }
        let probe = ProbeJob {
            settings: job(1).settings,
            scenes: Vec::new(),
            samples: 10_000,
            seed: 1,
            stratified: false,
        };
        let expected = Expected::answer_to(&Request::Probe(Cow::Owned(probe)));
        assert_eq!(
            read(expected, &Response::Probed(Vec::new())).expect("it is read"),
            Some(Response::Probed(Vec::new()))
        );
        let settings = job(1).settings;
        let run =
            AuditRun { scene: 0, settings, seed: 1, emission_on_hit: true, paths: 1, with_extreme: false };
        let audit = AuditJob { scenes: Vec::new(), runs: vec![run; 1000] };
        let expected = Expected::answer_to(&Request::Audit(Cow::Owned(audit)));
        let longest = AuditedRun {
            mean: [1.0; 3],
            spread: [1.0; 3],
            rays: [u32::MAX; 2],
            light_samples: [u32::MAX; 2],
        };
        let response = Response::Audited(vec![longest; 1000]);
        assert_eq!(read(expected, &response).expect("it is read"), Some(response));
        let directions = vec![Vec3::Y; 500];
        let job = DirectionJob { scene: 0, samples: 1000, seed: 1, directions };
        let expected = Expected::answer_to(&Request::Directions(Cow::Owned(job)));
        let sample = SampledDirection { wi: Vec3::Y, pdf: 1.0, density: 1.0 };
        let sampled = SampledDirections { samples: vec![Some(sample); 1000], densities: vec![1.0; 500] };
        let response = Response::Directions(sampled);
        assert_eq!(read(expected, &response).expect("it is read"), Some(response));
        let words = Response::Panicked { message: "\u{10000}".repeat(3000) };
        assert_eq!(read(Expected::start(), &words).expect("it is read"), Some(words));
    }

    #[test]
    fn answers_that_grow_in_memory_are_not_taken_apart() {
        let expected = Expected::answer_to(&Request::Render(Cow::Owned(job(3))));
        let error = |response: &Response| read(expected, response).expect_err("it is refused").to_string();
        assert!(error(&rendered(vec![Vec::new(); 9000])).contains("parts"));
        assert!(error(&Response::Probed(vec![Vec::new(); 9000])).contains("parts"));
        assert!(error(&rendered(vec![vec![[0.0; 3]; 4000]; 3])).contains("bytes"));
        let run = AuditedRun { mean: [0.0; 3], spread: [0.0; 3], rays: [0; 2], light_samples: [0; 2] };
        assert!(read(Expected::start(), &Response::Audited(vec![run])).is_err());
        let sampled = SampledDirections { samples: vec![None; 9000], densities: Vec::new() };
        assert!(error(&Response::Directions(sampled.clone())).contains("parts"));
        assert!(read(Expected::start(), &Response::Directions(sampled)).is_err());
        let path = ProbedPath { radiance: [0.0; 3], rays: 0, shadow_rays: 0, light_samples: 0 };
        assert!(read(Expected::start(), &Response::Probed(vec![vec![path]])).is_err());
    }
}
