//! Commands that repeat a check, or follow one of its paths.

use std::path::Path;

use verdict::check::{CheckId, CheckResult, Evidence};
use verdict::replay::ReplayTarget;
use verdict::report::Report;
use verdict::rubric::EmissionOnHit;
use verdict::text::quote;

/// The command that repeats a check of a report.
pub fn repeat_command(report: &Report, check: &CheckId) -> String {
    let [path, assignment] =
        [&report.submission.path, &report.provenance.assignment].map(|text| quote(Path::new(text)));
    let check = quote(Path::new(&check.to_string()));
    let assignment = if assignment.is_empty() { assignment } else { format!(" --assignment={assignment}") };
    let seed = report.provenance.seed.map_or_else(String::new, |seed| format!(" --seed={seed}"));
    format!("cargo grade {path}{assignment}{seed} --only={check}")
}

/// The command that follows a path of a submission, whose path is given unquoted.
pub fn replay_command(target: &ReplayTarget, submission: &str) -> String {
    let ReplayTarget {
        scene,
        scale,
        emission,
        technique,
        max_bounces,
        emission_on_hit,
        size,
        seed,
        pixel,
        sample,
    } = target;
    let ([width, height], [x, y]) = (size, pixel);
    let [path, scene] = [submission, scene].map(|text| quote(Path::new(text)));
    let mut command = format!(
        "cargo grader replay {path} --scene={scene} --pixel={x},{y} --sample={sample} --technique={technique} \
         --max-bounces={max_bounces} --seed={seed} --size={width}x{height}"
    );
    if *emission_on_hit == EmissionOnHit::Off {
        command += " --emission-on-hit=off";
    }
    if *scale != 1.0 {
        command += &format!(" --scale={scale}");
    }
    if *emission != 1.0 {
        command += &format!(" --emission={emission}");
    }
    command
}

/// The command that follows the path that decided a check, where there is one.
pub fn replay_of(check: &CheckResult, submission: &str) -> Option<String> {
    let target = match &check.evidence {
        Some(Evidence::Stability(test)) => {
            test.findings.iter().find(|finding| finding.is_graded).and_then(replay_of_finding)
        }
        _ => check.numerics.first.as_ref().and_then(|first| first.replay.as_ref()),
    };
    target.map(|target| replay_command(target, submission))
}

/// The path that shows a finding at the ends of single precision.
pub(super) fn replay_of_finding(finding: &verdict::check::StabilityFinding) -> Option<&ReplayTarget> {
    finding.first.as_ref().and_then(|first| first.replay.as_ref()).or(finding.replay.as_ref())
}
