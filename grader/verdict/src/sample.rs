//! Sample reports for the tests of all formats.

use arty::integrator::Technique;

use crate::check::{
    BounceEnergy, CheckId, CheckKind, CheckResult, Deviation, Effect, Evidence, Fault, FurnaceTest, MeanTest,
    NumericalCause, Numerics, Place, Reason, RegionId, RegionKind, SkipReason, StabilityFinding,
    StabilityTest, Verdict, Visibility, WhyNot,
};
use crate::pictures::Picture;
use crate::report::{
    Cause, Cost, Diagnosis, Points, Provenance, Report, SCHEMA, Sandbox, SeenIn, SkippedCheck,
    SubmissionInfo, TaskResult, TaskState,
};
use crate::rubric::{EmissionOnHit, SCRIPTED};
use crate::sandbox::Layers;
use crate::submission::SourceFinding;

/// Text with markup, commands and escape sequences, as an attacker might write it.
pub const EVIL: &str = "<script>alert(1)</script>\"'&|\n::error file=x::y\u{1b}[31m\u{7}\u{0}]]>```%0A,:![x](https://x.y) @z\u{fffe}";

/// A check with technique `nee` and eight bounces.
pub fn id(kind: CheckKind, scene: &str) -> CheckId {
    CheckId {
        kind,
        scene: scene.to_owned(),
        technique: Technique::Nee,
        max_bounces: 8,
        emission_on_hit: EmissionOnHit::On,
    }
}

/// A mean that is 12.5 % too dark.
pub fn mean_test() -> MeanTest {
    MeanTest {
        region: RegionId { kind: RegionKind::Weighted, pixels: None },
        effect: Some(-0.125),
        interval: Some([-0.13, -0.12]),
        detectable: Some(0.01),
        tolerance: 0.02,
        whole: Some(Effect { relative: -0.125, margin: 0.005 }),
        z: Vec::new(),
    }
}

/// A furnace in which light after one bounce has half of its energy.
pub fn furnace_test() -> FurnaceTest {
    let energy = |relative| BounceEnergy { relative, margin: Some(0.01) };
    FurnaceTest { test: mean_test(), max_bounces: 1, energy: vec![energy(1.0), energy(0.5)] }
}

/// A report with one failed task, one that a tutor grades, and `text` in every text field.
pub fn report(text: &str) -> Report {
    let text = || text.to_owned();
    let check = id(CheckKind::MeanBias, &text());
    let task = |id: &str, points: Option<f64>, max, state| TaskResult {
        id: id.to_owned(),
        title: text(),
        points,
        max,
        staff_only: 0.0,
        checks: if points.is_some() { vec![check.clone()] } else { Vec::new() },
        steps: Vec::new(),
        state,
    };
    Report {
        schema: SCHEMA.to_owned(),
        submission: SubmissionInfo {
            file_name: "main_file.rs".to_owned(),
            path: text(),
            hash: text(),
            build_failure: None,
            explanations: Vec::new(),
            refusal: None,
            notes: Vec::new(),
            prints: Vec::new(),
        },
        assignment: text(),
        points: Points {
            earned: 12.5,
            automatic_max: 70.0,
            manual_max: 10.0,
            max: 80.0,
            staff_only: 0.0,
            manual: None,
        },
        tasks: vec![
            task("5.1a", Some(12.5), 20.0, TaskState::Graded { missing: vec![check.clone()] }),
            task("5.2a", None, 10.0, TaskState::ByHand { comment: None }),
        ],
        checks: vec![CheckResult {
            id: check.clone(),
            task: "5.1a".to_owned(),
            required: true,
            visibility: Visibility::Public,
            verdict: Verdict::Fail,
            reason: Reason::Bias,
            fault: None,
            evidence: Some(Evidence::MeanBias(mean_test())),
            numerics: Numerics::default(),
            short_look: false,
            samples: 4096,
            seconds: 0.5,
        }],
        skipped: vec![SkippedCheck {
            kind: CheckKind::Efficiency,
            technique: Technique::Nee,
            scene: text(),
            check: None,
            why: WhyNot::OneTechnique,
        }],
        diagnosis: vec![Diagnosis {
            cause: Cause::Known { id: text(), title: text(), hint: text() },
            confidence: 0.5,
            seen: Some(SeenIn { wrong: check, right: None }),
        }],
        numerics: Numerics::default(),
        cost: Cost::default(),
        sandbox: Sandbox::new(
            Layers::default(),
            Layers::default(),
            vec![SourceFinding { line: 1, what: text(), why: text() }],
        ),
        provenance: Provenance {
            seed: Some(0),
            toolchain: text(),
            assignment: text(),
            ..Provenance::default()
        },
        audit: None,
        convergence: None,
        images: Vec::new(),
        hand_in: None,
    }
}

