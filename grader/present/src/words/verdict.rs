//! Verdicts.

use verdict::check::Verdict;

/// The word for a verdict.
pub fn verdict(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
        Verdict::Inconclusive => "inconclusive",
        Verdict::Skipped { .. } => "skipped",
        Verdict::NotRun { .. } => "not run",
    }
}
