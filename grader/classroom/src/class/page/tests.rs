use std::collections::BTreeMap;

use super::*;
use crate::class::gradebook::State;
use verdict::sample::EVIL;
use verdict::submission::IntakeFinding;

const RUBRIC: &str = "
assignment: tiny
title: Lights
submission: { file: skeleton/src/algorithms/render_pt.rs, contract: path-tracer }
techniques: [bsdf, nee, mis]
reference_technique: mis
tasks:
  - id: '1'
    title: A light
    points: 10
    checks:
      - { check: mean-bias, scene: point_plane, technique: mis, max_bounces: 1, required: true }
  - { id: '2', title: Why, points: 5, manual: true }
";

fn row(key: &str, text: &str, points: f64) -> Row {
    let finding = || IntakeFinding { code: text.to_owned(), message: text.to_owned() };
    Row {
        key: key.to_owned(),
        last_name: text.to_owned(),
        first_name: text.to_owned(),
        login: text.to_owned(),
        email: text.to_owned(),
        numbers: vec![text.to_owned()],
        on_roster: true,
        sent: text.to_owned(),
        state: State::Graded,
        reason: Some(finding()),
        notes: vec![finding()],
        tasks: BTreeMap::from([("1".to_owned(), Some(points)), ("2".to_owned(), None)]),
        raw: Some(points),
        received_at: None,
        lateness: None,
        points: Some(points),
        explanations: vec![text.to_owned()],
        explanation: String::new(),
        comments: BTreeMap::new(),
        team: String::new(),
        graded_at: None,
        source: String::new(),
        kept: false,
    }
}

/// The record of a submission that fails `failed`, as it lies on the disk.
fn record(out: &Path, key: &str, mistake: Option<&str>, failed: &[&str]) {
    let verdict = |check: &str| if failed.contains(&check) { "fail" } else { "pass" };
    let checks: BTreeMap<String, &str> =
        ["a", "b"].iter().map(|check| (format!("1 {check}"), verdict(check))).collect();
    let record = serde_json::json!({
        "schema": "arty-record/1", "key": "k", "reason": null, "notes": [], "tasks": {"1": 10.0}, "checks": checks,
        "earned": 10.0, "explanations": [], "checksums": [], "source": "s", "graded_at": "", "seconds": 2.0,
        "mistake": mistake, "work": 0.5, "report": "r",
    });
    let folder = out.join("submissions").join(key);
    std::fs::create_dir_all(&folder).expect("it can be made");
    std::fs::write(folder.join("record.json"), record.to_string()).expect("it can be written");
    for page in ["report.html", "report-tutor.html"] {
        std::fs::write(folder.join(page), "").expect("it can be written");
    }
}

fn written(rows: &[Row], changes: &[String], out: &Path) -> String {
    let file = out.join("rubric.yml");
    std::fs::write(&file, RUBRIC).expect("it can be written");
    let rubric = Rubric::load(&file).expect("it is one");
    let path = out.join("class.html");
    ClassPage { rubric: &rubric, rows, changes, similar: 1, out }.save(&path).expect("it can be written");
    std::fs::read_to_string(path).expect("it is there")
}

#[test]
fn nothing_that_a_submission_or_a_name_says_is_markup() {
    let out = tempfile::tempdir().expect("a temporary folder");
    record(out.path(), "ann", Some(EVIL), &["a"]);
    let text = written(&[row("ann", EVIL, 3.0), row("bob", EVIL, 4.0)], &[EVIL.to_owned()], out.path());
    assert!(!text.contains("<script>alert") && text.contains("&lt;script&gt;alert(1)"), "escaped");
    assert!(!text.contains("\"'&|"));
    assert!(text.contains("default-src 'none'") && !text.contains("script-src 'unsafe-inline'"));
}

#[test]
fn the_page_says_what_was_hard_who_is_alike_and_what_is_to_be_marked() {
    let out = tempfile::tempdir().expect("a temporary folder");
    record(out.path(), "ann", Some("the cosine is missing"), &["a", "b"]);
    record(out.path(), "bob", Some("the cosine is missing"), &["a"]);
    record(out.path(), "cem", None, &["a"]);
    record(out.path(), "dan", None, &[]);
    let rows: Vec<Row> = ["ann", "bob", "cem", "dan"].iter().map(|key| row(key, "x", 5.0)).collect();
    let text = written(&rows, &["ann: 1 3 → 5".to_owned()], out.path());
    let digests = Digests::read(out.path(), &rows);
    assert_eq!(
        (digests.checks["1 a"].passed, digests.checks["1 b"].passed, digests.checks["1 a"].run),
        (1, 3, 4)
    );
    let groups: Vec<(&str, usize)> =
        digests.alike.iter().map(|group| (group.what.as_str(), group.rows.len())).collect();
    assert_eq!(groups, [("the cosine is missing", 2), ("1 a", 1)]);
    for expected in [
        "href=\"submissions/ann/report-tutor.html\"",
        "1 of 4",
        "3 of 4",
        "4 submissions without a mark",
        "ann: 1 3 → 5",
        "similar.txt",
        "<svg class=\"plot\"",
    ] {
        assert!(text.contains(expected), "{expected}");
    }
    assert!(text.contains("<div>the cosine is missing</div></td>"), "the cause stands in the table, too");
    let easy = text.find(">b</td>").expect("the check is there");
    assert!(text.find(">a</td>").expect("the check is there") < easy, "the hardest comes first");
}

#[test]
fn thumbnails_are_embedded_and_the_fewest_points_come_first() {
    let out = tempfile::tempdir().expect("a temporary folder");
    for key in ["ann", "bob"] {
        record(out.path(), key, None, &[]);
        std::fs::write(out.path().join("submissions").join(key).join("thumbnail.png"), key)
            .expect("it can be written");
    }
    let text = written(&[row("ann", "x", 9.0), row("bob", "x", 2.0)], &[], out.path());
    let place = |base64: &str| text.find(&format!("data:image/png;base64,{base64}")).expect("it is there");
    assert!(place("Ym9i") < place("YW5u"));
}

#[test]
fn the_leaderboard_is_sorted_and_names_nobody() {
    let out = tempfile::tempdir().expect("a temporary folder");
    let mut rows = Vec::new();
    for (key, work, source) in
        [("ann", "0.5", "aaaaaaaa1"), ("bob", "0.25", "bbbbbbbb2"), ("cem", "null", "c")]
    {
        record(out.path(), key, None, &[]);
        let file = out.path().join("submissions").join(key).join("record.json");
        let text = std::fs::read_to_string(&file).expect("it is there");
        std::fs::write(&file, text.replace("\"work\":0.5", &format!("\"work\":{work}")))
            .expect("it can be written");
        rows.push(Row { source: source.to_owned(), ..row(key, "Somebody", 9.0) });
    }
    // A member of the same team.
    rows.push(Row { key: "ann".to_owned(), ..rows[0].clone() });
    let path = out.path().join("leaderboard.html");
    save_leaderboard(&path, &rows, out.path()).expect("it can be written");
    let text = std::fs::read_to_string(path).expect("it is there");
    let (first, second) = (text.find("bbbbbbbb</code>"), text.find("aaaaaaaa</code>"));
    assert!(first.is_some() && first < second, "{text}");
    assert!(text.contains(">2.00<") && text.contains(">1.00<"), "{text}");
    assert_eq!(text.matches("<code>").count(), 2, "{text}");
    for name in ["Somebody", "ann<", "bob<", "cem"] {
        assert!(!text.contains(name), "{name}");
    }
}
