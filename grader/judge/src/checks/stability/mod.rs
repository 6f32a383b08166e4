//! **stability**: is the submission numerically robust near the limits of single precision?
//!
//! Three properties are tested. [`laws`]: scaling or brightening a scene must give the same picture up to a factor.
//! With the same random numbers and powers of two as factors, a correct path tracer reproduces it to the last bit, so
//! that noise hardly matters. [`pictures`]: scenes with a known mean that are difficult in floating-point arithmetic.
//! [`densities`]: MIS weights for densities near the limits of single precision.
//!
//! A wide range is graded: scales and brightnesses of 1/1000 to 1000 and densities of 1e-12 to 1e12. Failures outside
//! of this range are reported as remarks.

mod densities;
mod laws;
mod pictures;

use arty::integrator::{Settings, Technique};
use harness::host_process::HostProcess;
use verdict::check::{
    CheckKind, Deviation, Evidence, NumericalCause, Numerics, Reason, StabilityFinding, StabilityTest,
};
use verdict::replay::ReplayTarget;
use verdict::rubric::CheckSpec;

use super::context::{anomaly, replay_of, settings_of};
use super::{Check, CheckOutcome, GradeContext, JobError, Observation};

/// The context that the three parts share.
struct StabilityContext<'a> {
    context: &'a GradeContext<'a>,
    spec: &'a CheckSpec,
    settings: Settings,
    seed: u64,
}

/// Findings of a part, and the number of paths traced.
type PartResult = Result<(Vec<StabilityFinding>, u64), JobError>;

pub(super) struct Stability;

impl Check for Stability {
    fn kind(&self) -> CheckKind {
        CheckKind::Stability
    }

    fn techniques(&self) -> &'static [Technique] {
        &[Technique::Nee, Technique::Mis]
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let stability =
            StabilityContext { context, spec, settings: settings_of(spec), seed: context.seed_of(spec) };
        let mut process = context.start()?;
        type Part = fn(&StabilityContext<'_>, &mut HostProcess) -> PartResult;
        let mut parts: Vec<Part> = vec![laws::find, pictures::find];
        if spec.technique == Technique::Mis {
            parts.push(densities::find);
        }
        let (mut findings, mut samples) = (Vec::new(), 0);
        for part in parts {
            let (found, paths) = part(&stability, &mut process)?;
            findings.extend(found);
            samples += paths;
        }
        Ok(conclude(findings, samples))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::Stability(test) = evidence else { return Vec::new() };
        let says_where = |finding: &&StabilityFinding| {
            finding.is_graded && !matches!(finding.deviation, Deviation::Panic { .. })
        };
        let graded = test.findings.iter().filter(says_where);
        let mut all: Vec<Observation> = Vec::new();
        for observation in graded.map(|finding| Observation::wrong_at((&finding.place).into())) {
            if !all.contains(&observation) {
                all.push(observation);
            }
        }
        all
    }
}

fn conclude(findings: Vec<StabilityFinding>, samples: u64) -> CheckOutcome {
    let (graded, remarks): (Vec<StabilityFinding>, Vec<StabilityFinding>) =
        findings.into_iter().partition(|finding| finding.is_graded);
    let sum = |which: usize| graded.iter().map(|finding| finding.deviation.anomalies()[which]).sum();
    let numerics = Numerics { non_finite: sum(0), negative: sum(1), first: None };
    let is_panic = |finding: &StabilityFinding| matches!(finding.deviation, Deviation::Panic { .. });
    let reason = match graded.as_slice() {
        [] => Reason::None,
        findings if findings.iter().all(is_panic) => Reason::Crash,
        _ => Reason::Bias,
    };
    let findings = graded.into_iter().chain(remarks).collect();
    CheckOutcome::new(reason, Evidence::Stability(StabilityTest { findings }), samples).with(numerics)
}

/// True for values that a correct estimator may return: finite and not negative.
fn is_radiance(value: f32) -> bool {
    value.is_finite() && value >= 0.0
}

/// The most frequent cause of a value that is not radiance.
fn cause_of(value: f32) -> NumericalCause {
    if value.is_nan() {
        NumericalCause::InvalidOperation
    } else if value.is_infinite() {
        NumericalCause::DivisionByZeroOrOverflow
    } else {
        NumericalCause::SignOfCosine
    }
}

impl StabilityContext<'_> {
    /// Replay target of a path in the scene with this name.
    fn replay(&self, scene: &str, settings: Settings, size: [u32; 2]) -> ReplayTarget {
        let Settings { technique, max_bounces } = settings;
        let scene = scene.to_owned();
        ReplayTarget { scene, technique, max_bounces, size, seed: self.seed, ..replay_of(self.spec) }
    }
}

#[cfg(test)]
mod tests {
    use verdict::check::{Place, Verdict};

    use super::*;

    #[test]
    fn graded_findings_cost_points_and_remarks_do_not() {
        let finding = |is_graded, [non_finite, negative]: [u64; 2]| StabilityFinding {
            place: Place::Unchanged,
            deviation: Deviation::Anomalies { non_finite, negative },
            likely_cause: NumericalCause::InvalidOperation,
            is_graded,
            first: None,
            replay: None,
        };
        let outcome = conclude(vec![finding(false, [3, 0])], 1);
        assert_eq!((outcome.verdict, outcome.numerics.non_finite), (Verdict::Pass, 0));
        let outcome = conclude(vec![finding(false, [0, 0]), finding(true, [0, 0])], 1);
        assert_eq!((outcome.verdict, outcome.reason), (Verdict::Fail, Reason::Bias));
        let outcome = conclude(vec![finding(true, [1, 2])], 1);
        let numerics = &outcome.numerics;
        assert_eq!((outcome.reason, numerics.non_finite, numerics.negative), (Reason::Numerics, 1, 2));
        // A panic in one scene hides nothing that was found in others, and looks like none of them.
        let panic = StabilityFinding {
            deviation: Deviation::Panic { message: "index out of bounds".to_owned() },
            ..finding(true, [0, 0])
        };
        let alone = conclude(vec![panic.clone()], 1);
        assert_eq!((alone.verdict, alone.reason), (Verdict::Fail, Reason::Crash));
        assert!(Stability.observations(&alone.evidence).is_empty());
        let both = conclude(vec![panic, finding(true, [0, 0])], 1);
        assert_eq!((both.reason, Stability.observations(&both.evidence).len()), (Reason::Bias, 1));
    }
}
