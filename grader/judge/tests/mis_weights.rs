//! The check `mis-weights`, on submissions that are right, wrong, and right in another style.
//!
//! A submission without random decisions at its first vertices has exact weights, so that these tests are
//! deterministic.

use std::path::PathBuf;

use harness::assignment::Assignment;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::{Options, grade};
use verdict::check::{
    CheckResult, Evidence, MeasuredWeights, OnlyWay, Reason, Verdict, WeightFault, WeightForm,
};
use verdict::submission::Submission;

/// Result of the check on the solution with texts replaced, each of which must occur exactly once.
fn check(changes: &[(&str, &str)]) -> CheckResult {
    let workspace = Workspace::find().expect("the tests run inside the checkout");
    let mut source = Assignment::open(&workspace, "05-nee-mis")
        .and_then(|assignment| assignment.solution())
        .expect("the solution is there");
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

fn measured(result: &CheckResult) -> &MeasuredWeights {
    let Some(Evidence::MisWeights(test)) = &result.evidence else { panic!("{result:#?}") };
    test.measured.as_ref().unwrap_or_else(|| panic!("{result:#?}"))
}

/// Asserts that the check passes and that the odds of both weights have these exponents.
fn passes(changes: &[(&str, &str)], exponents: [i32; WeightForm::FACTORS]) {
    let result = check(changes);
    assert_eq!(result.verdict, Verdict::Pass, "{result:#?}");
    for form in [measured(&result).light, measured(&result).bsdf] {
        assert_eq!(form.whole_exponents(), Some(exponents), "{form:?}");
    }
}

/// Asserts that the check fails at the first vertex, and that w_L and 1 − w_B have these forms.
fn fails(changes: &[(&str, &str)], light: Form, bsdf: Form) {
    let result = check(changes);
    assert_eq!((&result.verdict, result.reason), (&Verdict::Fail, Reason::Weights), "{result:#?}");
    let Some(Evidence::MisWeights(test)) = &result.evidence else { panic!("{result:#?}") };
    assert_eq!(test.fault, Some(WeightFault::FirstVertex));
    for (expected, form) in [(light, measured(&result).light), (bsdf, measured(&result).bsdf)] {
        match (expected, form) {
            (Form::Constant(expected), WeightForm::Constant(value)) => {
                assert!((value - expected).abs() < 1e-3)
            }
            (Form::Exponents(expected), form) => {
                assert_eq!(form.whole_exponents(), Some(expected), "{form:?}")
            }
            (Form::Constant(_), form) => panic!("{form:?}"),
        }
    }
}

#[derive(Clone, Copy)]
enum Form {
    Constant(f64),
    /// Of p_L / p_B, distance, cosine at the light, number of lights, 1 / density per area.
    Exponents([i32; WeightForm::FACTORS]),
}

const RIGHT: [i32; WeightForm::FACTORS] = [1, 0, 0, 0, 0];

const BALANCE: &str = "1.0 / (1.0 + q / p)";
/// The two places of the solution that compute weights.
const SAMPLED: &str = "Technique::Mis if light.has_area() => balance(p_ne, bsdf.pdf(wi))";
const HIT: &str = "balance(p_brdf, p_ne)";

#[test]
fn the_solution_has_the_weights_of_the_balance_heuristic() {
    passes(&[], RIGHT);
}

#[test]
fn the_power_heuristic_passes() {
    passes(&[(BALANCE, "1.0 / (1.0 + (q / p) * (q / p))")], [2, 0, 0, 0, 0]);
}

#[test]
fn swapped_and_constant_weights_fail() {
    let swapped = Form::Exponents([-1, 0, 0, 0, 0]);
    fails(&[(BALANCE, "1.0 / (1.0 + p / q)")], swapped, swapped);
    fails(&[(BALANCE, "{ let _ = (p, q); 0.5 }")], Form::Constant(0.5), Form::Constant(0.5));
}

#[test]
fn densities_per_area_fail() {
    let sampled = (
        SAMPLED,
        "Technique::Mis if light.has_area() => balance(p_light(scene) * sample.pdf_area, bsdf.pdf(wi))",
    );
    let hit = (HIT, "balance(p_brdf, p_light(scene) * emission.pdf_area)");
    let per_area = Form::Exponents([1, -2, 1, 0, 0]);
    fails(&[sampled, hit], per_area, per_area);
    fails(&[sampled], per_area, Form::Exponents(RIGHT));
}

#[test]
fn a_missing_selection_probability_fails() {
    let hit = (HIT, "balance(p_brdf, p_ne * scene.lights().len() as f32)");
    fails(&[hit], Form::Exponents(RIGHT), Form::Exponents([1, 0, 0, 1, 0]));
}

#[test]
fn a_shadow_ray_traced_with_intersect_passes() {
    let change = (
        "scene.occluded(hit, sample.point)",
        "scene.intersect(&hit.spawn(wi)).is_some_and(|other| direction_and_distance(hit.point, other.point).1 < 0.999 * distance)",
    );
    passes(&[change], RIGHT);
}

#[test]
fn guards_against_extreme_densities_pass() {
    passes(&[(BALANCE, "p / (p + q + 1e-5)")], RIGHT);
    let dropped = (
        "let weight = match",
        "if p_ne < 1e-4 {\n            return Rgb::BLACK;\n        }\n        let weight = match",
    );
    passes(&[dropped], RIGHT);
}

#[test]
fn a_density_of_another_direction_or_light_point_fails() {
    let viewer = ("balance(p_ne, bsdf.pdf(wi))", "balance(p_ne, bsdf.pdf(hit.wo))");
    let fresh = (
        HIT,
        "emission.light.sample_direct(point, &mut Sampler::new(1, (0, 0), 0)).map_or(1.0, |other| {\n\
             balance(p_brdf, p_ne / emission.pdf_area * other.pdf_area)\n\
         })",
    );
    for change in [viewer, fresh] {
        let result = check(&[change]);
        let Some(Evidence::MisWeights(test)) = &result.evidence else { panic!("{result:#?}") };
        assert_eq!(test.fault, Some(WeightFault::FirstVertex), "{change:?}");
    }
}

#[test]
fn a_weight_that_stays_in_the_throughput_fails() {
    let change = (
        "radiance += throughput * emission.radiance * weight;",
        "throughput *= weight;\n                radiance += throughput * emission.radiance;",
    );
    let result = check(&[change]);
    let Some(Evidence::MisWeights(test)) = &result.evidence else { panic!("{result:#?}") };
    assert_eq!(test.fault, Some(WeightFault::OnlyWay(OnlyWay::AfterLight)));
}
