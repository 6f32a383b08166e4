//! A report for the tests of all formats.

use std::collections::BTreeMap;

use arty::integrator::Technique;

use crate::pictures::Picture;
use crate::report::{
    CheckResult, Cost, Diagnosis, LeftOut, Numerics, Points, Reason, Report, SCHEMA, Sandbox, SubmissionInfo,
    TaskResult, Verdict,
};
use crate::rubric::CheckKind;
use crate::sandbox::Layers;
use crate::submission::SourceFinding;

/// What someone might put anywhere that they can.
pub const EVIL: &str = "<script>alert(1)</script>\"'&|\n::error file=x::y\u{1b}[31m\u{7}\u{0}]]>```%0A,:![x](https://x.y) @z\u{fffe}";

/// A report with one task that failed, one that a person marks, and a text wherever one can stand.
pub fn report(text: &str) -> Report {
    let text = || text.to_owned();
    let task = |id: &str, points: Option<f64>, max| TaskResult {
        id: id.to_owned(),
        title: text(),
        points,
        max,
        elsewhere: 0.0,
        checks: if points.is_some() { vec![text()] } else { Vec::new() },
        reason: text(),
    };
    Report {
        schema: SCHEMA.to_owned(),
        submission: SubmissionInfo {
            path: text(),
            hash: text(),
            build_failure: None,
            explanations: Vec::new(),
            refusal: None,
            notes: Vec::new(),
        },
        assignment: text(),
        points: Points {
            earned: 12.5,
            automatic_max: 70.0,
            manual_max: 10.0,
            max: 80.0,
            elsewhere: 0.0,
            marked: None,
        },
        tasks: vec![task("5.1a", Some(12.5), 20.0), task("5.2a", None, 10.0)],
        checks: vec![CheckResult {
            id: text(),
            check: CheckKind::MeanBias,
            scene: text(),
            task: "5.1a".to_owned(),
            technique: Technique::Nee,
            max_bounces: 8,
            evidence: true,
            verdict: Verdict::Fail,
            reason: Reason::Bias,
            explanation: text(),
            effect: Some(-0.125),
            interval: Some([-0.13, -0.12]),
            detectable: Some(0.01),
            samples: 4096,
            seconds: 0.5,
            non_finite: 0,
            negative: 0,
            weights: None,
            coefficients: vec![1.0, 0.5],
            coefficient_margins: vec![0.01, 0.02],
            variance_ratios: Vec::new(),
            details: BTreeMap::new(),
            remarks: vec![text()],
            z: Vec::new(),
            repeat: text(),
        }],
        left_out: vec![LeftOut { check: text(), scene: text(), why: text() }],
        diagnosis: vec![Diagnosis {
            mistake: text(),
            title: text(),
            confidence: 0.5,
            evidence: text(),
            hint: text(),
        }],
        numerics: Numerics::default(),
        cost: Cost::default(),
        sandbox: Sandbox::new(
            Layers::default(),
            Layers::default(),
            vec![SourceFinding { reason: Reason::Violation, line: 1, what: text(), why: text() }],
        ),
        provenance: BTreeMap::from([(text(), text())]),
        convergence: None,
        images: Vec::new(),
    }
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
