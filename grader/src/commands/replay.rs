//! `grader replay`.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use arty::integrator::Technique;
use host::protocol::Switches;
use serde::Serialize;

use harness::build::{Framework, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::reference::Oracle;
use judge::reference::SIZE;
use judge::replay::{Place, follow, vertices};
use present::replay::print;
use verdict::error::{Error, Result};
use verdict::replay::{Path, Vertex};

/// Follow one path of a submission again and show every call that it made. Reports give the command for their findings.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A render_pt.rs, or a folder with one in it
    submission: PathBuf,
    /// A scene of scenes/ or scenes/extreme/ by name, or stability-room
    #[arg(long)]
    scene: String,
    /// Column and row of the pixel, from the upper left
    #[arg(long, value_name = "X,Y", value_parser = |text: &str| pair(text, ','))]
    pixel: [u32; 2],
    /// Number of the sample
    #[arg(long)]
    sample: u64,
    /// Technique: bsdf, nee or mis
    #[arg(long, default_value_t = Technique::Mis)]
    technique: Technique,
    /// Largest number of bounces
    #[arg(long, default_value_t = 8)]
    max_bounces: u32,
    /// Seed of the rendering
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Width and height of the picture [default: that of references]
    #[arg(long, value_name = "WxH", value_parser = |text: &str| pair(text, 'x'))]
    size: Option<[u32; 2]>,
    /// Make the scene this many times as large
    #[arg(long, default_value_t = 1.0, value_parser = factor)]
    scale: f64,
    /// Make its lights this many times as bright
    #[arg(long, default_value_t = 1.0, value_parser = factor)]
    emission: f64,
    /// Lights that are hit emit nothing
    #[arg(long)]
    hits_off: bool,
    /// Leave out the solution's own path
    #[arg(long)]
    student: bool,
    /// Write everything to this file, as JSON, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Serialize)]
struct Output<'a> {
    schema: &'a str,
    command: &'a str,
    submission: &'a Path,
    #[serde(skip_serializing_if = "Option::is_none")]
    solution: Option<&'a Path>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertices: Option<&'a [Vertex]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<&'a str>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let emission = arguments.emission as f32;
    let size = arguments.size.unwrap_or([SIZE.0, SIZE.1]);
    if size.contains(&0) || size[0] <= arguments.pixel[0] || size[1] <= arguments.pixel[1] {
        return Err(Error::Input(format!("--pixel: the picture is {} x {} pixels", size[0], size[1])));
    }
    let place = Place {
        scene: arguments.scene.clone(),
        description: Place::load(&workspace, &arguments.scene, arguments.scale, emission)?,
        scale: arguments.scale,
        emission,
        technique: arguments.technique,
        max_bounces: arguments.max_bounces,
        size,
        seed: arguments.seed,
        pixel: arguments.pixel,
        sample: arguments.sample,
        switches: Switches { emission_on_hit: !arguments.hits_off },
    };
    let submission = intake::read(&arguments.submission)?;
    let program = compile(&Framework::build(&workspace)?, &submission.source, &Limits::default())?
        .map_err(|failure| Error::Input(format!("the submission does not compile:\n{}", failure.messages)))?;
    let submission =
        follow(&program, &place)?.map_err(|fault| Error::Input(format!("the submission: {fault}")))?;

    let (own, left_out) = if arguments.student {
        (None, Some("the solution's path is left out, as asked for"))
    } else if !workspace.solution_file().is_file() {
        (None, Some("the solution's path is left out: there is no solution/ here"))
    } else {
        let solution = Oracle::required(&workspace)?;
        let path =
            follow(&solution, &place)?.map_err(|fault| Error::Harness(format!("the solution: {fault}")))?;
        (Some(path), None)
    };
    let weighted = own.as_ref().map(|path| vertices(path, &place));

    if let Some(file) = &arguments.json {
        let command = place.command(&verdict::text::quote(&arguments.submission));
        let output = Output {
            schema: "arty-replay/1",
            command: &command,
            submission: &submission,
            solution: own.as_ref(),
            vertices: weighted.as_deref(),
            left_out,
        };
        arty::image::write_aside(file, |writer| serde_json::to_writer_pretty(writer, &output))?;
    }
    // Nobody may be reading any more (`… | head`).
    let _ = show(&submission, own.as_ref(), weighted.as_deref(), left_out);
    Ok(ExitCode::SUCCESS)
}

fn show(
    submission: &Path,
    own: Option<&Path>,
    vertices: Option<&[Vertex]>,
    left_out: Option<&str>,
) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    print(&mut out, "The submission", submission, None)?;
    if let Some(path) = own {
        writeln!(out)?;
        print(&mut out, "The solution", path, vertices)?;
    }
    left_out.map_or(Ok(()), |why| writeln!(out, "{why}"))
}

/// Two whole numbers.
fn pair(text: &str, between: char) -> std::result::Result<[u32; 2], String> {
    let parts =
        text.split_once(between).and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
    parts.ok_or_else(|| format!("two whole numbers with `{between}` between them are wanted"))
}

/// A factor that single precision holds.
fn factor(text: &str) -> std::result::Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (value as f32).is_normal() && value > 0.0 {
        Ok(value)
    } else {
        Err("not a positive number".to_owned())
    }
}
