//! Render settings: the command line, completed by the defaults of the scene.

use std::fmt;
use std::path::PathBuf;

use super::args::{Algo, Args};
use super::exit::Failure;
use super::numbers::counted;
use super::output::Output;
use super::passes::Limits;
use super::{Algorithm, DebugView};
use crate::integrator::Settings;
use crate::sampler::Streams;
use crate::scene::Defaults;

const DEFAULT_WIDTH: u32 = 512;
const DEFAULT_HEIGHT: u32 = 412;
const DEFAULT_SAMPLES: u64 = 64;
/// Maximum number of bounces where neither command line nor scene give one.
pub const DEFAULT_MAX_BOUNCES: u32 = 8;

/// Maximum number of pixels: an OpenEXR file with a mean and a variance of more could not be read again.
const MAX_PIXELS: u64 = 1 << 25;

/// Everything that a rendering depends on, except the scene.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) algorithm: Algorithm,
    /// Columns.
    pub(super) width: u32,
    /// Rows.
    pub(super) height: u32,
    pub(super) limits: Limits,
    pub(super) streams: Streams,
    /// Number of threads; `None` for one per processor.
    pub(super) threads: Option<usize>,
    /// Output files; at least one.
    pub(super) outputs: Vec<Output>,
    /// Exposure of PNG files in stops.
    pub(super) exposure: f32,
}

impl Plan {
    /// Combines a command line and the defaults of its scene.
    ///
    /// # Errors
    ///
    /// If the image has too many pixels.
    pub(super) fn new(args: &Args, defaults: Defaults) -> Result<Self, Failure> {
        let (width, height) = size(args, defaults);
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(Failure::TooLarge { width, height, limit: MAX_PIXELS });
        }
        let samples = args.samples.or(args.time.is_none().then_some(DEFAULT_SAMPLES));
        let outputs = match args.output.is_empty() {
            true => vec![Output::png(default_output(args))],
            false => args.output.clone(),
        };
        Ok(Self {
            algorithm: match args.algo {
                Algo::Debug => Algorithm::Debug(args.show.unwrap_or(DebugView::Normals)),
                Algo::Pt => Algorithm::PathTracer(Settings {
                    technique: args.technique,
                    max_bounces: max_bounces(args, defaults),
                }),
            },
            width,
            height,
            limits: Limits { samples, time: args.time },
            streams: Streams { seed: args.seed, kind: args.sampler },
            threads: args.threads.map(usize::from),
            outputs,
            exposure: args.exposure,
        })
    }
}

/// Width and height of the image in pixels.
pub(super) fn size(args: &Args, defaults: Defaults) -> (u32, u32) {
    image_size(args.width, args.height, defaults)
}

/// Width and height of an image in pixels, given those of the command line and of the scene.
pub fn image_size(width: Option<u32>, height: Option<u32>, defaults: Defaults) -> (u32, u32) {
    let given = (width, height);
    let (width, height) =
        (defaults.width.unwrap_or(DEFAULT_WIDTH), defaults.height.unwrap_or(DEFAULT_HEIGHT));
    // A single one keeps the aspect ratio.
    let scaled = |given: u32, other: u32, of: u32| {
        let exact = f64::from(given) * f64::from(other) / f64::from(of);
        (exact.round() as u32).max(1)
    };
    match given {
        (None, None) => (width, height),
        (Some(given), None) => (given, scaled(given, height, width)),
        (None, Some(given)) => (scaled(given, width, height), given),
        (Some(width), Some(height)) => (width, height),
    }
}

/// Maximum number of bounces.
pub(super) fn max_bounces(args: &Args, defaults: Defaults) -> u32 {
    args.max_bounces.or(defaults.max_bounces).unwrap_or(DEFAULT_MAX_BOUNCES)
}

