//! The check of stability and the replay of single paths, on files that are right, wrong, and right within the range that
//! counts.
//!
//! Scaled scenes give a correct submission the same numbers to the last bit, so that nothing there is left to luck; each of the
//! means in extreme scenes raises a false alarm less than once in ten million runs, and seeds are fixed.

use std::path::PathBuf;

use arty::integrator::Technique;
use arty::sampler::batch_seed;
use harness::build::{Framework, SubmissionProgram, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use host::protocol::Switches;
use judge::grade::{Options, grade};
use judge::replay::{Place, follow, vertices};
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::submission::Submission;

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

/// The solution with pieces of text replaced, each of which must be there exactly once.
fn source(changes: &[(&str, &str)]) -> String {
    let mut source = std::fs::read_to_string(workspace().solution_file()).expect("the solution is there");
    for (from, to) in changes {
        assert_eq!(source.matches(from).count(), 1, "{from}");
        source = source.replace(from, to);
    }
    source
}

/// What the check says of it with `nee` and with `mis`.
fn check(changes: &[(&str, &str)]) -> Vec<CheckResult> {
    let submission = Submission { path: PathBuf::from("hand in/render_pt.rs"), source: source(changes) };
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

fn fails(changes: &[(&str, &str)], reason: Reason, words: &[&str]) {
    for result in check(changes) {
        assert_eq!((result.verdict, result.reason), (Verdict::Fail, reason), "{result:#?}");
        let said = format!("{}\n{}", result.explanation, result.remarks.join("\n"));
        for words in words {
            assert!(said.contains(words), "{words}: {said}");
        }
        assert!(result.explanation.contains("cargo grader replay 'hand in/render_pt.rs' --scene="), "{said}");
    }
}

const SHADOW_RAY: &str = "scene.occluded(hit, sample.point)";
const BALANCE: &str = "1.0 / (1.0 + q / p)";
const CONTRIBUTION: &str = "(hit.cos(wi) * weight / p_ne)";
const RESULT: &str = "        radiance\n    }";

#[test]
fn the_solution_is_right_but_where_both_densities_are_infinite() {
    for result in check(&[]) {
        assert_eq!(result.verdict, Verdict::Pass, "{result:#?}");
        assert_eq!((result.non_finite, result.negative), (0, 0));
        // The framework never hands out such densities.
        let expected =
            "with densities per solid angle of inf (light) and inf (BSDF): the light sample gives NaN";
        assert!(result.remarks.iter().all(|remark| remark.starts_with(expected)), "{:?}", result.remarks);
        assert_eq!(result.remarks.len(), usize::from(result.technique == Technique::Mis));
    }
}

#[test]
fn an_epsilon_of_its_own_is_found_whether_large_or_small() {
    let large = "scene.intersect(&Ray::new(hit.point + wi * 1e-3, wi)).is_some_and(|other| \
                 other.point.distance(hit.point) < distance - 1e-3)";
    fails(&[(SHADOW_RAY, large)], Reason::Bias, &["2^-10 times as large", "fixed epsilon"]);
    let small = "scene.intersect(&Ray::new(hit.point + hit.geometric_normal * 1e-6, wi)).is_some_and(|other| \
                 other.point.distance(hit.point) < 0.999 * distance)";
    fails(&[(SHADOW_RAY, small)], Reason::Bias, &["2^10 times as large", "fixed epsilon"]);
}

#[test]
fn a_limit_on_radiance_is_found_and_named() {
    let limited = "        radiance.map(|channel| channel.min(100.0))\n    }";
    fails(&[(RESULT, limited)], Reason::Bias, &["2^10 times as bright", "limited to 100"]);
}

#[test]
fn nan_of_its_own_is_found_even_where_it_is_hidden() {
    let open = "(hit.normal.dot(wi).acos().cos() * weight / p_ne)";
    fails(&[(CONTRIBUTION, open)], Reason::Numerics, &["light_along_normal", "NaN", "arc cosine"]);
    let hidden = "(hit.normal.dot(wi).acos().cos().max(0.0) * weight / p_ne)";
    fails(&[(CONTRIBUTION, hidden)], Reason::Bias, &["light_along_normal", "hidden as 0"]);
}

#[test]
fn naive_weights_pass_with_a_remark_on_where_they_break() {
    for (naive, words) in [("p / (p + q)", "∞/∞"), ("p * p / (p * p + q * q)", "0/0")] {
        let results = check(&[(BALANCE, naive)]);
        assert!(results.iter().all(|result| result.verdict == Verdict::Pass), "{results:#?}");
        let remarks = results[1].remarks.join("\n");
        assert!(
            remarks.contains("with densities per solid angle of") && remarks.contains(words),
            "{remarks}"
        );
    }
}

fn program(changes: &[(&str, &str)]) -> SubmissionProgram {
    let framework = Framework::build(&workspace()).expect("the framework builds");
    compile(&framework, &source(changes), &Limits::default()).expect("rustc runs").expect("it compiles")
}

fn place(technique: Technique, sample: u64) -> Place {
    Place {
        scene: Place::ROOM.to_owned(),
        description: Place::load(&workspace(), Place::ROOM, 1.0, 1.0).expect("it is there"),
        scale: 1.0,
        emission: 1.0,
        technique,
        // Before roulette begins, which is not among the calls.
        max_bounces: 3,
        size: [16, 16],
        seed: batch_seed(1, 2),
        pixel: [7, 9],
        sample,
        switches: Switches::default(),
    }
}

#[test]
fn the_vertices_of_a_replayed_path_add_up_to_its_radiance() {
    let program = program(&[]);
    let mut bright = 0;
    for technique in Technique::ALL {
        for sample in 0..40 {
            let place = place(technique, sample);
            let path = follow(&program, &place).expect("the harness works").expect("the solution answers");
            let sum: f64 = vertices(&path, &place)
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
fn a_replay_shows_every_call_and_numbers_that_json_does_not_have() {
    let nan = [(CONTRIBUTION, "(hit.cos(wi) * f32::NAN / p_ne)")];
    let program = program(&nan);
    let path = follow(&program, &place(Technique::Nee, 0)).expect("the harness works").expect("it answers");
    let calls: Vec<&str> = path.calls.iter().map(|call| call.function.as_str()).collect();
    assert_eq!(calls[..3], ["Scene::intersect", "Sampler::next_1d", "Light::sample_direct"], "{calls:?}");
    assert!(calls.contains(&"Bsdf::sample"), "{calls:?}");
    let lit = (0..40).map(|sample| {
        follow(&program, &place(Technique::Nee, sample)).expect("the harness works").expect("it answers")
    });
    let path = lit.into_iter().find(|path| path.radiance[1].is_nan()).expect("some path is lit");
    let json = serde_json::to_value(&path).expect("it can be written");
    assert_eq!(json["radiance"][1], "NaN");
    assert_eq!(json["calls"][0]["got"][3]["name"], "material", "{json:#}");
    assert_eq!(json["calls"][0]["got"][3]["word"], "grey");
}

#[test]
fn a_scene_that_does_not_exist_is_one_clear_error() {
    for name in ["nothing", "../scenes/mesh"] {
        let error = Place::load(&workspace(), name, 1.0, 1.0).expect_err("there is none");
        assert!(error.to_string().starts_with("--scene: "), "{error}");
    }
}
