//! The command-line arguments.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Parser, ValueEnum, value_parser};

use super::output::Output;
use super::{DebugView, original_options};
use crate::image::tev;
use crate::integrator::Technique;
use crate::sampler::SamplerKind;

/// Renders a scene.
///
/// All randomness comes from the seed: the same command line renders the same image, down to the last bit, with
/// any number of threads.
#[derive(Debug, Parser)]
#[command(name = "arty", version, max_term_width = 100, after_help = SHORT_EXAMPLES, after_long_help = EXAMPLES)]
pub(super) struct Args {
    /// A scene file (YAML), or the name of a scene in scenes/
    #[arg(value_name = "SCENE")]
    pub(super) scene: PathBuf,

    /// Rendering algorithm
    #[arg(short, long, value_enum, default_value_t = Algo::Pt, help_heading = ALGORITHM)]
    pub(super) algo: Algo,

    /// Estimator of the path tracer
    #[arg(long, value_enum, default_value_t = Technique::Mis, help_heading = ALGORITHM)]
    pub(super) technique: Technique,

    /// Maximum number of bounces: 0 = emission only, 1 = direct light [default: the scene's, else 8]
    #[arg(long, value_name = "N", help_heading = ALGORITHM)]
    pub(super) max_bounces: Option<u32>,

    /// What --algo=debug shows [default: normals]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = ALGORITHM)]
    pub(super) show: Option<DebugView>,

    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = ALGORITHM)]
    pub(super) seed: u64,

    /// Random numbers of the samples of a pixel
    #[arg(long, value_enum, default_value_t = SamplerKind::Independent, help_heading = ALGORITHM)]
    pub(super) sampler: SamplerKind,

    /// Width in pixels (also -sx) [default: proportional to --height, else the scene's, else 512]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=MAX_SIDE), help_heading = IMAGE)]
    pub(super) width: Option<u32>,

    /// Height in pixels (also -sy) [default: proportional to --width, else the scene's, else 412]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=MAX_SIDE), help_heading = IMAGE)]
    pub(super) height: Option<u32>,

    /// Samples per pixel [default: 64, unlimited with --time]
    ///
    /// If --time is given too, rendering stops at whichever limit is reached first.
    #[arg(short, long, value_name = "N", value_parser = value_parser!(u64).range(1..), help_heading = IMAGE)]
    pub(super) samples: Option<u64>,

    /// Time limit in seconds; every pixel gets at least one sample
    #[arg(short, long, value_name = "SECONDS", value_parser = seconds, help_heading = IMAGE)]
    pub(super) time: Option<Duration>,

    /// Output file, .png (for viewing) or .exr (linear data); repeatable [default: `<scene>-<technique>.png` in
    /// the current folder]
    ///
    /// Existing files are replaced. An OpenEXR file contains the mean of each pixel, the variance of that mean (with two
    /// or more independent samples per pixel), and metadata on how the image was rendered.
    #[arg(short, long, value_name = "FILE", value_parser = PathBufValueParser::new().try_map(Output::new),
          help_heading = OUTPUT)]
    pub(super) output: Vec<Output>,

    /// Exposure of the PNG in stops; may be negative
    #[arg(long, value_name = "EV", default_value_t = 0.0, value_parser = exposure, allow_negative_numbers = true,
          help_heading = OUTPUT)]
    pub(super) exposure: f32,

    /// Show the image in the tev viewer while it renders
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, require_equals = true,
          default_missing_value = tev::DEFAULT_ADDRESS, help_heading = OUTPUT)]
    pub(super) tev: Option<String>,

    /// Refine the picture in a window with keys and mouse, as `cargo view` does; `--view --help` lists its options
    #[arg(long, help_heading = OUTPUT)]
    pub(super) view: bool,

    /// Print and save the error against this OpenEXR reference while rendering (relative MSE, MSE)
    ///
    /// The image is rendered with the reference's size, which --width and --height must not contradict, and maximum
    /// number of bounces. If the reference has a layer `variance` (as files written by this program do), it is
    /// subtracted: it estimates the noise of the reference itself. references/pictures contains references with 256
    /// samples per pixel and no such layer, so error curves flatten near their noise level. Render your own reference
    /// for long curves.
    #[arg(long, value_name = "REF.exr", help_heading = OUTPUT)]
    pub(super) reference: Option<PathBuf>,

    /// Output file for the errors against --reference, as CSV [default: `<scene>.errors.csv` in the current folder]
    #[arg(long, value_name = "FILE.csv", requires = "reference", help_heading = OUTPUT)]
    pub(super) errors: Option<PathBuf>,

    /// Number of threads [default: one per processor]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024), help_heading = OTHER)]
    pub(super) threads: Option<u16>,

    /// Print statistics of the scene instead of rendering it
    #[arg(long, help_heading = OTHER)]
    pub(super) features: bool,

    /// Print only warnings and errors
    #[arg(short, long, help_heading = OTHER)]
    pub(super) quiet: bool,
}