/// The default output, in the current folder: `<scene>-<technique>.png`, so that techniques can be compared.
fn default_output(args: &Args) -> PathBuf {
    let mut name = args.scene.file_stem().unwrap_or("image".as_ref()).to_owned();
    let what = match args.algo {
        Algo::Debug => args.show.unwrap_or(DebugView::Normals).name().to_owned(),
        Algo::Pt => args.technique.to_string(),
    };
    // `with_extension` would cut off a stem with dots.
    name.push(format!("-{what}.png"));
    name.into()
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} x {} pixels, ", self.width, self.height)?;
        if let Some(samples) = self.limits.samples {
            write!(f, "{} per pixel, ", counted(samples, "sample"))?;
        }
        if let Some(time) = self.limits.time {
            write!(f, "at most {} s, ", time.as_secs_f64())?;
        }
        match self.algorithm {
            Algorithm::Debug(view) => write!(f, "debug ({})", view.name()),
            Algorithm::PathTracer(Settings { technique, max_bounces }) => {
                write!(f, "pt ({technique}, {})", counted(max_bounces.into(), "bounce"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use std::path::Path;

    use super::*;
    use crate::integrator::Technique;

    const SUGGESTED: Defaults = Defaults { width: Some(300), height: Some(200), max_bounces: Some(3) };

    fn plan(line: &str, defaults: Defaults) -> Result<Plan, Failure> {
        let args = Args::read(line.split_whitespace().map(Into::into)).expect("a valid command line");
        Plan::new(&args, defaults)
    }

    fn settings(plan: &Plan) -> Settings {
        match plan.algorithm {
            Algorithm::PathTracer(settings) => settings,
            Algorithm::Debug(view) => panic!("{view:?}"),
        }
    }

    #[test]
    fn unspecified_settings_have_defaults() {
        let plan = plan("arty scenes/box.v2.yml", Defaults::default()).expect("valid");
        assert_eq!((plan.width, plan.height), (512, 412));
        assert_eq!(plan.limits, Limits { samples: Some(64), time: None });
        assert_eq!(settings(&plan), Settings { technique: Technique::Mis, max_bounces: 8 });
        assert_eq!((plan.streams, plan.threads, plan.exposure), (Streams::default(), None, 0.0));
        assert_eq!(plan.outputs.len(), 1);
        assert_eq!(plan.outputs[0].path(), Path::new("box.v2-mis.png"));
    }

    #[test]
    fn the_command_line_overrides_the_defaults_of_the_scene() {
        let suggested = plan("arty x.yml", SUGGESTED).expect("valid");
        assert_eq!((suggested.width, suggested.height, settings(&suggested).max_bounces), (300, 200, 3));
        let decided = plan("arty x.yml --width=64 --max-bounces=0", SUGGESTED).expect("valid");
        assert_eq!(
            (decided.width, decided.height, settings(&decided).max_bounces),
            (64, 43, 0),
            "the aspect ratio is the scene's"
        );
    }

    #[test]
    fn a_time_limit_replaces_only_the_default_number_of_samples() {
        let second = Some(Duration::from_secs(1));
        let limits = |line| plan(line, SUGGESTED).expect("valid").limits;
        assert_eq!(limits("arty x.yml --time=1"), Limits { samples: None, time: second });
        assert_eq!(limits("arty x.yml --time=1 -s 5"), Limits { samples: Some(5), time: second });
    }

    #[test]
    fn debug_shows_normals_by_default() {
        let view = |line| plan(line, SUGGESTED).expect("valid").algorithm;
        assert_eq!(view("arty x.yml -a debug"), Algorithm::Debug(DebugView::Normals));
        assert_eq!(view("arty x.yml -a debug --show=albedo"), Algorithm::Debug(DebugView::Albedo));
    }

    #[test]
    fn an_image_that_is_too_large_is_refused() {
        plan("arty x.yml --width=8192 --height=4096", SUGGESTED).expect("just fits");
        let failure = plan("arty x.yml --width=65536 --height=65536", SUGGESTED).expect_err("too large");
        assert!(failure.to_string().starts_with("65536 x 65536 pixels are too many"), "{failure}");
        assert_eq!(failure.exit() as u8, 2);
    }
}
