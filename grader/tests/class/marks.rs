//! Points that tutors give: at the right name, and in the tables.

use crate::course::{Course, solution, starter, stderr};

fn course() -> Course {
    let course = Course::new(&[
        ("ann/render_pt.rs", &starter()),
        ("ann/why.txt", "Because of the densities."),
        ("bob/render_pt.rs", &starter()),
        ("bob/why.txt", "No idea."),
        ("cem/why.txt", "I have no program, but I know why."),
        ("dee/render_pt.rs", &starter()),
    ]);
    course.write("roster.csv", "login;Name\nann;Ann Lee\nbob;Bob Ray\ncem;Cem Öz\ndee;Dee Poe\n");
    course
}

#[test]
fn a_mark_is_of_one_student_and_one_explanation_whoever_else_sent_the_same_file() {
    let course = course();
    let again = ["--roster=roster.csv", "--out=out", "--resume"];
    course.run(&["--roster=roster.csv", "--out=out"]);
    let points = |key: &str| course.results("out")[key].2;
    for arguments in [["mark", "ann", "2", "4", "--out=out"], ["mark", "class/cem", "2", "5", "--out=out"]] {
        let output = course.other(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    course.run(&again);
    assert_eq!([points("ann"), points("bob"), points("dee")], [Some(4.0), Some(0.0), Some(0.0)]);
    assert_eq!(points("cem"), Some(5.0), "an explanation without a source is worth its points");

    // Another source with the same explanation keeps the mark, another explanation does not.
    course.write("class/ann/render_pt.rs", &solution());
    course.write("class/cem/why.txt", "It was different.");
    course.run(&again);
    assert_eq!([points("ann"), points("cem")], [Some(14.0), Some(0.0)]);
    assert!(course.read("out/gradebook.csv").contains("mark-again"));
    for (student, said) in [("nobody", "nobody in the class"), ("ann", "worth 0 to 5")] {
        let output = course.other(&["mark", student, "2", "6", "--out=out"]);
        assert_eq!(output.status.code(), Some(2));
        let said = if student == "ann" { said } else { "2" };
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn marks_of_a_table_are_recorded_all_or_none() {
    let course = course();
    course.run(&["--roster=roster.csv", "--out=out"]);
    course.write("wrong.csv", "student;2;comment\nann;4;\nBob Ray;half;\n");
    let output = course.other(&["mark", "--from=wrong.csv", "--out=out"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("wrong.csv:3: column `2`: `half`"), "{}", stderr(&output));
    course.write("nobody.csv", "student,task,points\nann,2,4\nzoe,2,3\n");
    let output = course.other(&["mark", "--from=nobody.csv", "--out=out"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("nobody.csv:3: `zoe`"), "{}", stderr(&output));
    for (last, expected) in
        [("Ann Lee,2,3,", "4 points"), ("Ann Lee,2,4,Too short", "4 points"), ("zoe,2,3,", "`zoe`")]
    {
        course.write("twice.csv", &format!("student,task,points,comment\nann,2,4,\nbob,2,3,\n{last}\n"));
        let output = course.other(&["mark", "--from=twice.csv", "--out=out"]);
        let told = stderr(&output);
        assert!(output.status.code() == Some(2) && told.contains("twice.csv:4: "), "{told}");
        assert!(told.contains(expected) && told.lines().count() == 1, "nothing else is told: {told}");
    }
    assert!(!course.path("out/marks.json").exists(), "nothing is recorded");
    course.write("marks.csv", "student;2;comment\nann;4,5;Well said\nBob Ray;;\ncem;1;\n");
    let output = course.other(&["mark", "--from=marks.csv", "--out=out"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    course.write(
        "moodle.csv",
        "Identifier,Full name,Email address,Grade,Feedback comments\n\
         Participant 11,Ann Lee,,,Please see me\nParticipant 12,Bob Ray,,,\n",
    );
    let output = course
        .command(&["--roster=roster.csv", "--moodle=moodle.csv", "--out=out", "--resume"])
        .output()
        .expect("it starts");
    assert!(
        stderr(&output).contains("warning: task 2: 1 explanation not marked yet (bob"),
        "{}",
        stderr(&output)
    );
    let filled = course.read("out/moodle.csv");
    assert!(filled.contains("Ann Lee,,4.5,\"Please see me\n\n1: 0; 2: 4.5 (Well said)\""), "{filled}");
}
