//! Causes that are seen without comparing anything.

use arty::integrator::Technique;

use super::Found;
use crate::checks::CONSTANT_WEIGHTS;
use crate::report::{CheckResult, Diagnosis, Reason, Report};
use crate::rubric::CheckKind;

const NEE: &str = "nee";
const MIS: &str = "mis";

/// Causes that are plain from the report and the source.
pub(super) fn causes(report: &Report, source: &str) -> Vec<Found> {
    if report.submission.build_failure.is_some() {
        return vec![not_compiled(report)];
    }
    let stopped = |reason: Reason| report.checks.iter().filter(move |check| check.reason == reason);
    let mut found = Vec::new();
    if let Some(panicked) = stopped(Reason::Crash).next() {
        // Where it does not panic, something else may be wrong.
        found.push(panic(panicked));
    }
    if 2 * stopped(Reason::Timeout).count() > report.checks.len() {
        found.push(late(report));
    }
    let untouched =
        Untouched { mis: Untouched::of(source).mis && weighs_nothing(report), ..Untouched::of(source) };
    if found.is_empty() && untouched.any() {
        found.push(not_begun(untouched));
    }
    found
}

fn cause(mistake: &str, title: &str, evidence: String, hint: &str, explains: &[&'static str]) -> Found {
    Found {
        diagnosis: Diagnosis {
            mistake: mistake.to_owned(),
            title: title.to_owned(),
            confidence: 1.0,
            evidence,
            hint: hint.to_owned(),
        },
        explains: Some(explains.to_vec()),
    }
}

fn not_compiled(report: &Report) -> Found {
    let failure = report.submission.build_failure.as_ref();
    let messages = failure.map_or("", |failure| failure.messages.as_str());
    if let Some(refusal) = &report.submission.refusal {
        let hint = "Hand in your render_pt.rs: by itself, or in a folder or an archive that has one. \
                    `cargo grader pack` makes such an archive.";
        let title = "There is nothing to compile";
        let evidence = format!("{}: {}", refusal.code, first_line(messages));
        return cause("nothing-to-compile", title, evidence, hint, &[NEE, MIS]);
    }
    let first = messages.lines().find(|line| line.starts_with("error")).unwrap_or(first_line(messages));
    let place = failure.and_then(|failure| failure.line).map(|line| format!(" (line {line})"));
    cause(
        "does-not-compile",
        "The file does not compile",
        format!("{first}{}", place.unwrap_or_default()),
        "Begin with the first error; later ones often follow from it. `cargo arty` shows the same messages in a second. \
         Hand in what compiles, even if a task is missing: a file that does not compile earns nothing.",
        &[NEE, MIS],
    )
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

fn panic(check: &CheckResult) -> Found {
    let words = check.explanation.as_str();
    let evidence = format!("in {}, {words}", check.id);
    // What the standard library says where a hand-in comes to a macro for code that is still to be written.
    if words.contains("not yet implemented") || words.contains("not implemented") {
        return cause(
            "todo-left",
            "A place that is marked as still to be done is reached",
            evidence,
            "The program stops where it comes to such a mark. While a technique is not done, let it do plain BSDF sampling, as \
             the starting file does: then the others can be judged.",
            &[],
        );
    }
    cause(
        "panics",
        "The program stops in the middle (a panic)",
        evidence,
        "The message names the kind of fault: an index beyond the end, a division by zero of whole numbers, an `unwrap` of \
         nothing. Think of scenes without lights, with a single one, and of random numbers just below 1. Run that scene with \
         `cargo arty` to see the line.",
        &[],
    )
}

fn late(report: &Report) -> Found {
    let late = report.checks.iter().filter(|check| check.reason == Reason::Timeout);
    let first = late.clone().next().map_or(String::new(), |check| format!(", the first in {}", check.id));
    cause(
        "does-not-finish",
        "The program does not finish in time",
        format!("{} of {} checks were not done in time{first}", late.count(), report.checks.len()),
        "Look for a loop that never ends, and for work that grows with the number of lights at every hit point. Each path may \
         scatter `max_bounces` times, and asks one light each time.",
        &[NEE, MIS],
    )
}

/// What can be said where no known mistake fits: that direct light is too bright or too dark by the same factor in all
/// scenes in which only light samples bring it.
pub(super) fn constant_factor(report: &Report) -> Option<Found> {
    let direct = report.checks.iter().filter(|check| {
        check.technique == Technique::Nee
            && check.max_bounces == 1
            && matches!(check.check, CheckKind::MeanBias | CheckKind::ClosedForm)
    });
    let mut factors: Vec<(f64, &str)> =
        direct.filter_map(|check| Some((1.0 + check.whole()?[0], check.scene.as_str()))).collect();
    factors.sort_by(|a, b| a.0.total_cmp(&b.0));
    let factor = factors.get(factors.len() / 2)?.0;
    factors.retain(|(other, _)| (other / factor - 1.0).abs() < ALIKE);
    let scenes: Vec<&str> = factors.iter().map(|(_, scene)| *scene).collect();
    let is_one = (factor - 1.0).abs() < 2.0 * ALIKE || factor < ALIKE;
    (scenes.len() >= ENOUGH && !is_one).then(|| {
        let mut found = cause(
            "constant-factor",
            &format!("Each light sample is {factor:.2} times as bright as it should be, whatever the scene"),
            format!("direct light is that much too bright or too dark in {}, all alike", scenes.join(", ")),
            "A constant is left out, or is there once too often. Write down the estimator for one point on one light with all \
             its factors, say of each where it comes from, and compare with your product.",
            &[],
        );
        found.diagnosis.confidence = 0.5;
        found
    })
}

/// Factors that differ by less are the same.
const ALIKE: f64 = 0.04;

/// Scenes that have to agree.
const ENOUGH: usize = 4;

/// True if the weights of `mis` were looked at, and are the same whatever the densities.
fn weighs_nothing(report: &Report) -> bool {
    let mut weights = report.checks.iter().filter(|check| check.check == CheckKind::MisWeights);
    weights.any(|check| CONSTANT_WEIGHTS.iter().all(|name| check.details.contains_key(*name)))
}

/// Which parts nobody has begun, by the marks of the starting file; nothing where there are no such marks.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Untouched {
    /// No line of code is in any of its blocks, but those of the starting file.
    everything: bool,
    /// The code never speaks of the technique `Mis`.
    mis: bool,
}

impl Untouched {
    fn of(source: &str) -> Self {
        let (mut blocks, mut written, mut within) = (0, 0, false);
        for line in source.lines().map(str::trim) {
            if line.starts_with("// TASK") {
                within = true;
                blocks += 1;
            } else if line.starts_with("// END") {
                within = false;
            } else if within && !line.is_empty() && !line.starts_with("//") && !GIVEN.contains(&line) {
                written += 1;
            }
        }
        let code = |line: &str| line.split("//").next().unwrap_or_default().contains("Mis");
        let everything = blocks > 0 && written == 0;
        Self { everything, mis: blocks > 0 && !everything && !source.lines().any(code) }
    }

    fn any(self) -> bool {
        self.everything || self.mis
    }
}

/// The code in the blocks of the starting file.
const GIVEN: [&str; 6] = [
    "last_bounce = Some(LastBounce {});",
    "let _ = (scene, hit, bsdf, sampler); // Delete this line once you use them.",
    "Rgb::BLACK",
    "let _ = (scene, hit, emission, last_bounce); // Delete this line once you use them.",
    "1.0",
    "struct LastBounce {}",
];

fn not_begun(untouched: Untouched) -> Found {
    if untouched.everything {
        return cause(
            "not-begun",
            "Nothing is filled in yet: this is the starting file",
            "all places that are marked TASK … END are as they were, and so every technique is plain BSDF sampling".to_owned(),
            "Begin with 5.1a: at each hit point, choose a random point on a random light, see whether anything is in between, \
             and add what it sends to the viewer. Try it in scenes/cornell_box_point.yml with `--technique=nee --max-bounces=1`: \
             a point light is never hit by chance, so that all you see there is yours.",
            &[NEE, MIS],
        );
    }
    cause(
        "mis-not-begun",
        "5.2b is not begun: nothing in the file asks whether the technique is `mis`",
        "the weights of the two techniques are the same whatever the densities, and no line asks for `Mis`"
            .to_owned(),
        "First let `nee` earn its points. Then write down, for one point on a light, the two densities with which it can be found, \
         both per solid angle; the weights follow from them.",
        &[MIS],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::report::sample::report;

    fn named(report: &Report, source: &str) -> Vec<String> {
        causes(report, source).into_iter().map(|found| found.diagnosis.mistake).collect()
    }

    #[test]
    fn what_stops_the_program_is_named() {
        let mut report = report("x");
        report.checks[0].reason = Reason::Crash;
        report.checks[0].explanation = "it panicked: not yet implemented: the weights".to_owned();
        assert_eq!(named(&report, ""), ["todo-left"]);
        report.checks[0].explanation = "it panicked: index out of bounds".to_owned();
        assert_eq!(named(&report, ""), ["panics"]);
        report.checks[0].reason = Reason::Timeout;
        assert_eq!(named(&report, ""), ["does-not-finish"]);
        report.checks[0].reason = Reason::Bias;
        assert!(named(&report, "").is_empty());
        assert_eq!(named(&report, BLOCK), ["not-begun"]);
    }

    #[test]
    fn the_first_error_of_the_compiler_is_quoted() {
        let mut report = report("x");
        let messages = "warning: w\nerror[E0425]: cannot find value `x`\nerror: other\n".to_owned();
        report.submission.build_failure = Some(crate::build::BuildFailure { messages, line: Some(7) });
        let found = causes(&report, BLOCK);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].diagnosis.evidence, "error[E0425]: cannot find value `x` (line 7)");
        assert!(found[0].is_everything());
    }

    const BLOCK: &str = "// TASK 5.1a\n    Rgb::BLACK\n// what to do\n// END 5.1a\n";

    #[test]
    fn only_blocks_without_code_of_ones_own_are_untouched() {
        let everything = Untouched { everything: true, mis: false };
        let mis = Untouched { everything: false, mis: true };
        let nothing = Untouched { everything: false, mis: false };
        for (source, expected) in [
            (BLOCK.to_owned(), everything),
            (format!("{BLOCK}// TASK 5.2\nTechnique::Nee; // not Mis\n// END\n"), mis),
            (format!("{BLOCK}// TASK 5.2\nmatch t {{ Mis => 1.0 }}\n// END\n"), nothing),
            ("fn without_marks() {}".to_owned(), nothing),
        ] {
            assert_eq!(Untouched::of(&source), expected, "{source}");
        }
    }
}
