//! Spreadsheets as offices keep them. `make.py` beside this file made them with openpyxl.

use std::path::Path;

use crate::course::{Course, solution, starter};

#[test]
fn a_roster_and_receipt_times_may_be_spreadsheets() {
    let solution = solution();
    let course = Course::new(&[
        ("Mueller_Juergen_jm1_301/render_pt.rs", &solution),
        ("4711002/render_pt.rs", &starter()),
        ("dp3.rs", &solution),
    ]);
    course.write("course.yml", "deadline: 2026-05-21 23:59\n");
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/class/spreadsheets");
    let option = |name: &str, file: &str| format!("--{name}={}", here.join(file).display());
    let (roster, manifest) = (option("roster", "roster.xlsx"), option("manifest", "received.xlsx"));
    course.run(&[roster.as_str(), manifest.as_str(), "--course=course.yml", "--out=out"]);
    let points: Vec<_> =
        course.results("out").into_iter().map(|(key, (_, _, points))| (key, points)).collect();
    // The first was one hour late, the second in time, and nothing is known of the third.
    let expected = [("co2", 0.0), ("dp3", 10.0), ("jm1", 8.0)];
    assert_eq!(points, expected.map(|(key, points)| (key.to_owned(), Some(points))));
    let gradebook = course.read("out/gradebook.csv");
    assert!(gradebook.contains("4711001") && gradebook.contains("Müller"), "{gradebook}");
    assert!(
        gradebook.contains("2026-05-21T22:59:00Z") && gradebook.contains("2026-05-21T21:41:00Z"),
        "{gradebook}"
    );
}