/// The algorithm to render with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Algo {
    /// Properties of the visible surfaces
    Debug,
    /// Path tracing
    Pt,
}

const ALGORITHM: &str = "Algorithm";
const IMAGE: &str = "Image";
const OUTPUT: &str = "Output";
const OTHER: &str = "Other";

/// Maximum width and height, as in scene files.
const MAX_SIDE: i64 = 65536;

const SHORT_EXAMPLES: &str =
    "Example: arty --algo=pt scenes/cornell_box.yml --samples=16\nSee --help for details and more examples.";

const EXAMPLES: &str = "\
Examples:
  arty --algo=pt scenes/cornell_box_water.yml --width=512 --height=412
      The image of the exercise sheet, as cornell_box_water-mis.png in the current folder.
  arty cornell_box --technique=nee --max-bounces=1 --samples=10
      Direct light only, to debug next event estimation.
  arty scenes/veach_mis.yml --time=10 -o bsdf.png -o bsdf.exr --technique=bsdf
      Render for ten seconds; save a PNG for viewing and an OpenEXR file with linear data.
  arty scenes/cornell_box.yml --algo=debug --show=normals -s 4
      Check the geometry.
  arty scenes/cornell_box.yml --time=20 --reference=references/pictures/cornell_box.exr
      Also save the error over time, as cornell_box.errors.csv.
  arty import room.glb
      Convert a glTF file, such as a Blender export, to room.yml with meshes, materials and textures.
  arty scenes/cornell_box.yml --samples=100000 --tev
      Watch the image converge in tev. Ctrl-C stops and saves the image; Ctrl-C twice quits immediately.

Exit status:
  0    success
  2    invalid command line, scene or output file; nothing was rendered
  3    internal error, or the algorithm panicked
  130  interrupted; the image was saved with the samples rendered so far";

impl Args {
    /// Parses the arguments of a process, the program's name first.
    ///
    /// # Errors
    ///
    /// A usage error, or the help or version text that was requested.
    pub(super) fn read(arguments: impl Iterator<Item = OsString>) -> Result<Self, clap::Error> {
        let args = Self::try_parse_from(original_options::rewrite(arguments))?;
        if args.show.is_some() && args.algo != Algo::Debug {
            let message = "--show needs --algo=debug";
            return Err(conflict(message));
        }
        if args.reference.is_some() && args.algo == Algo::Debug {
            return Err(conflict("--reference cannot be used with --algo=debug"));
        }
        Ok(args)
    }
}

fn conflict(message: &str) -> clap::Error {
    <Args as clap::CommandFactory>::command().error(clap::error::ErrorKind::ArgumentConflict, message)
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds.filter(|time| !time.is_zero()).ok_or_else(|| "must be a number of seconds above 0".to_owned())
}

