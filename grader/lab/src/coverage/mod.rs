//! How often the intervals of a convergence measurement hold the truth, and which differences they show.
//!
//! The solution is measured beside itself: then the truth is known, or known far better from all comparisons together than
//! from one. `planted` programs show what a measurement makes of known differences. Comparisons are kept on disk, so
//! that the next run resumes.

mod load;
mod planted;
mod records;
mod table;

use std::time::Instant;

use harness::assignment::Assignment;
use harness::build::{SubmissionProgram, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::convergence::{MeasuredProgram, Options, measure};
use load::Load;
use planted::{PLANTED, planted};
pub use records::{Record, Records};
pub use table::table;
use verdict::convergence::{Panel, Role};
use verdict::error::{Error, Result};

/// Scenes of the comparisons: diffuse, glossy, both, a mix of light sizes, caustics, and point lights.
pub const SCENES: [&str; 6] = [
    "cornell_box",
    "cornell_box_glossy",
    "veach_mis",
    "mixed_lights",
    "cornell_box_water",
    "cornell_box_point",
];

/// Scene in which planted programs are measured: its errors have light tails, so that it tells small differences apart.
const PLANTED_SCENE: &str = "cornell_box_glossy";

/// Number of rendering lengths.
const LENGTHS: u32 = 4;

/// Comparisons to make.
pub struct Experiment<'a> {
    /// The checkout.
    pub workspace: &'a Workspace,
    /// The assignment whose solution is measured.
    pub assignment: &'a Assignment,
    /// Number of comparisons of the solution with itself, over all scenes and both loads.
    pub comparisons: u64,
    /// Number of comparisons with each planted program.
    pub planted: u64,
    /// Processor time of one comparison in seconds; planted programs get four times as much.
    pub seconds: f64,
    /// Number of busy threads in every other comparison.
    pub load: usize,
    /// When to stop.
    pub deadline: Option<Instant>,
}

impl Experiment<'_> {
    /// Makes the comparisons that are missing, in an order in which any beginning covers scenes and loads alike.
    ///
    /// # Errors
    /// If the harness fails, or a result cannot be written.
    pub fn run(&self, records: &mut Records) -> Result<()> {
        let framework = self.assignment.framework(self.workspace)?;
        let source = self.assignment.solution()?;
        let program = |source: &str| -> Result<SubmissionProgram> {
            compile(&framework, source, &Limits::default())?
                .map_err(|failure| Error::Harness(format!("a planted program does not compile: {failure:?}")))
        };
        let solution = program(&source)?;
        let rounds = self.comparisons.div_ceil(2 * SCENES.len() as u64);
        for seed in 1..=rounds {
            for scene in SCENES {
                for (load, seed) in [(0, 2 * seed), (self.load, 2 * seed + 1)] {
                    let record = Record::new(&framework.hash, None, scene, (load, self.seconds), seed);
                    self.compare(records, record, &solution, &solution)?;
                }
            }
        }
        for kind in PLANTED {
            let other = program(&planted(kind, &source)?)?;
            for seed in 1..=self.planted {
                let record =
                    Record::new(&framework.hash, Some(kind), PLANTED_SCENE, (0, 4.0 * self.seconds), seed);
                self.compare(records, record, &other, &solution)?;
            }
        }
        Ok(())
    }

    fn compare(
        &self,
        records: &mut Records,
        mut record: Record,
        program: &SubmissionProgram,
        solution: &SubmissionProgram,
    ) -> Result<()> {
        if records.has(&record) || self.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            return Ok(());
        }
        let named = |name: &str, role, program| MeasuredProgram { name: name.to_owned(), role, program };
        let programs = [named("first", Role::Submission, program), named("second", Role::Solution, solution)];
        let options = Options {
            scenes: vec![record.scene.clone()],
            techniques: vec![self.assignment.rubric.reference_technique],
            seconds: record.seconds,
            target: None,
            seed: record.seed,
            threads: 1,
            lengths: LENGTHS,
            bias: true,
        };
        let load = Load::start(record.load);
        let measured = measure(self.workspace, &programs, &options, |_| {});
        drop(load);
        let panel: Option<Panel> = measured?.panels.pop();
        record.panel = panel.filter(|panel| panel.curves.len() == programs.len());
        if record.panel.is_none() {
            return Err(Error::Harness(format!("a program failed in {}", record.scene)));
        }
        records.add(record)
    }
}
