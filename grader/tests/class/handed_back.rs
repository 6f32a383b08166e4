//! What students get back: archives of feedback as Moodle and ILIAS take them, and the leaderboard.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;

use crate::course::{Course, solution, starter, stderr};

/// Reports of students, by their paths in an archive.
type Archive = BTreeMap<String, String>;

/// Submissions whose folders Moodle has named; Fay's has no source.
fn course() -> Course {
    let solution = solution();
    let course = Course::new(&[
        ("Ann Lee_11_assignsubmission_file_/render_pt.rs", &solution),
        ("Ann Lee_11_assignsubmission_file_/why.txt", "Because of the densities."),
        ("Bob_Ray Öz_12_assignsubmission_file_/render_pt.rs", &format!("// mine\n{solution}")),
        ("Dee Poe_14_assignsubmission_file_/render_pt.rs", &starter()),
        ("Fay Ng_15_assignsubmission_file_/why.txt", "I have no program."),
    ]);
    course.write(
        "moodle.csv",
        "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Last modified (submission),Feedback comments\n\
         Participant 11,Ann Lee,al@x.org,Submitted,,15.00,\"Friday, 22 May 2026, 12:30 AM\",\n\
         Participant 12,Bob_Ray Öz,bo@x.org,Submitted,,15.00,\"Thursday, 21 May 2026, 11:41 PM\",\n\
         Participant 13,Cem Ay,ca@x.org,No submission,,15.00,-,\n\
         Participant 14,Dee Poe,dp@x.org,Submitted,,15.00,\"Thursday, 21 May 2026, 11:41 PM\",\n\
         Participant 15,Fay Ng,fn@x.org,Submitted,,15.00,\"Thursday, 21 May 2026, 11:41 PM\",\n",
    );
    course.write(
        "status.csv",
        "update;usr_id;login;lastname;firstname;email;status;mark;notice;comment\n\
         0;301;al_1;Lee;Ann;al@x.org;notgraded;;;\n0;302;bo2;Öz;Bob_Ray;bo@x.org;notgraded;;;\n\
         0;303;ca3;Ay;Cem;ca@x.org;notgraded;;;\n0;304;dp4;Poe;Dee;dp@x.org;notgraded;;;\n\
         0;305;fn5;Ng;Fay;fn@x.org;notgraded;;;\n",
    );
    course.write("course.yml", "deadline: 2026-05-21 23:59\nleaderboard: true\n");
    let rubric = course.read("rubric/rubric.yml");
    let noisy =
        "      - { check: efficiency, scene: cornell_box, technique: mis, max_bounces: 1 }\n  - { id: '2',";
    course.write("rubric/rubric.yml", &rubric.replacen("  - { id: '2',", noisy, 1));
    course
}

