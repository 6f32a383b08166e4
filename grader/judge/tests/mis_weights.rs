//! The check of single weights, on files that are right, wrong, and right in another style.
//!
//! A submission that decides nothing by chance at its first vertices gives exact weights, so nothing here is left to luck.

use std::path::PathBuf;

use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::{Options, grade};
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::submission::Submission;

/// The solution with pieces of text replaced, each of which must be there exactly once; and what the check says of it.
fn check(changes: &[(&str, &str)]) -> CheckResult {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    let mut source = std::fs::read_to_string(workspace.solution_file()).expect("the solution is there");
    for (from, to) in changes {
        assert_eq!(source.matches(from).count(), 1, "{from}");
        source = source.replace(from, to);
    }
    let submission = Submission { path: PathBuf::from("render_pt.rs"), source };
    let options = Options {
        assignment: "05-nee-mis".to_owned(),
        seed: 1,
        threads: 1,
        only: vec!["mis-weights".to_owned()],
        limits: Limits::default(),
    };
    let report = grade(&workspace, &submission, &options, |_| {}).expect("the harness works");
    assert!(report.submission.build_failure.is_none(), "{:?}", report.submission.build_failure);
    report.checks.into_iter().next().expect("the check was run")
}

fn passes(changes: &[(&str, &str)], words: &str) {
    let result = check(changes);
    assert_eq!(result.verdict, Verdict::Pass, "{result:#?}");
    assert!(result.explanation.contains(words), "{}", result.explanation);
}

fn fails(changes: &[(&str, &str)], words: &[&str]) {
    let result = check(changes);
    assert_eq!((result.verdict, result.reason), (Verdict::Fail, Reason::Weights), "{result:#?}");
    for words in words {
        assert!(result.explanation.contains(words), "{words}: {}", result.explanation);
    }
}

const BALANCE: &str = "1.0 / (1.0 + q / p)";
/// The density of light samples, as the two places of the solution work it out.
const SAMPLED: &str = "Technique::Mis if light.has_area() => balance(p_ne, bsdf.pdf(wi))";
const HIT: &str = "balance(p_brdf, p_ne)";

#[test]
fn the_solution_has_the_weights_of_the_balance_heuristic() {
    passes(&[], "balance heuristic");
}

#[test]
fn the_power_heuristic_passes_with_a_remark() {
    passes(&[(BALANCE, "1.0 / (1.0 + (q / p) * (q / p))")], "power heuristic (exponent 2)");
}

#[test]
fn swapped_and_constant_weights_are_named() {
    fails(&[(BALANCE, "1.0 / (1.0 + p / q)")], &["in both weights", "swapped"]);
    fails(&[(BALANCE, "{ let _ = (p, q); 0.5 }")], &["constant (0.50", "0.50 for BSDF samples)"]);
}

#[test]
fn densities_per_area_are_named() {
    let sampled = (
        SAMPLED,
        "Technique::Mis if light.has_area() => balance(p_light(scene) * sample.pdf_area, bsdf.pdf(wi))",
    );
    let hit = (HIT, "balance(p_brdf, p_light(scene) * emission.pdf_area)");
    fails(
        &[sampled, hit],
        &["in both weights", "per area, not per solid angle: exponent -2 on the distance"],
    );
    fails(&[sampled], &["sum to", "in the weight of light samples", "per area"]);
}

#[test]
fn a_forgotten_pick_probability_is_named() {
    let hit = (HIT, "balance(p_brdf, p_ne * scene.lights().len() as f32)");
    fails(
        &[hit],
        &["sum to", "in the weight of BSDF samples", "probability of picking the light is missing"],
    );
}

#[test]
fn a_shadow_ray_that_is_an_ordinary_ray_passes() {
    let change = (
        "scene.occluded(hit, sample.point)",
        "scene.intersect(&hit.spawn(wi)).is_some_and(|other| direction_and_distance(hit.point, other.point).1 < 0.999 * distance)",
    );
    passes(&[change], "balance heuristic");
}
