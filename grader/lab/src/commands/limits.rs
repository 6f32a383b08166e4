//! `cargo lab limits`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use arty::integrator::Technique;

use crate::limits::sweep::Sweep;
use crate::limits::sweeps::{self, Renderer};
use crate::limits::write;
use harness::host_process::HostProcess;
use harness::workspace::Workspace;
use judge::extreme::answers;
use judge::extreme::measure::{Effort, Finding, findings};
use judge::reference::Oracle;
use verdict::error::{Error, Result};

/// Measure the renderer's numerical range: renders every extreme scene and all sweeps, some minutes in all
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Only these sweeps, by name, or `scenes`; may be given several times. The summary is then printed, not written
    #[arg(long, value_name = "SWEEP")]
    only: Vec<String>,
    /// Folder of tables and plots [default: grader/stability]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Paths for each extreme scene, and for each point of a sweep.
const SCENE_EFFORT: Effort = Effort(1 << 18);
const SWEEP_EFFORT: Effort = Effort(1 << 14);

const COMMAND: &str = "cargo lab limits";

/// Exit status 1 if the framework shows an extreme scene wrongly.
pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let folder = arguments.out.clone().unwrap_or_else(|| workspace.stability());
    std::fs::create_dir_all(&folder).map_err(|error| Error::file(&folder, error))?;
    let program = Oracle::required(&workspace)?;
    let renderer = Renderer::new(&program, arguments.seed, SWEEP_EFFORT);
    let wanted = |name: &str| arguments.only.is_empty() || arguments.only.iter().any(|only| only == name);
    let seed = arguments.seed;

    type Make<'a> = Box<dyn Fn() -> Result<Sweep> + 'a>;
    let all: Vec<(&str, Make<'_>)> = vec![
        ("scale", Box::new(|| sweeps::scale(&renderer))),
        ("offset", Box::new(|| sweeps::offset(&renderer))),
        ("light-distance", Box::new(|| sweeps::light_distance(&renderer))),
        ("light-size", Box::new(|| sweeps::light_size(&renderer))),
        ("radiance", Box::new(|| sweeps::radiance(&renderer))),
        ("exponent", Box::new(|| sweeps::exponent(&renderer))),
        ("glass-index", Box::new(|| sweeps::glass_index(&renderer))),
        ("scale-of-rays", Box::new(|| Ok(sweeps::scale_of_rays(seed)))),
        ("offset-of-rays", Box::new(|| Ok(sweeps::offset_of_rays(seed)))),
        ("triangles", Box::new(|| Ok(sweeps::triangles(seed)))),
        ("lights", Box::new(|| sweeps::lights(&program, seed))),
        ("bounces", Box::new(|| sweeps::bounces(&program, seed))),
    ];
    if let Some(unknown) =
        arguments.only.iter().find(|only| *only != "scenes" && !all.iter().any(|(name, _)| name == only))
    {
        let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        return Err(Error::Input(format!(
            "--only: no sweep `{unknown}`; there are scenes, {}",
            names.join(", ")
        )));
    }

    let mut seen = Vec::new();
    if wanted("scenes") {
        let extremes = answers::load(&workspace)?;
        for technique in Technique::ALL {
            eprintln!("extreme scenes, {technique} …");
            let mut process = HostProcess::start(&program, rayon::current_num_threads())?;
            let found = findings(&mut process, &extremes, technique, SCENE_EFFORT, seed, |_| true)?
                .map_err(|fault| Error::Harness(format!("the solution: {fault}")))?;
            seen.extend(found);
        }
    }
    let mut measured = Vec::new();
    for (name, make) in all.iter().filter(|(name, _)| wanted(name)) {
        let start = Instant::now();
        let sweep = make()?;
        save(&folder, &sweep)?;
        eprintln!("{name}: {:.1} s", start.elapsed().as_secs_f64());
        measured.push(sweep);
    }
    let summary = write::markdown(&seen, &measured, COMMAND);
    if arguments.only.is_empty() {
        write::text(&folder.join("limits.md"), &summary)?;
        eprintln!("tables and plots: {}", folder.display());
    } else {
        print!("{summary}");
    }
    let wrong: Vec<&Finding> = seen.iter().filter(|finding| !finding.is_right()).collect();
    for finding in &wrong {
        println!("wrong: {} with {}", finding.scene, finding.settings.technique);
    }
    println!("{} of {} extreme scenes are right", seen.len() - wrong.len(), seen.len());
    Ok(ExitCode::from(u8::from(!wrong.is_empty())))
}

/// Each sweep is written as soon as it is there.
fn save(folder: &Path, sweep: &Sweep) -> Result<()> {
    write::text(&folder.join(sweep.name).with_extension("csv"), &write::csv(sweep))?;
    write::text(&folder.join(sweep.name).with_extension("svg"), &write::svg(sweep)?)
}