fn exposure(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops| (-100.0..=100.0).contains(stops));
    stops.ok_or_else(|| "must be a number of stops from -100 to 100".to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    fn read(line: &str) -> Result<Args, clap::Error> {
        Args::read(line.split_whitespace().map(OsString::from))
    }

    fn refusal(line: &str) -> String {
        let error = read(line).expect_err(line);
        assert!(error.use_stderr() && error.exit_code() == 2, "{line}: {error}");
        error.to_string()
    }

    #[test]
    fn the_definition_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn the_command_line_of_the_sheet_is_understood() {
        let args =
            read("arty --algo=pt scenes/cornell_box_water.yml --width=512 --height=412").expect("valid");
        assert_eq!(args.scene.to_str(), Some("scenes/cornell_box_water.yml"));
        assert_eq!((args.algo, args.width, args.height), (Algo::Pt, Some(512), Some(412)));
        assert_eq!(args.technique, Technique::Mis);
        assert_eq!((args.samples, args.time, args.seed, args.exposure), (None, None, 0, 0.0));
        assert!(args.output.is_empty() && args.tev.is_none() && args.threads.is_none() && !args.quiet);
    }

    #[test]
    fn short_options_of_the_original_program_have_the_same_meaning() {
        let short = read("arty -a debug -sx 64 -sy=48 -s 3 -t 1.5 -o x.PNG x.yml").expect("valid");
        let long =
            read("arty x.yml --algo=debug --width=64 --height=48 --samples=3 --time=1.5 --output=x.PNG");
        assert_eq!(format!("{short:?}"), format!("{:?}", long.expect("valid")));
        assert_eq!((short.width, short.height, short.samples), (Some(64), Some(48), Some(3)));
        assert_eq!((short.algo, short.time), (Algo::Debug, Some(Duration::from_millis(1500))));
    }

    #[test]
    fn several_outputs_can_be_given() {
        let args = read("arty x.yml --output=a.png -o out/b.exr").expect("valid");
        let paths: Vec<_> = args.output.iter().map(|output| output.path().to_str()).collect();
        assert_eq!(paths, [Some("a.png"), Some("out/b.exr")]);
    }

    #[test]
    fn exposure_may_be_negative() {
        assert_eq!(read("arty x.yml --exposure=-1.5").expect("valid").exposure, -1.5);
        assert_eq!(read("arty x.yml --exposure -2").expect("valid").exposure, -2.0);
    }

    #[test]
    fn the_viewer_has_a_default_address() {
        assert_eq!(read("arty --tev x.yml").expect("valid").tev.as_deref(), Some(tev::DEFAULT_ADDRESS));
        assert_eq!(read("arty --tev=host:1 x.yml").expect("valid").tev.as_deref(), Some("host:1"));
    }

    #[test]
    fn invalid_values_are_refused_with_the_expected_ones() {
        let cases = [
            ("arty", "<SCENE>"),
            ("arty x.yml --algo=photon", "possible values: debug, pt"),
            ("arty x.yml --technique=all", "possible values: bsdf, nee, mis"),
            ("arty x.yml --width=0", "1..=65536"),
            ("arty x.yml -sx 65537", "1..=65536"),
            ("arty x.yml --height=-3", "--height"),
            ("arty x.yml --samples=0", "1.."),
            ("arty x.yml -s x", "--samples"),
            ("arty x.yml --time=0", "seconds above 0"),
            ("arty x.yml --time=-1", "seconds above 0"),
            ("arty x.yml --time=inf", "seconds above 0"),
            ("arty x.yml --time=NaN", "seconds above 0"),
            ("arty x.yml --exposure=NaN", "from -100 to 100"),
            ("arty x.yml --threads=0", "1..=1024"),
            ("arty x.yml --output=x.jpg", "must end in .png or .exr"),
            ("arty x.yml --output=x", "must end in .png or .exr"),
            ("arty x.yml --seed=-1", "--seed"),
            ("arty x.yml --max-bounces=1.5", "--max-bounces"),
            ("arty x.yml --show=albedo", "--algo=debug"),
            ("arty x.yml --algo=debug --reference=x.exr", "--algo=debug"),
            ("arty x.yml --errors=x.csv", "--reference"),
            ("arty x.yml y.yml", "y.yml"),
            ("arty x.yml --samples=1 --samples=2", "--samples"),
        ];
        for (line, expected) in cases {
            let message = refusal(line);
            assert!(message.starts_with("error: ") && message.contains(expected), "{line}: {message}");
        }
    }

    #[test]
    fn help_and_version_are_not_errors() {
        for line in ["arty --help", "arty -h", "arty --version"] {
            let answer = read(line).expect_err("it is an answer");
            assert!(!answer.use_stderr(), "{line}");
        }
        let help = read("arty --help").expect_err("it is an answer").to_string();
        for option in ["--technique", "-sx", "Examples:", "Exit status:", "Next event estimation"] {
            assert!(help.contains(option), "{option} is missing in {help}");
        }
    }
}
