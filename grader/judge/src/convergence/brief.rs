//! The short measurement that is part of every grade.

use super::measure::{MeasuredProgram, Options, measure};
use harness::build::SubmissionProgram;
use harness::workspace::Workspace;
use verdict::convergence::{Convergence, NotMeasured, Role};
use verdict::error::Result;
use verdict::rubric::Rubric;

/// The two scenes in which the techniques differ most in a short run.
const SCENES: [&str; 2] = ["cornell_box", "veach_mis"];

/// Processor time budget of all renderings, in seconds.
const SECONDS: f64 = 1.8;

/// Measures the reference technique of a submission beside that of the solution and the baseline, in about two seconds. Without the
/// solution, only the submission's own BSDF sampling is compared.
///
/// # Errors
/// If the grader itself fails.
pub fn brief(
    workspace: &Workspace,
    rubric: &Rubric,
    submission: &SubmissionProgram,
    solution: Option<&SubmissionProgram>,
    seed: u64,
) -> Result<Convergence> {
    let named = |name: &str, role, program| MeasuredProgram { name: name.to_owned(), role, program };
    let mut programs = vec![named("submission", Role::Submission, submission)];
    programs.extend(solution.map(|program| named("solution", Role::Solution, program)));
    if rubric.baseline().is_some() {
        programs.push(named("BSDF sampling", Role::Baseline, solution.unwrap_or(submission)));
    }
    let options = Options {
        scenes: SCENES.map(str::to_owned).to_vec(),
        techniques: vec![rubric.reference_technique],
        seconds: SECONDS,
        target: None,
        seed,
        threads: 1,
        lengths: 4,
        // The checks have tested it.
        bias: false,
    };
    let mut convergence = measure(workspace, &programs, &options, |_| {})?;
    if solution.is_none() {
        convergence.left_out.insert(
            0,
            NotMeasured {
                program: "solution".to_owned(),
                scene: String::new(),
                why: "this checkout does not have the solution".to_owned(),
            },
        );
    }
    Ok(convergence)
}
