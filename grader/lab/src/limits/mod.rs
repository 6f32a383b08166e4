//! The numerical range of the renderer: very small and very large scenes, lights very near and very far, very dim and
//! very bright.
//!
//! [`sweeps`] take one number through many decades until the renderer breaks, and [`mod@write`] makes tables and plots of
//! that; beside them stand the extreme scenes of `scenes/extreme/`. All of it is measured with the solution: the check
//! `stability` asks submissions for the part that is graded. The results are in `grader/lab/limits/`.

pub mod sweep;
pub mod sweeps;
pub mod write;

use std::path::Path;
use std::time::Instant;

use arty::integrator::Technique;

use crate::output::write_text;
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use harness::workspace::Workspace;
use judge::extreme::answers;
use judge::extreme::measure::{ExtremeSceneResult, MinPaths, measure_all};
use sweep::Sweep;
use sweeps::{Context, SWEEPS};
use verdict::error::{Error, Result};

/// Paths for each extreme scene.
const SCENE_EFFORT: MinPaths = MinPaths(1 << 18);

/// Paths for each point of a sweep.
const SWEEP_EFFORT: MinPaths = MinPaths(1 << 14);

/// Name of the extreme scenes beside those of the sweeps.
const SCENES: &str = "scenes";

/// What is to be measured.
pub struct Measurement<'a> {
    only: &'a [String],
    seed: u64,
}

/// What was measured.
pub struct Measured {
    /// The extreme scenes.
    pub findings: Vec<ExtremeSceneResult>,
    /// The sweeps.
    pub sweeps: Vec<Sweep>,
}

impl<'a> Measurement<'a> {
    /// Sweeps by name, or `scenes`; everything if `only` is empty.
    ///
    /// # Errors
    /// If there is no sweep of a name.
    pub fn new(only: &'a [String], seed: u64) -> Result<Self> {
        let names = || SWEEPS.iter().map(|(name, _)| *name).chain([SCENES]);
        match only.iter().find(|only| !names().any(|name| name == **only)) {
            Some(unknown) => {
                let names = names().collect::<Vec<_>>().join(", ");
                Err(Error::Input(format!("--only: there is no sweep `{unknown}`; known: {names}")))
            }
            None => Ok(Self { only, seed }),
        }
    }

    fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|only| only == name)
    }

    /// Measures, and writes each sweep into a folder as soon as it is done.
    ///
    /// # Errors
    /// If the program fails or a file cannot be written.
    pub fn run(&self, workspace: &Workspace, program: &SubmissionProgram, folder: &Path) -> Result<Measured> {
        let mut measured = Measured { findings: Vec::new(), sweeps: Vec::new() };
        if self.wants(SCENES) {
            measured.findings = extreme_scenes(workspace, program, self.seed)?;
        }
        let context = Context { program, seed: self.seed, effort: SWEEP_EFFORT };
        for (name, measure) in SWEEPS.iter().filter(|(name, _)| self.wants(name)) {
            let start = Instant::now();
            let sweep = measure(&context)?;
            write_text(&folder.join(sweep.name).with_extension("csv"), &write::csv(&sweep)?)?;
            write_text(&folder.join(sweep.name).with_extension("svg"), &write::svg(&sweep)?)?;
            eprintln!("{name}: {:.1} s", start.elapsed().as_secs_f64());
            measured.sweeps.push(sweep);
        }
        Ok(measured)
    }
}

impl Measured {
    /// All of it as Markdown.
    pub fn summary(&self, command: &str) -> String {
        write::markdown(&self.findings, &self.sweeps, command)
    }

    /// Writes the summary beside the tables and plots of the sweeps.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, folder: &Path, command: &str) -> Result<()> {
        write_text(&folder.join("limits.md"), &self.summary(command))
    }
}

fn extreme_scenes(
    workspace: &Workspace,
    program: &SubmissionProgram,
    seed: u64,
) -> Result<Vec<ExtremeSceneResult>> {
    let extremes = answers::load(workspace)?;
    let mut all = Vec::new();
    for technique in Technique::ALL {
        eprintln!("extreme scenes, {technique} …");
        let mut process = HostProcess::start(program, rayon::current_num_threads())?;
        let found = measure_all(&mut process, &extremes, technique, SCENE_EFFORT, seed, |_| true);
        all.extend(found.map_err(|error| error.of_trusted("the solution"))?);
    }
    Ok(all)
}
