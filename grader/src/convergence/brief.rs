//! The short version that is part of every grade.

use arty::integrator::Technique;

use super::measure::{Contestant, Options, measure};
use super::{Convergence, Role};
use crate::build::{Framework, compile};
use crate::error::Result;
use crate::report::LeftOut;
use crate::submission::Submission;
use crate::workspace::Workspace;

/// The two scenes in which the techniques differ most in a short time.
const SCENES: [&str; 2] = ["cornell_box", "veach_mis"];

/// Processor time of all renderings, in seconds.
const SECONDS: f64 = 1.8;

/// Measures `mis` of a hand-in beside that of the solution and plain BSDF sampling, in about two seconds. In a checkout
/// without the solution the hand-in's own BSDF sampling is all that there is to compare with.
///
/// # Errors
/// What is not the hand-in's doing.
pub fn brief(workspace: &Workspace, submission: &Submission, seed: u64) -> Result<Convergence> {
    let mut left_out = Vec::new();
    let mut leave_out = |why: &str| {
        left_out.push(LeftOut { check: "convergence".to_owned(), scene: String::new(), why: why.to_owned() });
    };
    let framework = Framework::build(workspace)?;
    let has_solution = workspace.solution_file().is_file();
    let (hand_in, solution) = rayon::join(
        || compile(&framework, &submission.source),
        || -> Result<_> {
            if !has_solution {
                return Ok(None);
            }
            let solution = Submission::read(&workspace.solution_file())?;
            Ok(compile(&framework, &solution.source)?.ok())
        },
    );
    let (hand_in, solution) = (hand_in?, solution?);
    let Ok(hand_in) = hand_in else {
        leave_out("the hand-in does not compile");
        return Ok(Convergence { left_out, ..Convergence::default() });
    };
    if solution.is_none() {
        leave_out("there is no solution in this checkout to compare with");
    }
    let contestant = |name: &str, role, program| Contestant { name: name.to_owned(), role, program };
    let mut contestants = vec![contestant("hand-in", Role::Submission, &hand_in)];
    contestants.extend(solution.as_ref().map(|program| contestant("solution", Role::Solution, program)));
    let baseline = solution.as_ref().unwrap_or(&hand_in);
    contestants.push(contestant("BSDF sampling", Role::Baseline, baseline));
    let options = Options {
        scenes: SCENES.map(str::to_owned).to_vec(),
        techniques: vec![Technique::Mis],
        seconds: SECONDS,
        target: None,
        seed,
        threads: 1,
        lengths: 5,
    };
    let mut convergence = measure(workspace, &contestants, &options, |_| {})?;
    convergence.left_out.splice(0..0, left_out);
    Ok(convergence)
}
