use arty::integrator::Technique;

use super::*;
use crate::report::sample::{EVIL, report};

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
    let text = page(&report(EVIL), &[picture()]);
    assert!(!text.contains("<script>alert") && text.contains("&lt;script&gt;alert(1)"), "escaped");
    assert!(!text.contains("\"'&|") && !text.contains("href=") && !text.contains("src="));
}

#[test]
fn the_page_says_points_effects_and_the_command_that_repeats() {
    let text = page(&report(EVIL), &[]);
    for expected in ["12.5 of 70 points", "12.5 / 20", "-12.50 %", "4096", "Content-Security-Policy", "FAIL"]
    {
        assert!(text.contains(expected), "{expected}");
    }
}

#[test]
fn pixels_are_half_floats() {
    // 1.0, 2.0, 0.5 are 0x3c00, 0x4000, 0x3800.
    assert!(page(&report(EVIL), &[picture()]).contains(">ADwAQAA4ADwAQAA4<"));
}
