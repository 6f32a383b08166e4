//! Causes that are found without comparing signatures.

use arty::integrator::Technique;
use verdict::check::{CheckKind, CheckResult, Evidence, Fault, Reason, Verdict, WeightForm};
use verdict::report::{Cause, Diagnosis, Report, SeenIn};
use verdict::rubric::NotBegun;

use super::ExplainedCause;

/// What an assignment says about its techniques.
#[derive(Clone, Debug, Default)]
pub(super) struct Techniques {
    /// Those that students write.
    pub(super) graded: Vec<Technique>,
    /// How to recognise those that are not begun.
    pub(super) not_begun: Vec<NotBegun>,
    /// Hint for a student who has not begun, from the rubric.
    pub(super) begin: String,
}

/// Causes that are evident from the report and the source.
pub(super) fn causes(
    techniques: &Techniques,
    report: &Report,
    source: &str,
    starter: &str,
) -> Vec<ExplainedCause> {
    let Techniques { graded: all_techniques, not_begun, begin } = techniques;
    if report.submission.build_failure.is_some() {
        let refused = report.submission.refusal.is_some();
        let cause = if refused { Cause::NothingToCompile } else { Cause::DoesNotCompile };
        return vec![found(cause, None, all_techniques)];
    }
    let stopped = |reason: Reason| report.checks.iter().filter(move |check| check.reason == reason);
    let mut all = Vec::new();
    if let Some(crashed) = stopped(Reason::Crash).next() {
        // A panic explains no technique: another mistake may be present.
        let cause = if is_todo(crashed) { Cause::TodoLeft } else { Cause::Panics };
        all.push(found(cause, Some(crashed), &[]));
    }
    let late = stopped(Reason::Timeout).count();
    if 2 * late > report.checks.len() {
        all.push(found(Cause::DoesNotFinish { late }, stopped(Reason::Timeout).next(), all_techniques));
    }
    if !all.is_empty() {
        return all;
    }
    match begun(source, starter) {
        Some(false) => all.push(found(Cause::NotBegun { hint: begin.clone() }, None, all_techniques)),
        Some(true) if has_constant_weights(report) => {
            let unnamed = not_begun.iter().filter(|technique| !names(source, &technique.name));
            all.extend(unnamed.map(|NotBegun { technique, name, hint }| {
                let (name, hint) = (name.clone(), hint.clone());
                found(Cause::TechniqueNotBegun { technique: *technique, name, hint }, None, &[*technique])
            }));
        }
        _ => {}
    }
    all
}

fn found(cause: Cause, seen: Option<&CheckResult>, explains: &[Technique]) -> ExplainedCause {
    let seen = seen.map(|check| SeenIn { wrong: check.id.clone(), right: None });
    ExplainedCause { diagnosis: Diagnosis { cause, confidence: 1.0, seen }, explains: explains.to_vec() }
}

/// True if the panic comes from `todo!` or `unimplemented!`, which only its message shows.
fn is_todo(check: &CheckResult) -> bool {
    let Some(Fault::Panic(message)) = &check.fault else { return false };
    ["not yet implemented", "not implemented"].iter().any(|beginning| message.starts_with(beginning))
}

/// The cause of a check that fails with the technique `bsdf`, where students do not write it: the starting file passes.
pub(super) fn bsdf_changed(report: &Report, student_techniques: &[Technique]) -> Option<ExplainedCause> {
    if student_techniques.contains(&Technique::Bsdf) {
        return None;
    }
    let is_wrong = |check: &&CheckResult| {
        let says_why = matches!(check.reason, Reason::Crash | Reason::Timeout);
        check.id.technique == Technique::Bsdf && check.verdict == Verdict::Fail && !says_why
    };
    let check = report.checks.iter().find(is_wrong)?;
    Some(found(Cause::BsdfChanged, Some(check), &[Technique::Bsdf]))
}

/// A cause for submissions that no known mistake fits: direct light is wrong by the same factor in all scenes in which
/// only light samples find it.
pub(super) fn constant_factor(report: &Report) -> Option<ExplainedCause> {
    let direct = report.checks.iter().filter(|check| {
        check.id.technique == Technique::Nee
            && check.id.max_bounces == 1
            && matches!(check.id.kind, CheckKind::MeanBias | CheckKind::ClosedForm)
    });
    let factor = |check: &CheckResult| Some(1.0 + check.mean_test()?.whole?.relative);
    let mut factors: Vec<(f64, &CheckResult)> =
        direct.filter_map(|check| Some((factor(check)?, check))).collect();
    factors.sort_by(|a, b| a.0.total_cmp(&b.0));
    let factor = factors.get(factors.len() / 2)?.0;
    factors.retain(|(other, _)| (other / factor - 1.0).abs() < SAME_FACTOR);
    let is_one = (factor - 1.0).abs() < 2.0 * SAME_FACTOR || factor < SAME_FACTOR;
    (factors.len() >= MIN_SCENES && !is_one).then(|| {
        let scenes = factors.iter().map(|(_, check)| check.id.scene.clone()).collect();
        let mut found = found(Cause::ConstantFactor { factor, scenes }, None, &[]);
        found.diagnosis.confidence = 0.5;
        found
    })
}

