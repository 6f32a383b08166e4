//! Receipt times from the tables of course systems.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::course::Course;

/// A submission that costs no grade.
const BROKEN: &str = "pub struct PathTracer;\nfn main( {";

/// Receipt time and standing of each student.
fn received(course: &Course, out: &str) -> BTreeMap<String, (String, String)> {
    let class: Value = serde_json::from_str(&course.read(&format!("{out}/class.json"))).expect("it is JSON");
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let rows = class["rows"].as_array().expect("there are rows");
    rows.iter()
        .map(|row| (text(&row["key"]), (text(&row["received_at"]), text(&row["lateness"]["standing"]))))
        .collect()
}

#[test]
fn the_tables_of_course_systems_tell_when_somebody_handed_in() {
    let expected = |keys: [&str; 3]| {
        let rows = [("2026-05-21T22:30:00Z", "late"), ("2026-05-21T21:41:00Z", "in-time"), ("", "")];
        let own = |(time, standing): (&str, &str)| (time.to_owned(), standing.to_owned());
        keys.into_iter().map(str::to_owned).zip(rows.map(own)).collect::<BTreeMap<_, _>>()
    };
    let moodle = Course::new(&[
        ("Ann Lee_11_assignsubmission_file_/render_pt.rs", BROKEN),
        ("Bob Ray_12_assignsubmission_file_/render_pt.rs", BROKEN),
    ]);
    moodle.write("course.yml", "deadline: 2026-05-21 23:59\n");
    moodle.write(
        "moodle.csv",
        "Identifier,Full name,Email address,Status,Grade,Last modified (submission)\n\
         Participant 11,Ann Lee,al@x.org,Submitted,,\"Friday, 22 May 2026, 12:30 AM\"\n\
         Participant 12,Bob Ray,br@x.org,Submitted,,\"Thursday, 21 May 2026, 11:41 PM\"\n\
         Participant 13,Cem Öz,co@x.org,No submission,,-\n",
    );
    moodle.run(&["--moodle=moodle.csv", "--manifest=moodle.csv", "--course=course.yml", "--out=out"]);
    assert_eq!(received(&moodle, "out"), expected(["al@x.org", "br@x.org", "co@x.org"]));

    let ilias = Course::new(&[
        ("Ex/Sheet/Lee_Ann_al_1_301/render_pt.rs", BROKEN),
        ("Ex/Sheet/Ray_Bob_br2_302/render_pt.rs", BROKEN),
    ]);
    ilias.write("course.yml", "deadline: 2026-05-21 23:59\n");
    ilias.write(
        "status.csv",
        "update;usr_id;login;lastname;firstname;status;mark;notice;comment;Letzte Abgabe\n\
         0;301;al_1;Lee;Ann;notgraded;;;;22. Mai 2026, 00:30\n0;302;br2;Ray;Bob;notgraded;;;;21.05.2026 23:41\n\
         0;303;co3;Öz;Cem;notgraded;;;;\n",
    );
    ilias.run(&["--ilias=status.csv", "--manifest=status.csv", "--course=course.yml", "--out=out"]);
    assert_eq!(received(&ilias, "out"), expected(["al_1", "br2", "co3"]));

    ilias.write("status.csv", &ilias.read("status.csv").replace("22. Mai 2026", "32. Mai 2026"));
    let told = ilias.fails(&["--ilias=status.csv", "--manifest=status.csv", "--out=new"], 2);
    assert!(told.contains("status.csv:2: column `Letzte Abgabe`: `32. Mai 2026, 00:30`"), "{told}");
}
