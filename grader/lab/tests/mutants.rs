//! The variants of the solution: they are as described, the kill matrix is up to date, and a few of them are graded.
//! Seeds are fixed: each run gives the same verdicts.

use std::collections::BTreeSet;

use harness::assignment::Assignment;
use harness::build::compile;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::{Options, grade};
use lab::mutants::{Kind, Variant, Variants, variants};
use verdict::check::{CheckKind, Verdict};
use verdict::submission::Submission;

/// The numbers of the catalogue of mistakes.
const CATALOGUE: [u32; 47] = [
    1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 29, 30,
    31, 32, 33, 34, 35, 36, 38, 39, 41, 43, 45, 47, 49, 52, 53, 54, 55, 56, 57,
];

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment() -> Assignment {
    Assignment::open(&workspace(), "05-nee-mis").expect("it is sound")
}

fn all() -> Variants {
    variants(&assignment()).expect("each replacement fits the solution, each task the rubric")
}

#[test]
fn every_mistake_of_the_catalogue_has_a_variant_or_is_declared_impossible() {
    let all = all();
    let named: BTreeSet<String> = all
        .list
        .iter()
        .flat_map(|variant| variant.rows.clone())
        .chain(all.not_possible.iter().map(|missing| missing.row.clone()))
        .collect();
    let catalogue: BTreeSet<String> = CATALOGUE.iter().map(u32::to_string).collect();
    assert_eq!(named, catalogue);
}

#[test]
fn there_are_a_dozen_correct_variants_and_no_two_variants_are_equal() {
    let all = all();
    assert!(all.list.iter().filter(|variant| variant.kind == Kind::Right).count() >= 12);
    let sources: BTreeSet<&str> = all.list.iter().map(|variant| variant.source.as_str()).collect();
    assert_eq!(sources.len(), all.list.len());
}

#[test]
fn every_variant_compiles() {
    let framework = assignment().framework(&workspace()).expect("the framework builds");
    for variant in all().list {
        if let Err(failure) = compile(&framework, &variant.source, &Limits::default()).expect("rustc runs") {
            panic!("{}:\n{}", variant.id, failure.messages);
        }
    }
}

#[test]
fn the_kill_matrix_lists_all_variants() {
    let path = assignment().folder.kill_matrix();
    let table = std::fs::read_to_string(&path).expect("the table is there");
    let listed: Vec<&str> = table
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split_once('`'))
        .map(|(id, _)| id)
        .collect();
    let variants = all().list;
    let there: Vec<&str> = variants.iter().map(|variant| variant.id.as_str()).collect();
    assert_eq!(listed, there, "outdated: run `cargo lab mutants`");
}

fn verdict(variant: &Variant, check: &str) -> Verdict {
    let submission = Submission { path: format!("{}.rs", variant.id).into(), source: variant.source.clone() };
    let options = Options {
        assignment: "05-nee-mis".into(),
        seed: 1,
        threads: 2,
        only: vec![check.to_owned()],
        limits: Limits::default(),
    };
    let report = grade(&workspace(), &submission, &options, |_| {}).expect("the harness works");
    assert_eq!(report.checks.len(), 1, "{check}");
    report.checks[0].verdict.clone()
}

/// Each kind of check fails on a mistake that it is for, and passes correct programs.
#[test]
fn every_kind_of_check_fails_on_a_mistake_and_passes_correct_programs() {
    let variants = all().list;
    let mut judged = BTreeSet::new();
    for (check, wrong) in [
        ("closed-form/point_grid/nee/1", "receiver-cosine-missing"),
        ("closed-form/point_plane/mis/1", "times-pi"),
        ("closed-form/polygon_plane/nee/1", "light-cosine-missing"),
        ("efficiency/cornell_box/nee/1", "nee-for-point-lights-only"),
        ("efficiency/cornell_box/mis/1", "mis-is-bsdf-sampling"),
        ("efficiency/glossy_plane/mis/1", "mis-is-nee"),
        ("facts/scripted/nee/3", "light-asked-only-if-the-path-goes-on"),
        ("hidden-variants/scripted/mis/6", "pick-probability-missing"),
        ("light-pick/scripted/nee/1", "skewed-pick"),
        ("mean-bias/cornell_box_point/nee/1", "receiver-cosine-missing"),
        ("metamorphic/light_behind_wall/nee/8", "samples-clamped-at-ten"),
        ("mis-weights/scripted/mis/3", "mis-weights-swapped"),
        ("path-length/scripted/nee/16", "own-limit-of-ten"),
        ("randomness/cornell_box/nee/8", "same-numbers-for-neighbours"),
        ("ray-budget/scripted/nee/3", "all-lights-with-a-shadow-ray-each"),
        ("stability/scripted/mis/3", "samples-clamped-at-ten"),
        ("varied-scene/cornell_box_point/nee/1", "receiver-cosine-missing"),
        ("varied-scene/light_behind_wall/nee/8", "nee-adds-every-hit"),
        ("white-furnace/furnace_diffuse/mis/3", "mis-hit-unweighted"),
        ("white-furnace/furnace_mirror/nee/4", "nee-mirrored-light-missing"),
    ] {
        judged.insert(check.split('/').next().unwrap_or_default());
        for (id, expected) in
            [(wrong, Verdict::Fail), ("recursive", Verdict::Pass), ("separate-mis-ray", Verdict::Pass)]
        {
            let variant = variants.iter().find(|variant| variant.id == id).expect(id);
            assert_eq!(verdict(variant, check), expected, "{id}, {check}");
        }
    }
    // Its own tests show how `sampling` fails: no submission of this assignment has a sampler.
    let kinds = CheckKind::ALL.into_iter().filter(|&kind| kind != CheckKind::Sampling);
    let kinds: BTreeSet<&str> = kinds.map(CheckKind::name).collect();
    assert_eq!(judged, kinds, "a kind of check that is never seen to fail");
}
