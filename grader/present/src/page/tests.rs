use super::*;
use verdict::sample::{EVIL, picture, report};

fn of(text: &str, pictures: &[Picture]) -> String {
    page(&report(text), pictures, Edition::Tutor)
}

#[test]
fn nothing_that_a_hand_in_says_is_markup() {
    let student = verdict::edition::for_student(&report(EVIL), Some("render_pt.rs")).expect("it can be made");
    for text in [of(EVIL, &[picture(EVIL)]), page(&student.0, &[picture(EVIL)], student.1)] {
        assert!(!text.contains("<script>alert") && text.contains("&lt;script&gt;alert(1)"), "escaped");
        assert!(!text.contains("\"'&|") && !text.contains("href=") && !text.contains("src="));
    }
}

#[test]
fn the_page_says_points_effects_and_the_command_that_repeats() {
    let text = of(EVIL, &[]);
    for expected in ["12.5 of 70 points", "12.5 / 20", "-12.50 %", "4096", "Content-Security-Policy", "FAIL"]
    {
        assert!(text.contains(expected), "{expected}");
    }
}

#[test]
fn only_the_pages_own_script_may_run() {
    let text = of("open", &[picture("cornell_box")]);
    let policy =
        text.split("Content-Security-Policy\" content=\"").nth(1).and_then(|rest| rest.split('"').next());
    let policy = policy.expect("there is a policy");
    assert!(policy.contains("default-src 'none'") && policy.contains("script-src 'sha256-"), "{policy}");
    assert!(!policy.contains("script-src 'unsafe-inline'"), "{policy}");
}

#[test]
fn pixels_are_half_floats_and_what_is_derived_is_bytes() {
    let text = of("open", &[picture("cornell_box")]);
    // 1.0, 2.0, 0.5 are 0x3c00, 0x4000, 0x3800; z of 0 and −3 are 0 and −30 tenths; FLIP of 0 and 1 are 0 and 255.
    for bytes in [">ADwAQAA4ADwAQAA4<", ">AOI=<", ">AP8=<"] {
        assert!(text.contains(bytes), "{bytes}");
    }
    assert!(text.contains("data-seeds=\"18446744073709551615 7\""), "seeds are no numbers of JavaScript's");
}

#[test]
fn plots_are_there_where_there_are_numbers() {
    let mut report = report("open");
    report.checks[0].z = vec![1.0; 64];
    report.checks[0].weights = Some(verdict::report::Weights {
        largest_deviation: 0.0,
        light_exponents: None,
        bsdf_exponents: None,
        measured: vec![[-1.0, 0.1, 0.9], [1.0, 0.9, 0.1]],
    });
    let text = page(&report, &[], Edition::Tutor);
    assert_eq!(text.matches("<svg class=\"plot\"").count(), 3);
    report.checks[0].z.clear();
    report.checks[0].coefficients.clear();
    report.checks[0].weights = None;
    assert!(!page(&report, &[], Edition::Tutor).contains("<svg"));
}

#[test]
fn a_page_that_would_be_too_large_has_fewer_pictures() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("report.json");
    let mut large = picture("large");
    large.reference = vec![0; 600_000];
    write_pages(&report("open"), &[picture("small"), large.clone(), large], &file, Readers::Staff(None))
        .expect("it can be written");
    let text = std::fs::read_to_string(&pages_beside(&file)[1]).expect("it is there");
    assert!(
        text.len() < 3_000_000 && text.matches("<figure class=\"pictures\"").count() == 2,
        "{}",
        text.len()
    );
}
