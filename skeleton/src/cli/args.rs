//! The command line as it is written.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Parser, ValueEnum, value_parser};

use super::output::Output;
use super::{DebugView, original_options};
use crate::image::tev;
use crate::integrator::Technique;

/// Renders a scene.
///
/// All randomness comes from the seed: the same command line gives the same picture, to the last bit, with any
/// number of threads.
#[derive(Debug, Parser)]
#[command(name = "arty", version, max_term_width = 100, after_help = SHORT_EXAMPLES, after_long_help = EXAMPLES)]
pub(super) struct Args {
    /// The scene file (YAML)
    #[arg(value_name = "SCENE.yml")]
    pub(super) scene: PathBuf,

    /// What to render with
    #[arg(short, long, value_enum, default_value_t = Algo::Pt, help_heading = ALGORITHM)]
    pub(super) algo: Algo,

    /// How the path tracer looks for light
    #[arg(long, value_enum, default_value_t = Technique::Mis, help_heading = ALGORITHM)]
    pub(super) technique: Technique,

    /// How often a path is scattered at most: 0 shows lights only, 1 direct light [default: the scene's, else 8]
    #[arg(long, value_name = "N", help_heading = ALGORITHM)]
    pub(super) max_bounces: Option<u32>,

    /// What --algo=debug shows [default: normals]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = ALGORITHM)]
    pub(super) show: Option<DebugView>,

    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = ALGORITHM)]
    pub(super) seed: u64,

    /// Width in pixels (also -sx) [default: in proportion to the height, or the scene's, or 512]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=MAX_SIDE), help_heading = PICTURE)]
    pub(super) width: Option<u32>,

    /// Height in pixels (also -sy) [default: in proportion to the width, or the scene's, or 412]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=MAX_SIDE), help_heading = PICTURE)]
    pub(super) height: Option<u32>,

    /// Samples per pixel [default: 64, or no limit with --time]
    ///
    /// With --time, whichever limit comes first counts.
    #[arg(short, long, value_name = "N", value_parser = value_parser!(u64).range(1..), help_heading = PICTURE)]
    pub(super) samples: Option<u64>,

    /// Seconds to render for; each pixel gets at least one sample
    #[arg(short, long, value_name = "SECONDS", value_parser = seconds, help_heading = PICTURE)]
    pub(super) time: Option<Duration>,

    /// Where to save the picture: a .png to look at, an .exr to compute with; may be given several times
    /// [default: `<scene>.png`, here]
    ///
    /// An earlier file of that name is replaced. An OpenEXR file holds the mean and (from two samples per pixel
    /// on) the variance of the mean of each pixel, and how the picture was made.
    #[arg(short, long, value_name = "FILE", value_parser = PathBufValueParser::new().try_map(Output::new),
          help_heading = OUTPUT)]
    pub(super) output: Vec<Output>,

    /// Brightens the PNG by this many stops (may be negative)
    #[arg(long, value_name = "EV", default_value_t = 0.0, value_parser = exposure, allow_negative_numbers = true,
          help_heading = OUTPUT)]
    pub(super) exposure: f32,

    /// Shows the picture in the viewer tev while it is rendered
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, require_equals = true,
          default_missing_value = tev::DEFAULT_ADDRESS, help_heading = OUTPUT)]
    pub(super) tev: Option<String>,

    /// Prints and saves the error against this OpenEXR picture while rendering (relative MSE, MSE)
    ///
    /// The picture gets the size of the reference, which --width and --height must not contradict, and its bounces.
    /// A layer `variance` in the reference (the program saves one) is subtracted: it is the reference's own noise.
    /// There are pictures to compare with in references/pictures. They have 256 samples per pixel and say nothing of
    /// their noise: errors close to it flatten. Render a reference of your own for long curves.
    #[arg(long, value_name = "REF.exr", help_heading = OUTPUT)]
    pub(super) reference: Option<PathBuf>,

    /// Where to save the errors that --reference gives, as CSV [default: `<scene>.errors.csv`, here]
    #[arg(long, value_name = "FILE.csv", requires = "reference", help_heading = OUTPUT)]
    pub(super) errors: Option<PathBuf>,

    /// Number of threads [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024), help_heading = OTHER)]
    pub(super) threads: Option<u16>,

    /// Prints what there is in the scene, and renders nothing
    #[arg(long, help_heading = OTHER)]
    pub(super) features: bool,

    /// Says nothing but warnings and errors
    #[arg(short, long, help_heading = OTHER)]
    pub(super) quiet: bool,
}

/// What to render with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Algo {
    /// Properties of the surfaces that the camera sees
    Debug,
    /// Path tracing
    Pt,
}

const ALGORITHM: &str = "Algorithm";
const PICTURE: &str = "Picture";
const OUTPUT: &str = "Output";
const OTHER: &str = "Other";

/// The most columns or rows, as in scene files.
const MAX_SIDE: i64 = 65536;

