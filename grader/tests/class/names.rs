//! Submissions at the right name: teams, rosters that do not fit, submissions that vanished.

use crate::course::{Course, solution, starter};

#[test]
fn a_team_has_one_submission_and_two_different_ones_are_a_question() {
    let solution = solution();
    let course = Course::new(&[
        ("Group_123457_assignsubmission_file_/render_pt.rs", &solution),
        ("Cem Öz_13_assignsubmission_file_/render_pt.rs", &solution),
        ("Dee Poe_14_assignsubmission_file_/render_pt.rs", &solution.replace("0.95", "0.9")),
        ("Eve Fox_15_assignsubmission_file_/render_pt.rs", &solution),
    ]);
    course.write(
        "roster.csv",
        "number,Full name,team\n123457,Zoe Y,\n1,Ann Lee,Group 123457\n2,Bob Ray,123457\n3,Cem Öz,red\n4,Dee Poe,red\n5,Eve Fox,\n",
    );
    let told = course.run(&["--roster=roster.csv", "--out=out"]);
    assert!(told.contains("2 graded now, 0 unchanged"), "a team's submission is graded once: {told}");
    let record = |key: &str| course.read(&format!("out/submissions/{key}/record.json"));
    assert_eq!(record("1"), record("2"));
    let results = course.results("out");
    let code = |key: &str| results[key].1.as_str();
    assert_eq!([results["1"].2, results["2"].2, results["5"].2], [Some(10.0); 3]);
    assert_eq!(code("123457"), "missing", "the number of a group is no number of a student");
    assert_eq!([code("3"), code("4")], ["several-candidates"; 2]);
    let similar = course.read("out/similar.txt");
    assert!(similar.contains("layout: 1, 5"), "a team did not copy from itself: {similar}");
    let told = course.run(&["--roster=roster.csv", "--out=out", "--resume"]);
    assert!(told.contains("0 graded now, 3 unchanged"), "{told}");
    let told = course.run(&["--roster=roster.csv", "--out=out", "--regrade"]);
    assert!(told.contains("2 graded now, 0 unchanged"), "{told}");
}

#[test]
fn a_class_that_does_not_fit_its_roster_is_not_graded() {
    let course = Course::new(&[("ann/render_pt.rs", &solution()), ("Team 7/render_pt.rs", &solution())]);
    course.write("roster.csv", "login\nann\nbob\n");
    let told = course.fails(&["--roster=roster.csv", "--out=out"], 3);
    assert!(told.contains("Team 7") && told.contains("--allow-unknown"), "{told}");
    assert!(!course.path("out").exists(), "nothing is written");
    course.write("teams.csv", "student,received_at,team\nbob,2026-05-21 12:00,7\n");
    course.run(&["--roster=roster.csv", "--manifest=teams.csv", "--out=out"]);
    assert_eq!(course.results("out")["bob"].2, Some(10.0));
    course.write("others.csv", "login\nann\nx\ny\nz\n");
    let told = course.fails(&["--roster=others.csv", "--out=other", "--allow-unknown"], 3);
    assert!(told.contains("3 of 4 students") && told.contains("--allow-missing"), "{told}");
    let told = course.fails(&["--roster=roster.csv", "--manifest=teams.csv", "--out=out"], 2);
    assert!(told.contains("--resume"), "{told}");
    course.write(
        "course.yml",
        "deadline: 2026-05-21 23:59\nextensions:\n- { student: anm, until: 2026-05-23 12:00, reason: ill }\n",
    );
    let arguments =
        ["--roster=roster.csv", "--manifest=teams.csv", "--course=course.yml", "--out=out", "--resume"];
    let told = course.fails(&arguments, 2);
    assert!(told.contains("`anm`"), "{told}");
}

#[test]
fn a_submission_that_vanished_is_a_change_and_two_runs_at_once_are_refused() {
    let course = Course::new(&[("ann/render_pt.rs", &solution()), ("bob/render_pt.rs", &solution())]);
    course.run(&["--out=out"]);
    std::fs::remove_dir_all(course.path("class/bob")).expect("it can be removed");
    let told = course.run(&["--out=out", "--resume"]);
    assert!(told.contains("bob: 10 → not in the class"), "{told}");
    course.write("roster.csv", "login\nann\nbob\n");
    let told = course.run(&["--out=out", "--resume", "--roster=roster.csv"]);
    assert!(told.contains("bob: 10 → nothing was handed in"), "{told}");
    let lock = std::fs::File::options().write(true).open(course.path("out/.lock")).expect("it is there");
    lock.lock().expect("it is free");
    let told = course.fails(&["--out=out", "--resume"], 2);
    assert!(told.contains("another grader"), "{told}");
}

#[test]
fn a_preview_tells_check_by_check_and_replaces_nothing() {
    let course = Course::new(&[("ann/render_pt.rs", &solution()), ("bob/render_pt.rs", &starter())]);
    course.run(&["--out=out"]);
    let before = course.read("out/class.json");
    let record = course.read("out/submissions/ann/record.json");
    let rubric = course.read("rubric/rubric.yml");
    course.write("rubric/rubric.yml", &rubric.replace("points: 10", "points: 20"));
    let told = course.run(&["--out=out", "--preview"]);
    assert!(told.contains("1 of 2 scores changed\n  ann: 1 10 → 20"), "{told}");
    course.write("rubric/rubric.yml", &rubric);
    course.write("class/ann/render_pt.rs", &starter());
    let told = course.run(&["--out=out", "--preview"]);
    assert!(told.contains("ann: 1 10 → 0\n    1 mean-bias"), "{told}");
    assert!(told.contains("passed → failed") || told.contains("pass → fail"), "{told}");
    assert_eq!(course.read("out/class.json"), before);
    assert_eq!(course.read("out/submissions/ann/record.json"), record);
}
