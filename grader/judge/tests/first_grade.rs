//! Whole grades of submissions that are right, wrong and broken.
//!
//! A correct submission fails a check about once in a million grades (see `statistics::sequential`), and seeds are
//! fixed, so that these tests are repeatable.

use std::path::PathBuf;

use harness::assignment::Assignment;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::grade::{Options, grade};
use verdict::check::{CheckKind, CheckResult, Fault, Reason, Verdict};
use verdict::report::Report;
use verdict::submission::Submission;

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment() -> Assignment {
    Assignment::open(&workspace(), "05-nee-mis").expect("it is sound")
}

fn solution() -> String {
    assignment().solution().expect("the solution is there")
}

fn grade_source(source: &str, only: &[&str]) -> Report {
    let submission = Submission { path: PathBuf::from("render_pt.rs"), source: source.to_owned() };
    let options = Options {
        assignment: "05-nee-mis".to_owned(),
        seed: 1,
        threads: 2,
        only: only.iter().map(|&name| name.to_owned()).collect(),
        limits: Limits::default(),
    };
    grade(&workspace(), &submission, &options, |_| {}).expect("the harness works")
}

/// The solution with one text replaced, which must occur exactly once.
fn solution_with(from: &str, to: &str) -> String {
    let solution = solution();
    assert_eq!(solution.matches(from).count(), 1, "{from}");
    solution.replace(from, to)
}

/// The points of a task; `None` if a tutor grades it.
fn points(report: &Report, task: &str) -> Option<f64> {
    report.tasks.iter().find(|result| result.id == task).expect("the task is on the sheet").points
}

#[test]
fn the_untouched_starting_file_earns_nothing_because_of_what_it_renders() {
    let starter = std::fs::read_to_string(workspace().assignment("05-nee-mis").starter_file())
        .expect("the starting file is there");
    let report = grade_source(&starter, &[]);
    assert_eq!(report.points.earned, 0.0, "{:#?}", report.tasks);
    assert_eq!(report.points.automatic_max, 70.0);
    assert!(report.submission.build_failure.is_none(), "it compiles");
    // Its pictures lack all light that BSDF sampling cannot find. A black picture has no noise that could be too much.
    let is_about_light = |check: &&CheckResult| check.required && check.id.kind != CheckKind::Efficiency;
    for required in report.checks.iter().filter(is_about_light) {
        assert_eq!(required.verdict, Verdict::Fail, "{}", required.id);
        assert!(matches!(required.reason, Reason::Bias | Reason::Weights), "{required:#?}");
    }
    let mut of_point_plane = report.checks.iter().filter(|check| check.id.scene == "point_plane");
    let black = of_point_plane.next().and_then(|check| check.mean_test());
    assert_eq!(black.and_then(|test| test.effect), Some(-1.0));
}

#[test]
fn the_solution_earns_all_automatic_points() {
    let report = grade_source(&solution(), &[]);
    let failed: Vec<_> = report.checks.iter().filter(|check| check.verdict != Verdict::Pass).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(report.points.earned, 70.0);
    assert_eq!(points(&report, "5.2a"), None, "a tutor grades that");
    assert!(report.numerics.is_clean());
}

#[test]
fn without_the_cosine_at_the_receiver_all_automatic_points_are_lost() {
    let report = grade_source(&solution_with("hit.cos(wi) * weight / p_ne", "weight / p_ne"), &[]);
    assert_eq!(report.points.earned, 0.0, "{:#?}", report.tasks);
    let bright =
        report.checks.iter().find(|check| check.id.to_string() == "mean-bias/cornell_box_point/nee/1");
    assert!(
        bright.and_then(|check| check.mean_test()?.effect).is_some_and(|effect| effect > 0.1),
        "{bright:#?}"
    );
}

#[test]
fn a_mistake_in_mis_alone_costs_only_the_points_of_mis() {
    let report = grade_source(&solution_with("balance(p_brdf, p_ne)", "1.0"), &[]);
    assert_eq!(points(&report, "5.1a"), Some(20.0));
    assert_eq!(points(&report, "5.1b"), Some(20.0));
    assert!(points(&report, "5.2b").is_some_and(|points| points < 10.0), "{:#?}", report.tasks);
}

