//! Which file is the source, in folders as course systems write them.

use super::*;

const NEWER: &str = "pub struct PathTracer { newer: u8 }\n";

/// Files in one folder, given one by one, as `class` does without folders.
fn take_files(files: &[(&str, &[u8])], source: Option<&str>) -> Intake {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_all(folder.path(), files);
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.path().join(name)).collect();
    take(&paths, &wanted(STARTER), source).expect("the files are there")
}

fn pick(files: &[(&str, &[u8])], source: &str) -> Intake {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_all(folder.path(), files);
    take(&[folder.path().to_owned()], &wanted(STARTER), Some(source)).expect("the folder is there")
}

fn explanations(intake: &Intake) -> Vec<&str> {
    intake.explanations.iter().map(|explanation| explanation.name.as_str()).collect()
}

#[test]
fn without_folders_pictures_pages_and_tables_are_no_sources() {
    let intake = take_files(
        &[
            ("Ann Lee_11_assignsubmission_file_render_pt.rs", SOURCE.as_bytes()),
            ("Ann Lee_11_assignsubmission_file_helper.rs", b"pub fn help() {}"),
            ("Ann Lee_11_assignsubmission_file_curve.png", b"\x89PNG\r\n"),
            ("Ann Lee_11_assignsubmission_file_Cargo.toml", b"[package]\nname = \"PathTracer\""),
            ("Ann Lee_11_assignsubmission_onlinetext_.html", b"<p>struct PathTracer</p>"),
        ],
        None,
    );
    assert_eq!((source(&intake), notes(&intake)), (SOURCE, vec!["no-type", "other-name"]));
    assert_eq!(explanations(&intake), ["Ann Lee_11_assignsubmission_onlinetext_.html"]);
}

#[test]
fn explanations_are_there_without_a_source() {
    for name in ["why.docx", "why.odt", "why.html", "why.md", "why.pdf", "why.txt", "README.md"] {
        for intake in [take_folder(&[(name, b"because")]), take_files(&[(name, b"because")], None)] {
            assert_eq!((code(&intake), explanations(&intake)), ("missing-file", vec![name]));
        }
    }
    let picture = take_files(&[("curve.png", b"\x89PNG\r\n")], None);
    assert_eq!(code(&picture), "missing-file");
    assert!(picture.outcome.expect_err("it is none").to_string().contains("curve.png"));
}

#[test]
fn a_text_file_is_a_source_if_it_is_rust_and_defines_the_type() {
    let rust =
        "// Ann's solution\nuse arty::prelude::*;\n\n/// Doesn't clamp.\npub struct PathTracer { a: u8 }\n";
    let intake = take_folder(&[("render_pt.txt", rust.as_bytes()), ("why.txt", b"I didn't clamp.")]);
    assert_eq!((source(&intake), notes(&intake)), (rust, vec!["other-name"]));
    assert_eq!(explanations(&intake), ["why.txt"]);
    for prose in [
        "In my code, pub struct PathTracer; has no fields",
        "I wrote `pub struct PathTracer;` since it doesn't need any",
        "fn main() { PathTracer::new() }",
    ] {
        let intake = take_folder(&[("why.txt", prose.as_bytes())]);
        assert_eq!((code(&intake), explanations(&intake)), ("missing-file", vec!["why.txt"]), "{prose}");
    }
}

#[test]
fn a_missing_bracket_hides_no_source() {
    let cut = b"pub struct PathTracer {\n";
    let intake = take_files(&[("my solution.rs", cut), ("why.txt", b"so")], None);
    assert_eq!(code(&intake), "ok");
    let intake = take_folder(&[("render_pt(1).rs", cut), ("helper.rs", b"fn f() {}")]);
    assert_eq!(code(&intake), "ok");
}

#[test]
fn of_resubmissions_the_newest_by_the_systems_naming_is_graded() {
    let newer = NEWER.as_bytes();
    for (first, second) in [
        ("render_pt.rs", "render_pt (2).rs"),
        ("render_pt.rs", "Late Submission - render_pt (2).rs"),
        ("render_pt (2).rs", "Verspaetete Abgabe - render_pt (10).rs"),
        ("render_pt.rs", "render_pt(1).rs"),
    ] {
        let intake = take_folder(&[(first, SOURCE.as_bytes()), (second, newer)]);
        assert_eq!(
            (source(&intake), notes(&intake)),
            (NEWER, vec!["older-version", "other-name"]),
            "{first}, {second}"
        );
        let older = pick(&[(first, SOURCE.as_bytes()), (second, newer)], first);
        assert_eq!(source(&older), SOURCE, "{first}, {second}");
    }
    let late = take_folder(&[("Late Submission - render_pt.rs", newer)]);
    assert_eq!((source(&late), notes(&late)), (NEWER, vec!["other-name"]));
    // No naming of a system says which of these is newer.
    let unclear = take_folder(&[("old - render_pt.rs", SOURCE.as_bytes()), ("render_pt.rs", newer)]);
    assert_eq!(code(&unclear), "several-candidates");
}

#[test]
fn the_question_which_source_has_its_answer_in_the_message() {
    let archive = zip(&[("a/render_pt.rs", SOURCE.as_bytes()), ("b/render_pt.rs", NEWER.as_bytes())]);
    let outer = zip(&[("inner.zip", &archive)]);
    for files in [
        vec![("a/render_pt.rs", SOURCE.as_bytes()), ("b/render_pt.rs", NEWER.as_bytes())],
        vec![("all.zip", &archive[..])],
        vec![("outer.zip", &outer[..])],
    ] {
        let question = take_folder(&files).outcome.expect_err("nobody knows");
        let Refusal::SeveralCandidates(names) = &question else { panic!("{question:?}") };
        assert!(question.to_string().contains("--source=PATH"), "{question}");
        for (name, expected) in names.iter().zip([SOURCE, NEWER]) {
            assert_eq!(source(&pick(&files, name)), expected, "{name}");
        }
        assert_eq!(source(&pick(&files, "b/render_pt.rs")), NEWER);
        let wrong = pick(&files, "c/render_pt.rs").outcome.expect_err("there is none");
        assert_eq!(wrong.code(), "source-not-found");
        assert!(wrong.to_string().contains("b/render_pt.rs"), "{wrong}");
    }
}

#[test]
fn of_several_folders_each_name_says_which() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_all(
        folder.path(),
        &[("one/render_pt.rs", SOURCE.as_bytes()), ("two/render_pt.rs", NEWER.as_bytes())],
    );
    let paths = [folder.path().join("one"), folder.path().join("two")];
    assert_eq!(code(&take(&paths, &wanted(STARTER), None).expect("they are there")), "several-candidates");
    assert_eq!(
        source(&take(&paths, &wanted(STARTER), Some("two/render_pt.rs")).expect("they are there")),
        NEWER
    );
}

#[test]
fn another_name_beside_the_right_one_is_noted() {
    let files: [(&str, &[u8]); 2] = [("render_pt.rs", SOURCE.as_bytes()), ("backup.rs", NEWER.as_bytes())];
    let intake = take_folder(&files);
    assert_eq!((source(&intake), notes(&intake)), (SOURCE, vec!["other-source"]));
    assert_eq!(source(&pick(&files, "backup.rs")), NEWER);
}

#[test]
fn a_file_with_the_right_name_that_is_no_submission_gives_way() {
    let intake = take_folder(&[("render_pt.rs", b"see solution.rs"), ("solution.rs", SOURCE.as_bytes())]);
    assert_eq!((source(&intake), notes(&intake)), (SOURCE, vec!["no-type", "other-name"]));
}