/// Relative difference below which two factors count as equal.
const SAME_FACTOR: f64 = 0.04;

/// Minimum number of scenes with the same factor.
const MIN_SCENES: usize = 4;

/// True if the weights of `mis` were measured and are constant.
fn has_constant_weights(report: &Report) -> bool {
    let is_constant = |form: WeightForm| matches!(form, WeightForm::Constant(_));
    report.checks.iter().any(|check| match &check.evidence {
        Some(Evidence::MisWeights(test)) => {
            test.measured.as_ref().is_some_and(|it| is_constant(it.light) && is_constant(it.bsdf))
        }
        _ => false,
    })
}

/// True if the task blocks hold code beyond that of the starting file's blocks; `None` if either has no task blocks.
fn begun(source: &str, starter: &str) -> Option<bool> {
    let (written, given) = (code_in_blocks(source)?, code_in_blocks(starter)?);
    Some(written.iter().any(|line| !given.contains(line)))
}

/// True if a source names this outside of comments.
fn names(source: &str, name: &str) -> bool {
    source.lines().any(|line| line.split("//").next().unwrap_or_default().contains(name))
}

/// The lines of code between `// TASK` and `// END`, without indentation; `None` if there is no such block.
fn code_in_blocks(source: &str) -> Option<Vec<&str>> {
    let (mut code, mut has_block, mut is_inside) = (Vec::new(), false, false);
    for line in source.lines().map(str::trim) {
        if line.starts_with("// TASK") {
            (has_block, is_inside) = (true, true);
        } else if line.starts_with("// END") {
            is_inside = false;
        } else if is_inside && !line.is_empty() && !line.starts_with("//") {
            code.push(line);
        }
    }
    has_block.then_some(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    use verdict::sample::report;

    fn named(report: &Report, source: &str) -> Vec<String> {
        let techniques = Techniques { graded: vec![Technique::Nee, Technique::Mis], ..Techniques::default() };
        causes(&techniques, report, source, BLOCK)
            .into_iter()
            .map(|found| found.diagnosis.cause.id().to_owned())
            .collect()
    }

    #[test]
    fn panics_and_timeouts_are_causes() {
        let mut report = report("x");
        report.checks[0].reason = Reason::Crash;
        report.checks[0].fault = Some(Fault::Panic("not yet implemented: the weights (a.rs:1)".to_owned()));
        assert_eq!(named(&report, ""), ["todo-left"]);
        report.checks[0].fault = Some(Fault::Panic("index out of bounds".to_owned()));
        assert_eq!(named(&report, ""), ["panics"]);
        report.checks[0].reason = Reason::Timeout;
        assert_eq!(named(&report, ""), ["does-not-finish"]);
        report.checks[0].reason = Reason::Bias;
        assert!(named(&report, "").is_empty());
        assert_eq!(named(&report, BLOCK), ["not-begun"]);
    }

    #[test]
    fn plain_bsdf_sampling_that_fails_was_changed() {
        let mut report = report("x");
        report.checks[0].verdict = Verdict::Fail;
        assert!(bsdf_changed(&report, &[Technique::Nee]).is_none(), "it is another technique");
        report.checks[0].id.technique = Technique::Bsdf;
        let cause = bsdf_changed(&report, &[Technique::Nee]).expect("it was changed");
        assert!(cause.explains(Technique::Bsdf) && !cause.explains(Technique::Nee));
        report.checks[0].reason = Reason::Timeout;
        assert!(bsdf_changed(&report, &[Technique::Nee]).is_none(), "it was not finished");
        report.checks[0].reason = Reason::Bias;
        assert!(bsdf_changed(&report, &[Technique::Bsdf]).is_none(), "it is what students write");
    }

    #[test]
    fn a_file_that_does_not_compile_has_no_other_cause() {
        let mut report = report("x");
        let messages = "error[E0425]: cannot find value `x`".to_owned();
        let techniques = Techniques { graded: vec![Technique::Nee, Technique::Mis], ..Techniques::default() };
        report.submission.build_failure = Some(verdict::submission::BuildFailure { messages, line: Some(7) });
        let found = causes(&techniques, &report, BLOCK, BLOCK);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].diagnosis.cause, Cause::DoesNotCompile);
        assert!(techniques.graded.iter().all(|&technique| found[0].explains(technique)));
    }

    const BLOCK: &str = "// TASK 5.1a\n    Rgb::BLACK\n// what to do\n// END 5.1a\n";

    #[test]
    fn blocks_with_the_starters_code_only_are_not_begun() {
        for (source, is_begun, names_mis) in [
            (BLOCK.to_owned(), Some(false), false),
            (format!("{BLOCK}// TASK 5.2\nTechnique::Nee; // not Mis\n// END\n"), Some(true), false),
            (format!("{BLOCK}// TASK 5.2\nmatch t {{ Mis => 1.0 }}\n// END\n"), Some(true), true),
            ("fn without_marks() {}".to_owned(), None, false),
        ] {
            assert_eq!(begun(&source, BLOCK), is_begun, "{source}");
            assert_eq!(begun(&source, ""), None, "without a starting file: {source}");
            assert_eq!(names(&source, "Mis"), names_mis, "{source}");
        }
    }
}
