//! Error against run time, of whole programs.
//!
//! Times differ from run to run, and with them the numbers of samples; what is asked for here holds with wide margins.

use arty::integrator::Technique;
use harness::assignment::Assignment;
use harness::build::{SubmissionProgram, compile};
use harness::workspace::Workspace;
use judge::convergence::{MeasuredProgram, Options, brief, crops, measure};
use present::convergence::{Axis, save_csv, svg};
use verdict::convergence::{Bias, Convergence, Curve, Role};

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment() -> Assignment {
    Assignment::open(&workspace(), "05-nee-mis").expect("it is sound")
}

fn solution() -> String {
    assignment().solution().expect("the solution is there")
}

fn program(source: &str) -> SubmissionProgram {
    let framework = assignment().framework(&workspace()).expect("the framework builds");
    compile(&framework, source, &harness::sandbox::Limits::default())
        .expect("the harness works")
        .expect("it compiles")
}

fn measured(submission: &str) -> Convergence {
    let (submission, solution) = (program(submission), program(&solution()));
    let named = |name: &str, role, program| MeasuredProgram { name: name.to_owned(), role, program };
    let programs = [
        named("submission", Role::Submission, &submission),
        named("solution", Role::Solution, &solution),
        named("BSDF sampling", Role::Baseline, &solution),
    ];
    let options = Options {
        scenes: vec!["cornell_box_glossy".to_owned()],
        techniques: vec![Technique::Mis],
        seconds: 1.5,
        target: None,
        seed: 1,
        threads: 1,
        lengths: 4,
        bias: true,
    };
    measure(&workspace(), &programs, &options, |_| {}).expect("the harness works")
}

fn curve(convergence: &Convergence, role: Role) -> &Curve {
    convergence.panels[0].curves.iter().find(|curve| curve.role == role).expect("there is such a curve")
}

#[test]
fn a_biased_program_flattens_beside_the_solution() {
    let biased = solution().replace("balance(p_brdf, p_ne)", "1.0");
    let convergence = measured(&biased);
    let (submission, right) = (curve(&convergence, Role::Submission), curve(&convergence, Role::Solution));
    // The image is 1.66 times as bright as it should be. The judge's test fails a correct program once in a million times.
    let is_found =
        |curve: &Curve| matches!(curve.bias, Bias::Found { relative_squared } if relative_squared > 0.1);
    assert!(is_found(submission) && matches!(right.bias, Bias::NotFound { .. }), "{convergence:#?}");
    let slope = |curve: &Curve| curve.slope.expect("there are points").value;
    assert!(slope(submission) > slope(right) + 0.2, "{} {}", slope(submission), slope(right));
    assert!(submission.efficiency.expect("there is a solution").value < 0.5);
    assert_eq!(right.efficiency.map(|estimate| estimate.interval), Some([1.0; 2]), "relative to itself");
    assert_eq!(convergence.panels[0].yardstick.as_deref(), Some("solution"));
    assert!(submission.seconds_to_target.is_none() && right.seconds_to_target.is_some());
    for point in &right.points {
        // At least a camera ray, and less than two rays for each of nine vertices.
        let rays = point.rays / (256 * point.samples) as f64;
        assert!((1.0..18.0).contains(&rays), "{point:?}");
    }

    assert!(svg(&convergence, Axis::Seconds).expect("there are curves").contains(", bias "));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("errors.csv");
    save_csv(&convergence, &file).expect("it can be written");
    let text = std::fs::read_to_string(&file).expect("it is there");
    let points: usize = convergence.panels[0].curves.iter().map(|curve| curve.points.len()).sum();
    assert_eq!(text.lines().count(), 1 + points);
    assert!(text.lines().all(|line| line.split(',').count() == 9 + 3 * 4), "{text}");
}

#[test]
fn a_program_that_panics_has_no_curve_and_stops_nobody_else() {
    let panics = solution().replace("balance(p_brdf, p_ne)", "panic!(\"on purpose\")");
    let convergence = measured(&panics);
    assert!(convergence.panels[0].curves.iter().all(|curve| curve.role != Role::Submission));
    assert!(!curve(&convergence, Role::Solution).points.is_empty());
    let why = &convergence.left_out.first().expect("it is named").why;
    assert!(why.contains("on purpose"), "{why}");
}

#[test]
fn without_a_solution_the_comparison_is_left_out_with_the_reason() {
    let convergence =
        brief(&workspace(), &assignment().rubric, &program(&solution()), None, 1).expect("the harness works");
    assert!(convergence.left_out[0].why.contains("does not have the solution"), "{:?}", convergence.left_out);
    for panel in &convergence.panels {
        let roles: Vec<Role> = panel.curves.iter().map(|curve| curve.role).collect();
        assert_eq!(roles, [Role::Submission, Role::Baseline]);
        assert!(panel.curves.iter().all(|curve| curve.efficiency.is_none() && !curve.points.is_empty()));
    }
}

#[test]
fn crops_show_each_program_and_the_reference_after_the_same_time() {
    let solution = program(&solution());
    let named = |name: &str, role| MeasuredProgram { name: name.to_owned(), role, program: &solution };
    let programs = [named("solution", Role::Solution), named("BSDF sampling", Role::Baseline)];
    let options = Options {
        scenes: vec!["cornell_box".to_owned()],
        techniques: vec![Technique::Mis],
        seconds: 0.5,
        target: None,
        seed: 1,
        threads: 1,
        lengths: 3,
        bias: false,
    };
    let convergence = measure(&workspace(), &programs, &options, |_| {}).expect("the harness works");
    let crops = crops(&workspace(), &programs, &convergence).expect("the harness works");
    let names: Vec<&str> = crops[0].list.iter().map(|crop| crop.name.as_str()).collect();
    assert_eq!(names, ["solution", "BSDF sampling", "reference"]);
    let error = |index: usize| crops[0].list[index].relative_mse.expect("it is known");
    // It is about twenty times as large.
    assert!(error(1) > 3.0 * error(0), "{} {}", error(0), error(1));
    let sizes = crops[0].list.iter().map(|crop| crop.width);
    assert_eq!(sizes.collect::<Vec<_>>(), [48, 48, 48]);
}