const SHORT_EXAMPLES: &str = "Example: arty --algo=pt scenes/cornell_box.yml --samples=16\nMore with --help.";

const EXAMPLES: &str = "\
Examples:
  arty --algo=pt scenes/cornell_box_water.yml --width=512 --height=412
      The picture of the sheet, as cornell_box_water.png in the current folder.
  arty scenes/cornell_box.yml --technique=nee --max-bounces=1 --samples=10
      Direct light only, to look for faults in next event estimation.
  arty scenes/veach_mis.yml --time=10 -o bsdf.png -o bsdf.exr --technique=bsdf
      Ten seconds of work, as a picture to look at and one to compute with.
  arty scenes/cornell_box.yml --algo=debug --show=normals -s 4
      Are the surfaces where they should be?
  arty scenes/cornell_box.yml --time=20 --reference=references/pictures/cornell_box.exr
      Also the error after 1, 2, 4, … samples, as cornell_box.errors.csv, to plot over time.
  arty scenes/cornell_box.yml --samples=100000 --tev
      Watch it grow in tev; Ctrl-C stops and saves what is there, twice Ctrl-C quits at once.

Exit status:
  0    the picture is saved as it was asked for
  2    the command line, the scene or a place for the picture is wrong; nothing was rendered
  3    the program itself failed, or the algorithm panicked
  130  interrupted; the picture is saved with the samples it had by then";

impl Args {
    /// The command line of a process, the program's name first.
    ///
    /// # Errors
    ///
    /// What is wrong with it, or the help or version that it asks for.
    pub(super) fn read(arguments: impl Iterator<Item = OsString>) -> Result<Self, clap::Error> {
        let args = Self::try_parse_from(original_options::rewrite(arguments))?;
        if args.show.is_some() && args.algo != Algo::Debug {
            let message = "--show is about --algo=debug, which is not asked for";
            return Err(conflict(message));
        }
        if args.reference.is_some() && args.algo == Algo::Debug {
            return Err(conflict("--reference is about light: it cannot go with --algo=debug"));
        }
        Ok(args)
    }
}

fn conflict(message: &str) -> clap::Error {
    <Args as clap::CommandFactory>::command().error(clap::error::ErrorKind::ArgumentConflict, message)
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds.filter(|time| !time.is_zero()).ok_or_else(|| "expected a number of seconds above 0".to_owned())
}

fn exposure(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops| (-100.0..=100.0).contains(stops));
    stops.ok_or_else(|| "expected a number of stops from -100 to 100".to_owned())
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
    fn short_options_of_the_original_mean_the_same() {
        let short = read("arty -a debug -sx 64 -sy=48 -s 3 -t 1.5 -o x.PNG x.yml").expect("valid");
        let long =
            read("arty x.yml --algo=debug --width=64 --height=48 --samples=3 --time=1.5 --output=x.PNG");
        assert_eq!(format!("{short:?}"), format!("{:?}", long.expect("valid")));
        assert_eq!((short.width, short.height, short.samples), (Some(64), Some(48), Some(3)));
        assert_eq!((short.algo, short.time), (Algo::Debug, Some(Duration::from_millis(1500))));
    }

    #[test]
    fn several_pictures_may_be_asked_for() {
        let args = read("arty x.yml --output=a.png -o out/b.exr").expect("valid");
        let paths: Vec<_> = args.output.iter().map(|output| output.path().to_str()).collect();
        assert_eq!(paths, [Some("a.png"), Some("out/b.exr")]);
    }

    #[test]
    fn exposures_may_be_negative() {
        assert_eq!(read("arty x.yml --exposure=-1.5").expect("valid").exposure, -1.5);
        assert_eq!(read("arty x.yml --exposure -2").expect("valid").exposure, -2.0);
    }

    #[test]
    fn the_viewer_has_an_address_of_its_own() {
        assert_eq!(read("arty --tev x.yml").expect("valid").tev.as_deref(), Some(tev::DEFAULT_ADDRESS));
        assert_eq!(read("arty --tev=host:1 x.yml").expect("valid").tev.as_deref(), Some("host:1"));
    }

    #[test]
    fn bad_values_are_refused_with_what_was_expected() {
        let cases = [
            ("arty", "SCENE.yml"),
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
            ("arty x.yml --output=x.jpg", "ends in .png or .exr"),
            ("arty x.yml --output=x", "ends in .png or .exr"),
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
    fn help_and_version_are_no_errors() {
        for line in ["arty --help", "arty -h", "arty --version"] {
            let answer = read(line).expect_err("it is an answer");
            assert!(!answer.use_stderr(), "{line}");
        }
        let help = read("arty --help").expect_err("it is an answer").to_string();
        for option in ["--technique", "-sx", "Examples:", "Exit status:", "By next event estimation"] {
            assert!(help.contains(option), "{option} is missing in {help}");
        }
    }
}
