//! The program: from arguments to a window.

use std::path::Path;
use std::process::{Command, ExitCode};
use std::sync::Arc;

use arty::cli::{DEFAULT_MAX_BOUNCES, image_size, scene_file};
use arty::integrator::Settings;
use arty::scene::{Scene, file};
use clap::Parser;

use crate::args::Args;
use crate::path::Query;
use crate::reference::Reference;
use crate::renderer::Setup;
use crate::view::Make;
use crate::viewer::Viewer;
use crate::window::{self, Content};

/// What differs between programs with a window.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// Makes the integrator for an algorithm.
    pub make: Make,
    /// The file with the algorithm, for `--watch`.
    pub source: &'static str,
    /// The folder of the workspace.
    pub workspace: &'static str,
    /// Arguments of `cargo build` in the workspace that compile this program again.
    pub build: &'static [&'static str],
}

/// Why there is no window.
pub(crate) enum Failure {
    /// Invalid input, or no display.
    Refused(String),
    /// An internal error.
    Broken(String),
}

/// Runs a program with the arguments of this process.
///
/// The exit status is 0 when the window is closed; 2 for an invalid command line or scene, or if there is no display; 3 for
/// an internal error.
pub fn run(program: &Program) -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(answer) => {
            // A closed pipe is not an error.
            let _ = answer.print();
            return if answer.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS };
        }
    };
    let (message, status) = match open(program, args) {
        Ok(()) => return ExitCode::SUCCESS,
        Err(Failure::Refused(message)) => (message, 2),
        Err(Failure::Broken(message)) => (message, 3),
    };
    eprintln!("error: {message}");
    ExitCode::from(status)
}

fn open(program: &Program, mut args: Args) -> Result<(), Failure> {
    let refuse = |error: arty::diagnostic::Diagnostic| Failure::Refused(error.to_string());
    args.scene = scene_file(&args.scene).map_err(refuse)?;
    let loaded = file::load(&args.scene).map_err(refuse)?;
    let scene = Scene::new(&loaded.description);
    loaded.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    scene.warnings().iter().for_each(|warning| eprintln!("warning: {warning}"));

    let reference = args.reference.as_deref().map(Reference::read).transpose().map_err(refuse)?;
    let mut defaults = scene.defaults();
    if let Some(reference) = &reference {
        let image = &reference.image;
        (defaults.width, defaults.height) = (Some(image.width() as u32), Some(image.height() as u32));
        defaults.max_bounces = reference.max_bounces.or(defaults.max_bounces);
    }
    let size = image_size(args.width, args.height, defaults);
    if let (Some(reference), Some(path)) = (&reference, &args.reference) {
        let (width, height) = (reference.image.width(), reference.image.height());
        if (size.0 as usize, size.1 as usize) != (width, height) {
            let (path, (w, h)) = (path.display(), size);
            return Err(Failure::Refused(format!(
                "{path}: the reference has {width} x {height} pixels, the picture would have {w} x {h}; omit --width \
                 and --height to render it in the size of the reference"
            )));
        }
    }
    let max_bounces = args.max_bounces.or(defaults.max_bounces).unwrap_or(DEFAULT_MAX_BOUNCES);
    let settings = Settings { technique: args.technique, max_bounces };
    let viewer = viewer(&args, loaded.description.camera, settings, size, reference.is_some())?;
    let setup = Setup {
        description: Arc::new(loaded.description),
        width: size.0,
        height: size.1,
        seed: args.seed,
        samples: args.samples,
        threads: args.threads.map_or(0, usize::from),
        reference: reference.map(Arc::new),
    };
    window::open(Content { program: *program, args, scene: Arc::new(scene), setup, viewer })
}

/// The state in the beginning, or as it was before a reload.
fn viewer(
    args: &Args,
    camera: arty::camera::CameraDescription,
    settings: Settings,
    size: (u32, u32),
    has_reference: bool,
) -> Result<Viewer, Failure> {
    let mut viewer = Viewer::new(camera, settings, size, has_reference);
    if let Some(camera) = args.camera {
        viewer.camera.move_to(camera);
    }
    viewer.look.exposure = args.exposure;
    if let Some(pixel) = args.pixel {
        if pixel.0 >= size.0 || pixel.1 >= size.1 {
            return Err(Failure::Refused(format!("--pixel: the picture has {} x {} pixels", size.0, size.1)));
        }
        viewer.query = Some(Query { camera: viewer.camera.now(), settings, pixel, sample: args.sample });
    }
    Ok(viewer)
}

impl Program {
    /// The command that compiles this program again, in the profile it was compiled in.
    pub(crate) fn build(&self) -> Command {
        let executable = std::env::current_exe().unwrap_or_default();
        let folder = executable.parent().and_then(Path::file_name).unwrap_or_default();
        let profile = if folder == "debug" { "dev".into() } else { folder.to_string_lossy() };
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command
            .arg("build")
            .args(self.build)
            .arg(format!("--profile={profile}"))
            .args(["--quiet", "--color=never"]);
        command.current_dir(self.workspace);
        command
    }
}
