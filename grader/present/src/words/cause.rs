//! Likely causes.

use verdict::check::{CheckKind, CheckResult, Evidence, Reason, Verdict};
use verdict::report::{Cause, Diagnosis, Report};
use verdict::rubric::EmissionOnHit;

use super::check::{explanation, observation};
use super::means;
use super::number::trimmed;

/// The line above what was seen and the hint, which are both empty if the cause is unknown.
pub fn heading(diagnosis: &Diagnosis) -> String {
    let title = title(&diagnosis.cause);
    match diagnosis.cause {
        Cause::Unknown { .. } => title,
        // It is measured, not concluded.
        Cause::FailedFact(_) => format!("Measured: {title}"),
        _ if diagnosis.confidence < 0.995 => {
            format!("Likely cause ({:.0} % sure): {title}", 100.0 * diagnosis.confidence)
        }
        _ => format!("Likely cause: {title}"),
    }
}

/// What is probably wrong.
pub fn title(cause: &Cause) -> String {
    let text = match cause {
        Cause::Known { title, .. } => title,
        Cause::FailedFact(fact) => return super::fact::fact(fact),
        Cause::Unknown { several_fit: true } => {
            "Cause unknown: the results fit several known mistakes. More checks may narrow it down."
        }
        Cause::Unknown { several_fit: false } => "Cause unknown: the results fit no known mistake.",
        Cause::NothingToCompile => "There is nothing to compile",
        Cause::DoesNotCompile => "The file does not compile",
        Cause::Panics => "The program panics",
        Cause::TodoLeft => "The program reaches code that is marked as not yet implemented",
        Cause::DoesNotFinish { .. } => "The program does not finish in time",
        Cause::ConstantFactor { factor, .. } => {
            return format!(
                "Each light sample is {} times as bright as it should be, whatever the scene",
                trimmed(*factor, 2)
            );
        }
        Cause::NotBegun { .. } => "Nothing has been filled in yet: this is the starting file",
        Cause::BsdfChanged => "With `bsdf`, the program is no longer plain BSDF sampling",
        Cause::TechniqueNotBegun { technique, name, .. } => {
            return format!(
                "`{technique}` has not been started: the file never checks for the technique `{name}`"
            );
        }
    };
    text.to_owned()
}

/// Something to think about; empty if the cause is unknown.
pub fn hint(cause: &Cause) -> &str {
    match cause {
        Cause::Known { hint, .. } => hint,
        Cause::Unknown { .. } | Cause::FailedFact(_) => "",
        Cause::NothingToCompile => {
            "Submit your source file by itself, or in a folder or an archive. `cargo grader pack` creates such an archive."
        }
        Cause::DoesNotCompile => {
            "Start with the first error; later ones often follow from it. `cargo arty` shows the same messages in a second. \
             Submit what compiles even if a task is missing: a file that does not compile earns no points."
        }
        Cause::Panics => {
            "The message names the kind of mistake: an index out of bounds, an integer division by zero, an `unwrap` of \
             `None`. Think of scenes without lights, of scenes with one light, and of random numbers just below 1. Run that \
             scene with `cargo arty` to see the line."
        }
        Cause::TodoLeft => {
            "The program panics there. Until a part is finished, let it do what the starting file does, so that the others \
             can be graded."
        }
        Cause::DoesNotFinish { .. } => {
            "Look for an endless loop, and for work per bounce that grows with the number of lights. A path has at most \
             `max_bounces` bounces, and samples one light at each."
        }
        Cause::ConstantFactor { .. } => {
            "A constant factor is missing, or is applied once too often. Write down the estimator for one point on one light \
             with all its factors, note where each comes from, and compare it with your product."
        }
        Cause::BsdfChanged => {
            "Figure 3 compares all three techniques, and `bsdf` is what the starting file did. Which of the contributions that \
             you have added, and which weights, must not apply to it?"
        }
        Cause::NotBegun { hint } | Cause::TechniqueNotBegun { hint, .. } => hint,
    }
}

