//! The check `stability` and the replay of single paths, on submissions that are right, wrong, and right within the
//! graded range.
//!
//! In scaled scenes, a correct submission reproduces the picture to the last bit. Each mean in an extreme scene raises
//! a false alarm less than once in ten million runs, and seeds are fixed, so that these tests are repeatable.

use std::path::PathBuf;

use arty::integrator::Technique;
use arty::sampler::batch_seed;
use harness::assignment::Assignment;
use harness::build::{SubmissionProgram, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::{Options, grade};
use judge::replay::{follow, load, vertices};
use verdict::check::{
    CheckResult, Deviation, Evidence, NumericalCause, Place, Reason, StabilityFinding, Verdict,
};
use verdict::replay::ReplayTarget;
use verdict::rubric::EmissionOnHit;
use verdict::submission::Submission;

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment() -> Assignment {
    Assignment::open(&workspace(), "05-nee-mis").expect("it is sound")
}

/// The solution with texts replaced, each of which must occur exactly once.
fn source(changes: &[(&str, &str)]) -> String {
    let mut source = assignment().solution().expect("the solution is there");
    for (from, to) in changes {
        assert_eq!(source.matches(from).count(), 1, "{from}");
        source = source.replace(from, to);
    }
    source
}

/// Results of the check on the changed solution, with `nee` and with `mis`.
fn check(changes: &[(&str, &str)]) -> Vec<CheckResult> {
    let submission =
        Submission { path: PathBuf::from("my submission/render_pt.rs"), source: source(changes) };
    let options = Options {
        assignment: "05-nee-mis".to_owned(),
        seed: 1,
        threads: 2,
        only: vec!["stability".to_owned()],
        limits: Limits::default(),
    };
    let report = grade(&workspace(), &submission, &options, |_| {}).expect("the harness works");
    assert!(report.submission.build_failure.is_none(), "{:?}", report.submission.build_failure);
    assert_eq!(report.checks.len(), 2);
    report.checks
}

fn findings(result: &CheckResult) -> &[StabilityFinding] {
    let Some(Evidence::Stability(test)) = &result.evidence else { panic!("{result:#?}") };
    &test.findings
}

/// Asserts that the check fails with a graded finding at this place, with this cause, that can be replayed.
fn fails(changes: &[(&str, &str)], reason: Reason, place: &Place, is_cause: fn(&NumericalCause) -> bool) {
    for result in check(changes) {
        assert_eq!((&result.verdict, result.reason), (&Verdict::Fail, reason), "{result:#?}");
        let found = findings(&result).iter().filter(|finding| finding.is_graded);
        let mut there = found.filter(|finding| finding.place == *place && is_cause(&finding.likely_cause));
        let first = there.next().and_then(|finding| finding.first.as_ref());
        assert!(first.is_some_and(|first| first.replay.is_some()), "{result:#?}");
    }
}

const SHADOW_RAY: &str = "scene.occluded(hit, sample.point)";
const BALANCE: &str = "1.0 / (1.0 + q / p)";
const CONTRIBUTION: &str = "(hit.cos(wi) * weight / p_ne)";
const RESULT: &str = "        radiance\n    }";

#[test]
fn the_solution_is_right_unless_both_densities_are_infinite() {
    for result in check(&[]) {
        assert_eq!(result.verdict, Verdict::Pass, "{result:#?}");
        assert!(result.numerics.is_clean());
        // The framework never returns such densities.
        let infinite = f64::INFINITY.into();
        let expected = Place::Densities { light: infinite, bsdf: infinite };
        let found = findings(&result);
        assert!(found.iter().all(|finding| finding.place == expected && !finding.is_graded), "{found:#?}");
        assert_eq!(found.len(), usize::from(result.id.technique == Technique::Mis));
    }
}

#[test]
fn a_fixed_epsilon_fails_whether_large_or_small() {
    let large = "scene.intersect(&Ray::new(hit.point + wi * 1e-3, wi)).is_some_and(|other| \
                 other.point.distance(hit.point) < distance - 1e-3)";
    fails(&[(SHADOW_RAY, large)], Reason::Bias, &Place::Scaled(-10), |cause| {
        matches!(cause, NumericalCause::FixedEpsilon { is_large: true, .. })
    });
    let small = "scene.intersect(&Ray::new(hit.point + hit.geometric_normal * 1e-6, wi)).is_some_and(|other| \
                 other.point.distance(hit.point) < 0.999 * distance)";
    fails(&[(SHADOW_RAY, small)], Reason::Bias, &Place::Scaled(10), |cause| {
        matches!(cause, NumericalCause::FixedEpsilon { is_large: false, .. })
    });
}

#[test]
fn clamped_radiance_fails_with_its_limit() {
    let limited = "        radiance.map(|channel| channel.min(100.0))\n    }";
    fails(
        &[(RESULT, limited)],
        Reason::Bias,
        &Place::Brightened(10),
        |cause| matches!(cause, NumericalCause::ClampedRadiance { limit, .. } if limit.0 == 100.0),
    );
}

#[test]
fn nan_fails_even_if_it_is_replaced_by_zero() {
    let along_normal = Place::ExtremeScene("light_along_normal".to_owned());
    let open = "(hit.normal.dot(wi).acos().cos() * weight / p_ne)";
    fails(&[(CONTRIBUTION, open)], Reason::Numerics, &along_normal, |cause| {
        *cause == NumericalCause::InvalidOperation
    });
    let hidden = "(hit.normal.dot(wi).acos().cos().max(0.0) * weight / p_ne)";
    fails(&[(CONTRIBUTION, hidden)], Reason::Bias, &along_normal, |cause| {
        *cause == NumericalCause::HiddenNanOrOffset
    });
}

#[test]
fn naive_weights_pass_with_a_remark_on_densities_where_they_fail() {
    let causes: [(&str, NumericalCause); 2] = [
        ("p / (p + q)", NumericalCause::InfiniteDensity),
        ("p * p / (p * p + q * q)", NumericalCause::OtherDensityZero),
    ];
    for (naive, cause) in causes {
        let results = check(&[(BALANCE, naive)]);
        assert!(results.iter().all(|result| result.verdict == Verdict::Pass), "{results:#?}");
        let found = findings(&results[1]);
        assert!(
            found.iter().any(|it| {
                it.likely_cause == cause && matches!(it.deviation, Deviation::NoRadiance { .. })
            }),
            "{found:#?}"
        );
    }
}

fn program(changes: &[(&str, &str)]) -> SubmissionProgram {
    let framework = assignment().framework(&workspace()).expect("the framework builds");
    compile(&framework, &source(changes), &Limits::default()).expect("rustc runs").expect("it compiles")
}

fn target(technique: Technique, sample: u64) -> ReplayTarget {
    ReplayTarget {
        scene: ReplayTarget::ROOM.to_owned(),
        scale: 1.0,
        emission: 1.0,
        technique,
        // Before Russian roulette begins, which is not recorded.
        max_bounces: 3,
        emission_on_hit: EmissionOnHit::On,
        size: [16, 16],
        seed: batch_seed(1, 2),
        pixel: [7, 9],
        sample,
    }
}

fn room() -> arty::scene::SceneDescription {
    load(&workspace(), &target(Technique::Nee, 0)).expect("it is there")
}

#[test]
fn contributions_of_a_replayed_paths_vertices_sum_to_its_radiance() {
    let (program, room) = (program(&[]), room());
    let mut bright = 0;
    for technique in Technique::ALL {
        for sample in 0..40 {
            let path = follow(&program, &target(technique, sample), &room).expect("the solution answers");
            let sum: f64 = vertices(&path, technique, &room)
                .iter()
                .flat_map(|vertex| [&vertex.hit, &vertex.light_sample])
                .flatten()
                .map(|light| light.contribution)
                .sum();
            let radiance = f64::from(path.radiance[1]);
            assert!((sum - radiance).abs() <= 1e-4 * radiance, "{technique}, {sample}: {sum} and {radiance}");
            bright += u32::from(radiance > 0.0);
            assert_eq!(path.left_out, 0);
        }
    }
    assert!(bright > 40, "{bright} of 120 paths found light");
}

#[test]
fn a_replay_records_every_call_and_serialises_nan() {
    let nan = [(CONTRIBUTION, "(hit.cos(wi) * f32::NAN / p_ne)")];
    let (program, room) = (program(&nan), room());
    let path = follow(&program, &target(Technique::Nee, 0), &room).expect("it answers");
    let calls: Vec<&str> = path.calls.iter().map(|call| call.function.as_str()).collect();
    assert_eq!(calls[..3], ["Scene::intersect", "Sampler::next_1d", "Light::sample_direct"], "{calls:?}");
    assert!(calls.contains(&"Bsdf::sample"), "{calls:?}");
    let lit =
        (0..40).map(|sample| follow(&program, &target(Technique::Nee, sample), &room).expect("it answers"));
    let path = lit.into_iter().find(|path| path.radiance[1].is_nan()).expect("some path is lit");
    let json = serde_json::to_value(&path).expect("it can be written");
    assert_eq!(json["radiance"][1], "NaN");
    assert_eq!(json["calls"][0]["got"][3]["name"], "material", "{json:#}");
    assert_eq!(json["calls"][0]["got"][3]["word"], "grey");
}

#[test]
fn an_unknown_scene_is_an_error_about_the_option() {
    for name in ["nothing", "../scenes/mesh"] {
        let target = ReplayTarget { scene: name.to_owned(), ..target(Technique::Nee, 0) };
        let error = load(&workspace(), &target).expect_err("there is none");
        assert!(error.to_string().starts_with("--scene: "), "{error}");
    }
}
