use super::*;
use verdict::check::{MeanTest, MeasuredWeights, WeightForm, WeightTest};
use verdict::edition::for_student;
use verdict::pictures::{DrawnPath, PathLine, PixelPaths, RayKind};
use verdict::sample::{
    EVIL, STAFF_ONLY, evil_report, furnace_test, mean_test, picture, report, with_staff_only_checks,
};

fn of(text: &str, pictures: &[Picture]) -> String {
    page(&report(text), pictures, Edition::Tutor)
}

#[test]
fn nothing_that_a_submission_says_is_markup() {
    let student = for_student(&evil_report(), Some("render_pt.rs"));
    for text in [
        page(&evil_report(), &[picture(EVIL)], Edition::Tutor),
        page(&student.0, &[picture(EVIL)], student.1),
    ] {
        assert!(!text.contains("<script>alert") && text.contains("&lt;script&gt;alert(1)"), "escaped");
        assert!(!text.contains("\"'&|") && !text.contains("href=") && !text.contains("src="));
    }
}

#[test]
fn the_page_says_points_errors_and_the_command_that_reruns() {
    let text = of(EVIL, &[]);
    for expected in [
        "12.5 of 70 points",
        "12.5 / 20",
        "-12.50 %",
        "4096",
        "Content-Security-Policy",
        "FAIL",
        "cargo grade",
    ] {
        assert!(text.contains(expected), "{expected}");
    }
}

#[test]
fn code_in_sentences_is_shown_as_code() {
    let text = of("open", &[]);
    assert!(text.contains("in open (<code>nee</code>)") && !text.contains("(`nee`)"), "{text}");
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
    assert!(
        text.contains("data-seeds=\"18446744073709551615 7\""),
        "seeds are too large for JavaScript's numbers"
    );
}

#[test]
fn plots_are_there_where_there_are_numbers() {
    let mut report = report("open");
    let measured = MeasuredWeights {
        light: WeightForm::Other,
        bsdf: WeightForm::Other,
        sum: [1.0; 2],
        deviation_at_first_vertex: 0.0,
        deviation_at_later_vertices: 0.0,
        only_way: Vec::new(),
        points: vec![[-1.0, 0.1, 0.9], [1.0, 0.9, 0.1]],
    };
    let kinds = [
        Evidence::MeanBias(MeanTest { z: vec![1.0; 64], ..mean_test() }),
        Evidence::MisWeights(WeightTest { fault: None, measured: Some(measured) }),
        Evidence::WhiteFurnace(furnace_test()),
    ];
    report.checks =
        kinds.map(|evidence| CheckResult { evidence: Some(evidence), ..report.checks[0].clone() }).to_vec();
    let text = page(&report, &[], Edition::Tutor);
    assert_eq!(text.matches("<svg class=\"plot\"").count(), 3);
    report.checks.clear();
    assert!(!page(&report, &[], Edition::Tutor).contains("<svg"));
}

#[test]
fn a_students_page_names_nothing_that_only_staff_may_see() {
    let report = with_staff_only_checks();
    let pictures = [picture("open"), picture("hidden/cellar")];
    let (student, edition) = for_student(&report, None);
    let (shown, everything) = (page(&student, &pictures, edition), page(&report, &pictures, Edition::Tutor));
    for secret in STAFF_ONLY {
        assert!(!shown.contains(secret), "{secret}");
        assert!(everything.contains(secret), "{secret} is there to be found");
    }
    assert!(shown.contains("2 checks in scenes that are not handed out are not shown; 1 passed."));
    assert!(everything.contains("tutor's edition") && !shown.contains("tutor's edition"));
}

#[test]
fn files_for_students_do_not_name_a_path_of_the_staff() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("report.json");
    let mut report = with_staff_only_checks();
    report.submission.path = "submissions/Ann B_12/render_pt.rs".to_owned();
    report.provenance.assignment = "/staff/tiny".to_owned();
    write_pages(&report, &[], &file, Readers::Staff(Some("my/render_pt.rs"))).expect("it can be written");
    let [student, tutor] =
        pages_beside(&file).map(|path| std::fs::read_to_string(path).expect("it is there"));
    assert!(!student.contains("Ann B") && !student.contains("/staff") && student.contains("my/render_pt.rs"));
    assert!(tutor.contains("Ann B") && tutor.contains("/staff/tiny"));
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

#[test]
fn the_page_of_a_class_says_who_handed_in_when_and_what_counts() {
    let mut report = report("open");
    assert!(!page(&report, &[], Edition::Tutor).contains("received"));
    report.hand_in = Some(verdict::report::HandIn {
        student: EVIL.to_owned(),
        received_at: Some("2026-05-22 01:00 CEST".to_owned()),
        late_by: Some(3660),
        factor: 0.8,
        points: 8.0,
    });
    let text = page(&report, &[], Edition::Student { concealed: 0, passed: 0 });
    assert!(
        text.contains(
            "received 2026-05-22 01:00 CEST · 1 h 01 min 00 s late: points × 0.8 · <b>8 points</b>"
        )
    );
    assert!(!text.contains("<script>alert"), "names are escaped");
}

#[test]
fn paths_are_drawn_over_the_picture_of_their_technique() {
    let mut picture = picture("cornell_box");
    let line = |kind, x| PathLine { kind, from: [0.5, 0.5], to: [x, 0.25] };
    let lines = vec![line(RayKind::Arrives, 1.0), line(RayKind::Bounce, 2.0), line(RayKind::Bounce, -3.04)];
    let samples = vec![DrawnPath { radiance: [1.0, f32::NAN, f32::INFINITY], lines }];
    assert!(!of("open", &[picture.clone()]).contains("<svg class=\"paths\""));
    picture.rendered[1].paths = Some(PixelPaths { pixel: [1, 0], samples });
    let text = of("open", &[picture]);
    assert_eq!(text.matches("<svg class=\"paths\"").count(), 1);
    for part in [
        "data-technique=\"mis\" data-pixel=\"1,0\" viewBox=\"0 0 2 1\"",
        "data-radiance=\"1 NaN inf\"",
        "<path class=\"bounce\" d=\"M0.5 0.5L2.0 0.2M0.5 0.5L-3.0 0.2\"></path><path class=\"arrives\"",
        "name=\"paths\"",
    ] {
        assert!(text.contains(part), "{part}");
    }
}
