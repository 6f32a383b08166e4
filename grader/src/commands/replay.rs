//! `grader replay`.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use super::intake::{reader, wanted};
use arty::integrator::Technique;
use harness::assignment::{Assignment, AssignmentOption};
use serde::Serialize;

use harness::build::compile;
use harness::job::JobError;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::reference::Oracle;
use judge::replay::{follow, load, vertices};
use present::replay::print;
use present::streams::unless_unread;
use present::words::replay_command;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::replay::{ReplayTarget, ReplayedPath, Vertex};
use verdict::rubric::EmissionOnHit;

/// Replay one path of a submission and show every call it makes; reports give this command for their findings
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A source file, or a folder with one in it [default: the student file of the assignment]
    submission: Option<PathBuf>,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Name of a scene in scenes/ or scenes/extreme/, or stability-room
    #[arg(long)]
    scene: String,
    /// Column and row of the pixel, from the upper left
    #[arg(long, value_name = "X,Y", value_parser = |text: &str| pair(text, ','))]
    pixel: [u32; 2],
    /// Index of the sample within the pixel
    #[arg(long)]
    sample: u64,
    /// Technique: bsdf, nee or mis
    #[arg(long, default_value_t = Technique::Mis)]
    technique: Technique,
    /// Maximum number of bounces: 0 = emission only, 1 = direct light
    #[arg(long, default_value_t = 8)]
    max_bounces: u32,
    /// Seed of the rendering
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Width and height of the image [default: those of the scene]
    #[arg(long, value_name = "WxH", value_parser = |text: &str| pair(text, 'x'))]
    size: Option<[u32; 2]>,
    /// Multiply all lengths of the scene by this factor
    #[arg(long, default_value_t = 1.0, value_parser = factor)]
    scale: f64,
    /// Multiply the emission of all lights by this factor
    #[arg(long, default_value_t = 1.0, value_parser = factor)]
    emission: f64,
    /// off: lights emit nothing when a path hits them
    #[arg(long, value_name = "on|off", default_value = "on", value_parser = emission_on_hit)]
    emission_on_hit: EmissionOnHit,
    /// Old name of `--emission-on-hit=off`
    #[arg(long, hide = true)]
    hits_off: bool,
    /// Show the path in a window, over the picture; only for the student file in the skeleton
    #[arg(long, conflicts_with_all = ["json", "student"])]
    view: bool,
    /// Do not trace the path with the solution as well
    #[arg(long)]
    student: bool,
    /// Also write the replay to this file as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The two paths, and the one reason why there may be only one.
