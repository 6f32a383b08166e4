//! Diagnosis of the committed observations of variants, with signatures from other grades. Most tests grade nothing:
//! `cargo lab signatures` makes the files.

use std::collections::BTreeSet;

use harness::assignment::Assignment;
use harness::assignment_folder::AssignmentFolder;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::checks::Quantity;
use judge::diagnosis::{
    Catalogue, CheckObservations, CheckState, Confusion, Number, ObservationVector, Signatures, UNKNOWN,
};
use judge::grade::{Grader, Options};
use lab::mutants::{Kind, Variant, variants};
use verdict::check::CheckId;
use verdict::report::Cause;
use verdict::rubric::Rubric;
use verdict::submission::Submission;

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment() -> AssignmentFolder {
    workspace().assignment("05-nee-mis")
}

fn rubric() -> Rubric {
    assignment().rubric().expect("it is sound")
}

fn all() -> Vec<Variant> {
    variants(&Assignment::open(&workspace(), "05-nee-mis").expect("it is sound"))
        .expect("they are sound")
        .list
}

fn catalogue() -> Catalogue {
    Catalogue::load(&assignment(), &rubric()).expect("causes and signatures fit")
}

/// Observations that are not signatures.
fn cases() -> Signatures {
    Signatures::load(&assignment().confusion_data()).expect("it is there")
}

fn confusion(change: impl Fn(&ObservationVector) -> ObservationVector) -> Confusion {
    let (catalogue, mut confusion) = (catalogue(), Confusion::default());
    for (variant, seed, vector) in cases().all() {
        confusion.add(&catalogue, variant, seed, &change(vector));
    }
    confusion
}

#[test]
fn every_wrong_variant_shows_one_cause_and_no_right_one_does() {
    let catalogue = catalogue();
    for variant in all() {
        let named = catalogue.causes().iter().filter(|cause| cause.variants.contains(&variant.id)).count();
        assert_eq!(named, usize::from(variant.kind == Kind::Wrong), "{}", variant.id);
    }
}

#[test]
fn every_wrong_variant_has_a_signature() {
    let learnt = Signatures::load(&assignment().signatures_file()).expect("it is there");
    let wrong = all().into_iter().filter(|variant| variant.kind == Kind::Wrong);
    let missing: Vec<String> =
        wrong.filter(|variant| learnt.get(&variant.id).is_none()).map(|variant| variant.id).collect();
    assert!(missing.is_empty(), "run `cargo lab signatures`: {missing:?}");
}

#[test]
fn signatures_are_never_tested_on_themselves() {
    let learnt = Signatures::load(&assignment().signatures_file()).expect("it is there");
    let learnt: BTreeSet<(&str, u64)> = learnt.all().map(|(variant, seed, _)| (variant, seed)).collect();
    assert!(cases().all().all(|(variant, seed, _)| !learnt.contains(&(variant, seed))));
}

#[test]
fn the_right_cause_is_named_first_nine_times_in_ten_and_among_three_nearly_always() {
    let confusion = confusion(ObservationVector::clone);
    let [wrong, first, named] = confusion.wrong();
    assert!(wrong >= 70, "{wrong} cases");
    assert!(first as f64 >= 0.9 * wrong as f64, "{first} of {wrong}");
    assert!(named as f64 >= 0.98 * wrong as f64, "{named} of {wrong}");
    let [right, blamed] = confusion.right();
    assert!(right >= 12 && blamed == 0, "{blamed} of {right}");
}

#[test]
fn a_grade_that_stops_after_four_failures_of_each_task_still_names_the_cause_most_often() {
    let rubric = rubric();
    let order: Vec<(String, CheckId)> =
        rubric.checks().map(|(task, spec)| (task.id.clone(), spec.id())).collect();
    let [wrong, _, named] = confusion(|vector| vector.stopped_after(&order, 4)).wrong();
    assert!(named as f64 >= 0.9 * wrong as f64, "{named} of {wrong}");
}