/// The observation that speaks for a cause; empty if there is none, or the title says it.
pub fn seen(report: &Report, diagnosis: &Diagnosis) -> String {
    match &diagnosis.cause {
        Cause::Unknown { .. } | Cause::FailedFact(_) => String::new(),
        Cause::NothingToCompile => {
            let refusal = report.submission.refusal.as_ref();
            refusal.map_or_else(String::new, |it| format!("{}: {}", it.code, first_line(&it.message)))
        }
        Cause::DoesNotCompile => first_error(report),
        Cause::Panics | Cause::TodoLeft => match decisive(report, diagnosis, Reason::Crash) {
            Some(check) => format!("in {}, {}", check.id, explanation(check)),
            None => String::new(),
        },
        Cause::DoesNotFinish { late } => {
            let checks = super::count(*late, "check");
            match decisive(report, diagnosis, Reason::Timeout) {
                Some(check) => format!("{checks} did not finish in time, {} among them", check.id),
                None => format!("{checks} did not finish in time"),
            }
        }
        Cause::ConstantFactor { scenes, .. } if scenes.is_empty() => {
            "direct light is off by this factor in all scenes".to_owned()
        }
        Cause::ConstantFactor { scenes, .. } => {
            format!("direct light is off by this factor in {}", super::number::list(scenes))
        }
        Cause::NotBegun { .. } => "all blocks marked TASK … END are unchanged".to_owned(),
        Cause::TechniqueNotBegun { name, .. } => {
            format!("the weights ignore the densities, and no line of the file mentions `{name}`")
        }
        Cause::BsdfChanged | Cause::Known { .. } => in_checks(report, diagnosis),
    }
}

/// The check that a cause names, or else the first that ended for this reason.
fn decisive<'a>(report: &'a Report, diagnosis: &Diagnosis, reason: Reason) -> Option<&'a CheckResult> {
    let named = diagnosis.seen.as_ref().and_then(|seen| report.check(&seen.wrong));
    named.or_else(|| report.checks.iter().find(|check| check.reason == reason))
}

fn first_error(report: &Report) -> String {
    let Some(failure) = &report.submission.build_failure else { return String::new() };
    let messages = &failure.messages;
    let first = messages.lines().find(|line| line.starts_with("error")).unwrap_or(first_line(messages));
    match failure.line {
        Some(line) => format!("{first} (line {line})"),
        None => first.to_owned(),
    }
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

fn in_checks(report: &Report, diagnosis: &Diagnosis) -> String {
    let Some(seen) = &diagnosis.seen else { return String::new() };
    let Some(wrong) = report.check(&seen.wrong) else { return String::new() };
    match seen.right.as_ref().and_then(|id| report.check(id)) {
        Some(right) => format!("{}; {}", what_is_wrong(wrong), what_is_right(right)),
        None => what_is_wrong(wrong),
    }
}

/// "direct light is 2.00 ± 0.01 times what it should be in area_plane (`nee`)".
fn what_is_wrong(check: &CheckResult) -> String {
    let (scene, technique) = (&check.id.scene, check.id.technique);
    let place = format!("in {scene} (`{technique}`)");
    match &check.evidence {
        Some(Evidence::WhiteFurnace(furnace)) if !furnace.energy.is_empty() && check.fault.is_none() => {
            format!("energy per bounce relative to exact {place}: {}", means::energy(furnace))
        }
        Some(Evidence::MeanBias(_) | Evidence::ClosedForm(_)) => {
            let is_bias = check.fault.is_none() && check.numerics.is_clean();
            match means::factor(check).filter(|_| is_bias && check.verdict == Verdict::Fail) {
                Some(factor) => format!("{factor} {place}"),
                None => format!("{place}, {}", observation(check)),
            }
        }
        _ => format!("{} (`{technique}`): {}", check.id.kind, observation(check)),
    }
}

fn what_is_right(check: &CheckResult) -> String {
    let (scene, technique) = (&check.id.scene, check.id.technique);
    let quantity = match check.id.kind {
        CheckKind::MisWeights => return format!("the MIS weights are correct (`{technique}`)"),
        CheckKind::Facts => return format!("every factor is correct (`{technique}`)"),
        CheckKind::LightPick => {
            return format!("each of the three lights contributes what it should (`{technique}`)");
        }
        CheckKind::RayBudget => return format!("no path traces too many rays (`{technique}`)"),
        CheckKind::PathLength => return format!("paths reach the maximum length (`{technique}`)"),
        CheckKind::Sampling => {
            return format!("directions of environments are sampled correctly (`{technique}`)");
        }
        CheckKind::Stability => return format!("extreme scenes are rendered correctly (`{technique}`)"),
        CheckKind::HiddenVariants => return format!("random scenes are rendered correctly (`{technique}`)"),
        CheckKind::Efficiency => "the variance",
        CheckKind::Randomness => "the use of random numbers",
        CheckKind::Metamorphic => "the image of the changed scene",
        CheckKind::ClosedForm | CheckKind::MeanBias | CheckKind::VariedScene | CheckKind::WhiteFurnace => {
            light(check)
        }
    };
    format!("{quantity} is correct in {scene} (`{technique}`)")
}

/// The light that a check looks at.
pub(super) fn light(check: &CheckResult) -> &'static str {
    match (check.id.max_bounces, check.id.emission_on_hit) {
        (1, EmissionOnHit::On) => "direct light",
        (1, EmissionOnHit::Off) => "direct light from light samples",
        (_, EmissionOnHit::On) => "the mean radiance",
        (_, EmissionOnHit::Off) => "the light from light samples",
    }
}