/// Grades the class with its pages, and returns what is said.
fn grade(course: &Course, more: &[&str]) -> String {
    let tables = ["--moodle=moodle.csv", "--ilias=status.csv", "--manifest=moodle.csv"];
    let always = ["class", "class", "--course=course.yml", "--feedback"];
    let output = course.other(&[&always[..], &tables, more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stderr(&output) + &String::from_utf8_lossy(&output.stdout)
}

fn archive(course: &Course, name: &str) -> Archive {
    let mut archive = zip::ZipArchive::new(File::open(course.path(name)).expect(name)).expect("it is a zip");
    (0..archive.len())
        .map(|index| {
            let mut file = archive.by_index(index).expect("it can be read");
            let mut text = String::new();
            file.read_to_string(&mut text).expect("it is text");
            (file.name().expect("it is UTF-8").into_owned(), text)
        })
        .collect()
}

/// Finds the participant as Moodle does: the second of five parts between `_` of a part of the path.
fn participant(path: &str) -> Option<&str> {
    path.split('/').find_map(|part| {
        let parts: Vec<&str> = part.splitn(5, '_').collect();
        let [_, number, "assignsubmission", "file", ""] = parts[..] else { return None };
        number.parse::<u32>().ok().map(|_| number)
    })
}

/// The text of a page, without tags, script and images.
fn text(page: &str) -> String {
    let body = &page[page.find("<body>").expect("it has a body")..];
    let body = body.split("<script").next().unwrap_or_default();
    body.split('<').map(|part| part.split_once('>').map_or("", |(_, text)| text)).collect()
}

/// Asserts that the text of a page has all of the first parts and none of the others.
fn assert_says(page: &str, expected: &[&str], others: &[&str]) {
    let text = text(page);
    let missing: Vec<_> = expected.iter().filter(|part| !text.contains(**part)).collect();
    let wrong: Vec<_> = others.iter().filter(|part| text.contains(**part)).collect();
    assert!(
        missing.is_empty() && wrong.is_empty(),
        "missing: {missing:?}; wrong: {wrong:?} in: {}",
        text.chars().take(600).collect::<String>()
    );
}

#[test]
fn reports_go_back_to_those_who_handed_in_and_the_leaderboard_names_nobody() {
    let course = course();
    grade(&course, &["--out=out"]);
    course.write("marks.csv", "student,2,comment\nann lee,4.5,Well said\nfn@x.org,2,Half of it\n");
    let output = course.other(&["mark", "--from=marks.csv", "--out=out"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    grade(&course, &["--out=out", "--resume"]);

    let moodle = archive(&course, "out/feedback-moodle.zip");
    let paths = moodle.keys().map(String::as_str);
    assert_eq!(paths.clone().map(participant).collect::<Vec<_>>(), ["11", "12", "14", "15"].map(Some));
    assert!(paths.clone().all(|path| path.ends_with("_assignsubmission_file_/report.html")), "{paths:?}");
    let ilias = archive(&course, "out/feedback-ilias.zip");
    let folders = ["Lee_Ann_al_1_301", "Ng_Fay_fn5_305", "Poe_Dee_dp4_304", "Öz_Bob Ray_bo2_302"];
    let expected = folders.map(|folder| format!("multi_feedback/{folder}/report.html"));
    assert_eq!(ilias.keys().cloned().collect::<Vec<_>>(), expected);

    let page = |folder: &str| moodle[&format!("{folder}_assignsubmission_file_/report.html")].as_str();
    let late = "received 2026-05-22 00:30:00 CEST · 0 h 31 min 00 s late: points × 0.8 · 11.5 points so far";
    assert_says(
        page("Ann Lee_11"),
        &["Ann Lee", late, "4.5", "Well said"],
        &["Bob", "Dee", "Fay", "Half of it"],
    );
    let in_time = "received 2026-05-21 23:41:00 CEST";
    assert_says(page("Bob Ray Öz_12"), &["Bob_Ray Öz", in_time], &["00 s late", "Ann", "Well said"]);
    assert_says(page("Fay Ng_15"), &["Fay Ng", in_time, "render_pt.rs", "Half of it"], &["Ann", "Well said"]);
    assert_eq!(ilias[&expected[0]], page("Ann Lee_11"));

    let board = course.read("out/leaderboard.html");
    let class: serde_json::Value = serde_json::from_str(&course.read("out/class.json")).expect("it is JSON");
    let rows = class["rows"].as_array().expect("there are rows");
    let mut shown = 0;
    for row in rows {
        for field in ["key", "last_name", "first_name", "login", "email", "sent"] {
            let name = row[field].as_str().expect("it is text");
            assert!(name.is_empty() || !board.contains(name), "{name}");
        }
        let numbers = row["numbers"].as_array().expect("there are some").iter().filter_map(|it| it.as_str());
        numbers.for_each(|number| assert!(!board.contains(&format!(">{number}<")), "{number}"));
        let hash = row["source"].as_str().expect("it is text").get(..8);
        shown += usize::from(hash.is_some_and(|hash| board.contains(hash)));
    }
    assert_eq!(shown, 2, "those whose MIS passes: {board}");
    let own = board.split("<code>").nth(1).and_then(|text| text.get(..8)).expect("it has entries");
    let whose = moodle.iter().filter(|(_, page)| page.contains(own)).count();
    assert_eq!(whose, 1, "the report of one student tells the hash");

    // Who has withdrawn gets no report of what was there before.
    std::fs::remove_dir_all(course.path("class/Ann Lee_11_assignsubmission_file_")).expect("it is there");
    let told = grade(&course, &["--out=out", "--resume"]);
    assert!(told.contains("al_1: 10 → nothing was handed in"), "{told}");
    let paths: Vec<String> = archive(&course, "out/feedback-moodle.zip").into_keys().collect();
    assert_eq!(paths.iter().map(|path| participant(path)).collect::<Vec<_>>(), ["12", "14", "15"].map(Some));
}

#[test]
fn merged_reports_have_the_marks() {
    let course = Course::new(&[("Ann Lee_11_assignsubmission_file_/why.txt", "Because.")]);
    course.write(
        "moodle.csv",
        "Identifier,Full name,Grade\nParticipant 11,Ann Lee,\nParticipant 12,Bob Ray,\n",
    );
    for shard in ["--shard=1/2", "--shard=2/2"] {
        let output = course.other(&["class", "class", "--moodle=moodle.csv", "--out=out", shard]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    for arguments in [
        &["merge", "--out=out"][..],
        &["mark", "11", "2", "3", "--comment=Nearly", "--out=out"],
        &["merge", "--moodle=moodle.csv", "--feedback", "--out=out"],
    ] {
        let output = course.other(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    }
    let reports = archive(&course, "out/feedback-moodle.zip");
    assert_says(&reports["Ann Lee_11_assignsubmission_file_/report.html"], &["Ann Lee", "Nearly"], &[]);
}

#[test]
fn feedback_needs_a_course_system_whose_names_it_has() {
    let course = Course::new(&[("ann/why.txt", "Because.")]);
    let output = course.other(&["class", "class", "--feedback", "--out=out"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("--moodle or --ilias"), "{}", stderr(&output));
    assert!(!course.path("out").exists());
}