#[derive(Serialize)]
struct Replay<'a> {
    schema: &'a str,
    command: &'a str,
    submission: &'a ReplayedPath,
    #[serde(skip_serializing_if = "Option::is_none")]
    solution: Option<&'a ReplayedPath>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertices: Option<&'a [Vertex]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<&'a str>,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let assignment = arguments.assignment.open(workspace)?;
    let path = arguments.submission.clone().unwrap_or_else(|| assignment.student_file());
    let mut target = arguments.target()?;
    let description = load(workspace, &target)?;
    // As `cargo arty` renders it.
    let suggested = description.defaults;
    let [width, height] =
        arguments.size.unwrap_or([suggested.width.unwrap_or(512), suggested.height.unwrap_or(412)]);
    if target.pixel[0] >= width || target.pixel[1] >= height {
        return Err(Error::Input(format!("--pixel: the image has {width} x {height} pixels")));
    }
    target.size = [width, height];
    if arguments.view {
        return view(&target, &path, workspace, &assignment);
    }
    let submission = reader().read(&path, &wanted(&assignment)?)?;
    let program = compile(&assignment.framework(workspace)?, &submission.source, &Limits::default())?
        .map_err(|failure| Error::Input(format!("the submission does not compile:\n{}", failure.messages)))?;
    let submission = follow(&program, &target, &description).map_err(|error| match error {
        JobError::Submission(fault) => Error::Input(format!("the submission: {fault}")),
        JobError::Harness(error) => error,
    })?;
    let (solution, left_out) = if arguments.student {
        (None, Some("the solution's path is skipped (--student)"))
    } else if !assignment.has_solution() {
        (None, Some("the solution's path is skipped: this checkout does not have the solution"))
    } else {
        let program = Oracle::required(workspace, &assignment)?;
        let path = follow(&program, &target, &description);
        (Some(path.map_err(|error| error.of_trusted("the solution"))?), None)
    };
    let vertices = solution.as_ref().map(|path| vertices(path, target.technique, &description));
    let replay = Replay {
        schema: "arty-replay/2",
        command: &replay_command(&target, &path.to_string_lossy()),
        submission: &submission,
        solution: solution.as_ref(),
        vertices: vertices.as_deref(),
        left_out,
    };
    unless_unread(replay.show())?;
    if let Some(file) = &arguments.json {
        output::write_json(file, &replay)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Opens the window, a program of its own that is built with the student file, and waits until it is closed.
fn view(
    target: &ReplayTarget,
    submission: &Path,
    workspace: &Workspace,
    assignment: &Assignment,
) -> Result<ExitCode> {
    let student_file = assignment.student_file();
    let name = assignment.rubric.submission.name();
    let file = if submission.is_dir() { submission.join(name) } else { submission.to_owned() };
    let same = |path: &Path| path.canonicalize().ok();
    if same(&file).is_none_or(|file| Some(file) != same(&student_file)) {
        return Err(Error::Input(format!("--view: the window shows {} only", student_file.display())));
    }
    let is_plain = (target.scale, target.emission, target.emission_on_hit) == (1.0, 1.0, EmissionOnHit::On);
    let files = [workspace.scene_file(&target.scene), workspace.extreme_scene_file(&target.scene)];
    let scene = files.iter().find(|file| file.is_file()).filter(|_| is_plain).ok_or_else(|| {
        Error::Input("--view: the window shows scenes as they are in scenes/, not changed ones".to_owned())
    })?;
    let ReplayTarget { technique, max_bounces, size: [width, height], seed, pixel: [x, y], sample, .. } =
        target;
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(workspace.root()).arg("view").arg(scene).args([
        format!("--technique={technique}"),
        format!("--max-bounces={max_bounces}"),
        format!("--width={width}"),
        format!("--height={height}"),
        format!("--seed={seed}"),
        format!("--pixel={x},{y}"),
        format!("--sample={sample}"),
    ]);
    let status = command.status().map_err(|error| Error::Harness(format!("cargo view: {error}")))?;
    match status.code() {
        Some(0) => Ok(ExitCode::SUCCESS),
        // It has said why.
        code => Ok(ExitCode::from(code.and_then(|code| u8::try_from(code).ok()).unwrap_or(3))),
    }
}

impl Arguments {
    fn target(&self) -> Result<ReplayTarget> {
        if self.hits_off {
            return Err(Error::Input("--hits-off is now called --emission-on-hit=off".to_owned()));
        }
        Ok(ReplayTarget {
            scene: self.scene.clone(),
            scale: self.scale,
            emission: self.emission as f32,
            technique: self.technique,
            max_bounces: self.max_bounces,
            emission_on_hit: self.emission_on_hit,
            size: self.size.unwrap_or_default(),
            seed: self.seed,
            pixel: self.pixel,
            sample: self.sample,
        })
    }
}

impl Replay<'_> {
    /// Prints both paths as tables.
    fn show(&self) -> std::io::Result<()> {
        use std::io::Write;
        let mut out = std::io::stdout().lock();
        print(&mut out, "The submission", self.submission, None)?;
        if let Some(path) = self.solution {
            writeln!(out)?;
            print(&mut out, "The solution", path, self.vertices)?;
        }
        self.left_out.map_or(Ok(()), |why| writeln!(out, "{why}"))
    }
}

/// Reads two whole numbers.
fn pair(text: &str, separator: char) -> std::result::Result<[u32; 2], String> {
    let parts =
        text.split_once(separator).and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
    parts.ok_or_else(|| format!("expected two whole numbers separated by `{separator}`"))
}

/// Reads a positive factor that single precision holds.
fn factor(text: &str) -> std::result::Result<f64, String> {
    let value: Option<f64> = text.parse().ok();
    let is_positive = |value: &f64| (*value as f32).is_normal() && *value > 0.0;
    value.filter(is_positive).ok_or_else(|| "not a positive number".to_owned())
}

fn emission_on_hit(text: &str) -> std::result::Result<EmissionOnHit, String> {
    match text {
        "on" => Ok(EmissionOnHit::On),
        "off" => Ok(EmissionOnHit::Off),
        _ => Err("expected on or off".to_owned()),
    }
}
