use std::collections::BTreeMap;

use arty::integrator::Technique;

use super::*;
use crate::report::{Cost, LeftOut, Numerics, Points, Reason, SCHEMA, Sandbox, SubmissionInfo};
use crate::rubric::CheckKind;
use crate::sandbox::Layers;
use crate::scan::Finding;

/// What someone might put anywhere that they can.
const EVIL: &str = "<script>alert(1)</script>\"'&";

fn report() -> Report {
    let text = || EVIL.to_owned();
    Report {
        schema: SCHEMA.to_owned(),
        submission: SubmissionInfo {
            path: text(),
            hash: text(),
            build_failure: Some(crate::build::BuildFailure { messages: text(), line: None }),
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
            marked: Some(7.0),
            elsewhere: 0.0,
        },
        tasks: vec![TaskResult {
            id: "5.1a".to_owned(),
            title: text(),
            points: Some(12.5),
            max: 20.0,
            elsewhere: 0.0,
            checks: Vec::new(),
            reason: text(),
        }],
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
            variance_ratios: Vec::new(),
            remarks: vec![text()],
            z: Vec::new(),
            repeat: text(),
        }],
        left_out: vec![LeftOut { check: text(), scene: text(), why: text() }],
        diagnosis: Vec::new(),
        numerics: Numerics::default(),
        cost: Cost::default(),
        sandbox: Sandbox::new(
            Layers::default(),
            Layers::default(),
            vec![Finding { reason: Reason::Violation, line: 1, what: text(), why: text() }],
        ),
        provenance: BTreeMap::from([(text(), text())]),
        convergence: None,
        images: Vec::new(),
    }
}

fn picture() -> Picture {
    Picture {
        scene: EVIL.to_owned(),
        technique: Technique::Mis,
        max_bounces: 8,
        width: 2,
        height: 1,
        samples: 16,
        submission: vec![[1.0, 2.0, 0.5]; 2],
        reference: vec![[1.0; 3]; 2],
        z: vec![0.0, -3.0],
        flip: vec![0.0, 1.0],
    }
}

#[test]
fn nothing_that_a_hand_in_says_is_markup() {
    let text = page(&report(), &[picture()]);
    assert!(!text.contains("<script>alert") && text.contains("&lt;script&gt;alert(1)"), "escaped");
    assert!(!text.contains("\"'&\"") && !text.contains("href=") && !text.contains("src="));
}

#[test]
fn the_page_says_points_effects_and_the_command_that_repeats() {
    let text = page(&report(), &[]);
    for expected in ["12.5 of 70 points", "12.5 / 20", "-12.50 %", "4096", "Content-Security-Policy", "FAIL"]
    {
        assert!(text.contains(expected), "{expected}");
    }
}

#[test]
fn pixels_are_half_floats() {
    // 1.0, 2.0, 0.5 are 0x3c00, 0x4000, 0x3800.
    assert!(page(&report(), &[picture()]).contains(">ADwAQAA4ADwAQAA4<"));
}