/// A report with [`EVIL`] in every text field, including a panic message and a remark.
pub fn evil_report() -> Report {
    let mut report = self::report(EVIL);
    report.checks[0].fault = Some(Fault::Panic(EVIL.to_owned()));
    report.checks.push(check_with_remark(EVIL));
    report
}

/// A check that passes with a remark about a scene of this name.
pub fn check_with_remark(scene: &str) -> CheckResult {
    let finding = StabilityFinding {
        place: Place::ExtremeScene(scene.to_owned()),
        deviation: Deviation::Anomalies { non_finite: 1, negative: 0 },
        likely_cause: NumericalCause::Limit,
        is_graded: false,
        first: None,
        replay: None,
    };
    CheckResult {
        id: id(CheckKind::Stability, SCRIPTED),
        verdict: Verdict::Pass,
        reason: Reason::None,
        evidence: Some(Evidence::Stability(StabilityTest { findings: vec![finding] })),
        ..report(scene).checks.remove(0)
    }
}

/// Staff-only texts in [`with_staff_only_checks`].
pub const STAFF_ONLY: [&str; 3] = ["hidden-variants", "cellar", "hidden/"];

/// A report that names a staff-only scene and a `hidden-variants` check in every field that can hold them.
pub fn with_staff_only_checks() -> Report {
    let mut report = self::report("open");
    let shown = report.checks[0].id.clone();
    let hidden: Vec<CheckId> = ["hidden-variants/scripted/nee/6", "mean-bias/hidden/cellar/nee/8"]
        .map(|id| id.parse().expect("it is the name of a check"))
        .into();
    for id in &hidden {
        let mut check = report.checks[0].clone();
        (check.visibility, check.id) = (id.visibility(), id.clone());
        report.checks.push(check);
    }
    report.checks[1].verdict = Verdict::Pass;
    report.checks[0].verdict = Verdict::Skipped { why: SkipReason::PointsLostTo(Some(hidden[1].clone())) };
    report.tasks[0].checks = [&[shown.clone()][..], &hidden].concat();
    report.tasks[0].state = TaskState::RequiredCheckMissing(Some(hidden[1].clone()));
    report.tasks[1].state = TaskState::Graded { missing: hidden.clone() };
    report.skipped.push(SkippedCheck { scene: "hidden/cellar".to_owned(), ..report.skipped[0].clone() });
    report.diagnosis.push(Diagnosis {
        cause: Cause::ConstantFactor {
            factor: 2.0,
            scenes: vec!["hidden/cellar".to_owned(), "a".to_owned()],
        },
        confidence: 0.9,
        seen: Some(SeenIn { wrong: shown, right: Some(hidden[1].clone()) }),
    });
    report
}

/// A picture of two pixels in a scene of this name.
pub fn picture(scene: &str) -> Picture {
    let reference = [[1.0; 3]; 2];
    let mut picture = Picture {
        scene: scene.to_owned(),
        max_bounces: 8,
        width: 2,
        height: 1,
        seeds: vec![u64::MAX, 7],
        samples: 8,
        reference: crate::pictures::half_bits(&reference),
        rendered: Vec::new(),
    };
    for technique in [Technique::Bsdf, Technique::Mis] {
        picture.add(technique, (&[[1.0, 2.0, 0.5]; 2], &reference), &[0.0, -3.0], &[0.0, 1.0]);
    }
    picture
}