#[test]
fn a_submission_that_does_not_compile_gets_rustcs_messages_with_its_own_line_numbers() {
    let report = grade_source(&solution_with("let bsdf = hit.bsdf();", "let bsdf = hit.bsdv();"), &[]);
    let failure = report.submission.build_failure.as_ref().expect("it does not compile");
    let line =
        solution().lines().position(|line| line.contains("let bsdf = hit.bsdf();")).expect("it is there") + 1;
    assert_eq!(failure.line, Some(line as u32));
    assert!(failure.messages.contains(&format!("render_pt.rs:{line}")), "{}", failure.messages);
    assert!(failure.messages.contains("bsdv"), "{}", failure.messages);
    assert_eq!(report.points.earned, 0.0);
    assert!(report.checks.is_empty());
    assert!(report.tasks.iter().filter(|task| task.id != "5.2a").all(|task| task.points == Some(0.0)));
}

#[test]
fn unsafe_code_does_not_compile() {
    let report = grade_source(&format!("{}\nfn f() {{ unsafe {{}} }}\n", solution()), &["point_plane"]);
    let failure = report.submission.build_failure.expect("it is refused");
    assert!(failure.messages.contains("unsafe"), "{}", failure.messages);
}

/// The check that the following tests run.
const ONE: &str = "closed-form/point_grid/nee/1";

/// The solution with a statement at the start of every path.
fn with_statement(statement: &str) -> String {
    let first = "let mut radiance = Rgb::BLACK;";
    solution_with(first, &format!("{statement}\n        {first}"))
}

#[test]
fn a_panic_fails_the_check_with_its_message() {
    let report =
        grade_source(&with_statement(r#"assert!(sampler.next_1d() < 0.99, "out of luck");"#), &[ONE]);
    let check = &report.checks[0];
    assert_eq!((&check.verdict, check.reason), (&Verdict::Fail, Reason::Crash));
    assert!(matches!(&check.fault, Some(Fault::Panic(words)) if words.contains("out of luck")), "{check:#?}");
}

#[test]
fn the_end_of_the_process_fails_the_check() {
    for statement in [
        "std::process::exit(0);",
        "std::process::abort();",
        "fn f(n: u64) -> u64 { if n == 0 { 0 } else { std::hint::black_box(f(n - 1)) + 1 } } std::hint::black_box(f(u64::MAX));",
    ] {
        let report = grade_source(&with_statement(statement), &[ONE]);
        let check = &report.checks[0];
        assert_eq!(
            (&check.verdict, check.reason),
            (&Verdict::Fail, Reason::Crash),
            "{statement}: {check:#?}"
        );
    }
}

#[test]
fn samples_that_are_nan_are_reported_with_a_replay() {
    let report =
        grade_source(&with_statement("if sampler.next_1d() < 0.001 { return Rgb::gray(f32::NAN); }"), &[ONE]);
    let check = &report.checks[0];
    assert_eq!((&check.verdict, check.reason), (&Verdict::Fail, Reason::Numerics));
    let first = check.numerics.first.as_ref();
    assert!(check.numerics.non_finite > 0 && first.is_some_and(|it| it.replay.is_some()), "{check:#?}");
}

#[test]
fn output_of_a_submission_does_not_disturb_its_grade() {
    let source = with_statement(
        r#"println!("points: 80"); eprintln!("debug"); let mut line = String::new(); let _ = std::io::stdin().read_line(&mut line);"#,
    );
    let report = grade_source(&source, &[ONE]);
    assert_eq!(report.checks[0].verdict, Verdict::Pass, "{:#?}", report.checks[0]);
}

#[test]
fn the_same_seed_gives_the_same_verdicts() {
    let strip = |mut report: Report| {
        report.cost = Default::default();
        report.checks.iter_mut().for_each(|check| check.seconds = 0.0);
        report
    };
    assert_eq!(strip(grade_source(&solution(), &[ONE])), strip(grade_source(&solution(), &[ONE])));
}