/// Texts of causes decide nothing. The sentences of `present` cannot: `judge` does not depend on it (`layers.rs`).
#[test]
fn other_words_give_the_same_diagnosis() {
    let file = std::fs::read_to_string(assignment().causes_file()).expect("it is there");
    let mut causes: serde_yaml::Value = serde_yaml::from_str(&file).expect("it is sound");
    let list = causes["causes"].as_sequence_mut().expect("it is a list");
    for (index, cause) in list.iter_mut().enumerate() {
        cause["title"] = format!("Title {index}").into();
        cause["hint"] = format!("Hint {index}").into();
    }
    let folder = tempfile::tempdir().expect("there is space");
    let other = AssignmentFolder::new(folder.path());
    let text = serde_yaml::to_string(&causes).expect("it is YAML");
    std::fs::write(other.causes_file(), text).expect("there is space");
    std::fs::copy(assignment().signatures_file(), other.signatures_file()).expect("there is space");

    let (before, after) =
        (catalogue(), Catalogue::load(&other, &rubric()).expect("causes and signatures fit"));
    let hint = |catalogue: &Catalogue| catalogue.causes()[0].hint.clone();
    assert_ne!(hint(&before), hint(&after));
    for (variant, seed, vector) in cases().all().step_by(5) {
        assert_eq!(before.names(vector), after.names(vector), "{variant}, seed {seed}");
    }
}

#[test]
fn observations_that_fit_nothing_are_unknown() {
    // Every check is wrong, in turns too bright and too dark.
    let seen = |(index, check): (usize, CheckId)| {
        let mean = if index % 2 == 0 { 1.3f64 } else { 0.6 };
        let numbers = [(Quantity::Mean, Number(mean.ln(), 0.01))].into();
        (check, CheckObservations { state: CheckState::Wrong, numbers })
    };
    let checks = rubric().checks().map(|(_, spec)| spec.id()).collect::<Vec<_>>();
    let vector = ObservationVector(checks.into_iter().enumerate().map(seen).collect());
    assert_eq!(catalogue().names(&vector), [UNKNOWN]);
}

#[test]
fn a_submission_that_passes_all_checks_has_no_cause() {
    let right = CheckObservations { state: CheckState::Pass, numbers: Default::default() };
    let vector = ObservationVector(rubric().checks().map(|(_, spec)| (spec.id(), right.clone())).collect());
    assert!(catalogue().names(&vector).is_empty());
}

#[test]
fn the_confusion_matrix_is_up_to_date() {
    let path = assignment().confusion_table();
    let table = std::fs::read_to_string(&path).expect("it is there").replace("\r\n", "\n");
    let [wrong, first, named] = confusion(ObservationVector::clone).wrong();
    for line in [
        format!("- right cause first: {first} of {wrong} "),
        format!("- right cause among the first three: {named} of {wrong} "),
    ] {
        assert!(table.contains(&line), "outdated, run `cargo lab signatures`: {line}");
    }
}

/// These programs share no code with the solution; the wrong factor is measured all the same.
#[test]
fn the_wrong_factor_is_stated_first_in_programs_of_another_style() {
    let options = Options {
        assignment: "05-nee-mis".into(),
        seed: 3,
        threads: 2,
        only: Vec::new(),
        limits: Limits::default(),
    };
    let grader = Grader::new(&workspace(), &options).expect("the harness works");
    for (style, from, to, fact) in [
        (
            "recursive",
            "let geometry = hit.cos(wi) * sample.cos_light / (d * d);",
            "let geometry = sample.cos_light / (d * d);",
            "light-sample/shading-cosine/nee/1",
        ),
        (
            "separate-mis-ray",
            "let weight = sample.pdf / (sample.pdf + pdf);",
            "let weight = 1.0 + 0.0 * pdf;",
            "hit-weight/rise/mis/1",
        ),
    ] {
        let source = all().into_iter().find(|variant| variant.id == style).expect(style).source;
        assert_eq!(source.matches(from).count(), 1, "{style}");
        let submission = Submission { path: format!("{style}.rs").into(), source: source.replace(from, to) };
        let report = grader.grade(&submission, |_| {}).expect("the harness works");
        let first = report.diagnosis.first().map(|diagnosis| &diagnosis.cause);
        let Some(Cause::FailedFact(first)) = first else { panic!("{style}: {first:?}") };
        assert_eq!(first.id(), fact, "{style}");
    }
}

/// Also with `--only`, which leaves little to compare.
#[test]
fn an_untouched_starting_file_is_recognised() {
    let workspace = workspace();
    let source = std::fs::read_to_string(assignment().starter_file()).expect("it is there");
    let submission = Submission { path: "render_pt.rs".into(), source };
    let options = Options {
        assignment: "05-nee-mis".into(),
        seed: 1,
        threads: 2,
        only: vec!["light-pick".to_owned()],
        limits: Limits::default(),
    };
    let report = Grader::new(&workspace, &options)
        .and_then(|grader| grader.grade(&submission, |_| {}))
        .expect("the harness works");
    let [only] = &report.diagnosis[..] else { panic!("{:?}", report.diagnosis) };
    assert!(matches!(only.cause, Cause::NotBegun { .. }), "{only:?}");
}
