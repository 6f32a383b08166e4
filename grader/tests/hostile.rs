//! Submissions that attack: what becomes of each, and that nobody else is harmed.
#![cfg(target_os = "linux")]

use std::path::PathBuf;
use std::time::{Duration, Instant};

use arty::integrator::{Settings, Technique};
use arty::scene::SceneDescription;
use harness::assignment::Assignment;
use harness::build::{SubmissionProgram, compile};
use harness::host_process::HostProcess;
use harness::sandbox::{Level, Limits, Machine};
use harness::workspace::Workspace;
use host::protocol::RenderJob;
use judge::grade::{Options, grade};
use present::words;
use serde::Deserialize;
use verdict::check::{CheckResult, Reason, Verdict};
use verdict::report::Report;
use verdict::submission::Submission;

/// The index of the corpus.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Index {
    submissions: Vec<Attack>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Attack {
    file: String,
    threat: String,
    /// Kind of the check that it is held to, if not the usual one.
    check: Option<String>,
    outcome: Outcome,
    #[serde(default)]
    says: String,
}

/// What must become of a submission; the index says what each means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Outcome {
    Build,
    Black,
    Wrong,
    Crash,
    Timeout,
    Numerics,
    Violation,
    Efficiency,
    Rays,
    Any,
}

/// The one check that all of them are held to.
const CHECK: &str = "mean-bias/point_plane/mis/1";

/// The rubric that has it, as a folder below `assignments/`.
const ASSIGNMENT: &str = "../grader/hostile";

/// Short, so that those that never end do so soon.
fn limits() -> Limits {
    Limits {
        compile_time: Duration::from_secs(8),
        compile_memory: 2 << 30,
        job_time: Duration::from_secs(5),
        waiting: Duration::from_secs(4),
        job_memory: 512 << 20,
        ..Limits::default()
    }
}

fn workspace() -> Workspace {
    Workspace::find().expect("the tests run inside the checkout")
}

fn assignment(workspace: &Workspace) -> Assignment {
    Assignment::open(workspace, ASSIGNMENT).expect("its rubric is sound")
}

fn solution(workspace: &Workspace) -> Submission {
    Submission::load_trusted(&assignment(workspace).solution_file()).expect("the solution is there")
}

fn grade_source(workspace: &Workspace, source: String, check: &str) -> Report {
    let submission = Submission { path: PathBuf::from("render_pt.rs"), source };
    let options = Options {
        assignment: ASSIGNMENT.to_owned(),
        seed: 1,
        threads: 2,
        only: vec![check.to_owned()],
        limits: limits(),
    };
    grade(workspace, &submission, &options, |_| {}).expect("no submission makes the harness fail")
}

/// A submission that everybody can rely on.
struct Honest {
    program: SubmissionProgram,
    scene: SceneDescription,
}

impl Honest {
    fn new(workspace: &Workspace) -> Self {
        let assignment = assignment(workspace);
        let framework = assignment.framework(workspace).expect("the framework builds");
        let source = assignment.solution().expect("the solution is there");
        let limits = Limits { job_time: Duration::from_secs(30), ..Limits::default() };
        let program =
            compile(&framework, &source, &limits).expect("rustc runs").expect("the solution compiles");
        let scene = arty::scene::file::load(&workspace.scene_file("point_plane")).expect("it is there");
        Self { program, scene: scene.description }
    }

    /// What it renders, to the bit.
    fn renders(&self) -> Vec<Vec<[f32; 3]>> {
        let mut process = HostProcess::start(&self.program, 2).expect("the program starts");
        let scene = process.load(&self.scene).expect("the scene loads");
        let job = RenderJob {
            scene,
            settings: Settings { technique: Technique::Nee, max_bounces: 1 },
            width: 16,
            height: 16,
            seeds: vec![1, 2, 3],
            first_sample: 0,
            samples: 16,
        };
        process.render(&job).expect("it renders").batches
    }
}

/// What is wrong with a report on this attack.
fn complaint(attack: &Attack, report: &Report) -> Option<String> {
    let everything = serde_json::to_string(report).expect("reports can be written");
    if everything.contains("BREACH") {
        return Some("it reached something".to_owned());
    }
    if report.points.earned > 0.0 {
        return Some("it earned points".to_owned());
    }
    let words = match (&report.submission.build_failure, report.checks.first()) {
        (Some(failure), None) if attack.outcome == Outcome::Build => failure.messages.clone(),
        (None, Some(check)) => {
            let explanation = words::explanation(check);
            if !ended_as(check, attack.outcome) {
                return Some(format!("{:?}, {:?}: {explanation}", check.verdict, check.reason));
            }
            explanation
        }
        (Some(failure), _) => return Some(failure.messages.clone()),
        (None, None) => return Some("it compiled, and was not run".to_owned()),
    };
    let obeyed = |c: char| c.is_control() && c != '\n' && c != '\t';
    let command = words.lines().any(|line| line.trim_start().starts_with("::") || line.contains("##["));
    if words.contains(obeyed) || command {
        return Some(format!("its words are not harmless: {words:?}"));
    }
    (!words.contains(&attack.says)).then(|| format!("its report does not say `{}`: {words}", attack.says))
}

/// True if a check ended as the index says.
fn ended_as(check: &CheckResult, outcome: Outcome) -> bool {
    let reason = match outcome {
        Outcome::Build => return false,
        Outcome::Any => return check.verdict == Verdict::Fail,
        Outcome::Black | Outcome::Wrong => Reason::Bias,
        Outcome::Crash => Reason::Crash,
        Outcome::Timeout => Reason::Timeout,
        Outcome::Numerics => Reason::Numerics,
        Outcome::Violation => Reason::Violation,
        Outcome::Efficiency => Reason::Efficiency,
        Outcome::Rays => Reason::RayBudget,
    };
    let is_black = || check.mean_test().and_then(|test| test.effect).is_some_and(|effect| effect <= -1.0);
    check.verdict == Verdict::Fail && check.reason == reason && (outcome != Outcome::Black || is_black())
}

#[test]
fn every_attack_ends_as_it_must_and_harms_nobody_else() {
    let workspace = workspace();
    if Level::of(Machine::here().layers()) < Level::Medium {
        eprintln!("left out: this machine has no sandbox; see `grader doctor`");
        return;
    }
    let folder = workspace.root().join("grader/hostile");
    let text = std::fs::read_to_string(folder.join("index.yml")).expect("the index is there");
    let index: Index = serde_yaml::from_str(&text).expect("the index is sound");
    let honest = Honest::new(&workspace);
    let right = honest.renders();
    let root = workspace.root().display().to_string();
    let deep = format!("{}1{}", "(".repeat(50_000), ")".repeat(50_000));

    let mut complaints = Vec::new();
    // One alone: HOSTILE=name cargo test -p grader --test hostile
    let only = std::env::var("HOSTILE").ok();
    for attack in
        index.submissions.iter().filter(|attack| only.as_ref().is_none_or(|only| *only == attack.file))
    {
        let file = folder.join(format!("{}.rs", attack.file));
        let source = std::fs::read_to_string(&file).expect("the file is there");
        let start = Instant::now();
        let report = grade_source(
            &workspace,
            source.replace("@ROOT@", &root).replace("@DEEP@", &deep),
            attack.check.as_deref().unwrap_or(CHECK),
        );
        let seconds = start.elapsed().as_secs_f64();
        eprintln!("{:<28} {:?} {seconds:.1} s", attack.file, attack.outcome);
        let complaint = complaint(attack, &report);
        complaints
            .extend(complaint.map(|complaint| format!("{} ({}): {complaint}", attack.file, attack.threat)));
        assert!(honest.renders() == right, "{}: the next submission renders something else", attack.file);
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
    assert!(!std::path::Path::new("/tmp/arty-owned").exists());
}

#[test]
fn knowing_a_public_scene_is_right_there_and_earns_nothing() {
    let workspace = workspace();
    let file = workspace.root().join("grader/hostile/known_scene.rs");
    let source = std::fs::read_to_string(file).expect("the file is there");
    let report = grade_source(&workspace, source, "3");
    let verdicts: Vec<Verdict> = report.checks.iter().map(|check| check.verdict.clone()).collect();
    assert_eq!(verdicts, [Verdict::Pass, Verdict::Fail], "{:#?}", report.checks);
    assert_eq!(report.points.earned, 0.0);
}

#[test]
fn the_corpus_and_its_index_are_about_the_same_files() {
    let folder = workspace().root().join("grader/hostile");
    let text = std::fs::read_to_string(folder.join("index.yml")).expect("the index is there");
    let index: Index = serde_yaml::from_str(&text).expect("the index is sound");
    let mut named: Vec<String> =
        index.submissions.iter().map(|attack| format!("{}.rs", attack.file)).collect();
    named.sort();
    let mut there: Vec<String> = std::fs::read_dir(&folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("it can be listed").file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".rs"))
        .collect();
    there.sort();
    assert_eq!(named, there);
    assert!(named.len() >= 30);
}

#[test]
fn the_report_tells_how_the_submission_was_confined_and_what_it_reached_for() {
    let workspace = workspace();
    let source = assignment(&workspace).solution().expect("the solution is there");
    let report = grade_source(&workspace, format!("{source}\nuse std::fs::File as _;\n"), CHECK);
    assert_eq!(report.checks[0].verdict, Verdict::Pass, "{:#?}", report.checks[0]);
    let sandbox = &report.sandbox;
    assert_eq!(sandbox.level, Level::of(Machine::here().layers()), "{sandbox:?}");
    assert_eq!(words::missing_layers(sandbox).is_empty(), sandbox.level == Level::Strong, "{sandbox:?}");
    let lines: Vec<usize> = sandbox.findings.iter().map(|finding| finding.line).collect();
    assert_eq!(lines, [source.lines().count() + 2], "{sandbox:?}");
}

#[test]
fn a_source_of_megabytes_is_not_even_compiled() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("render_pt.rs");
    std::fs::write(&file, "// x\n".repeat(200_000)).expect("it can be written");
    let wanted = intake::Wanted::new(&assignment(&workspace()).rubric.submission, "");
    let error = intake::read(&file, &wanted).expect_err("it is refused").to_string();
    assert!(error.contains("too large"), "{error}");
}

#[test]
fn without_a_sandbox_the_report_says_so() {
    let workspace = workspace();
    let submission = solution(&workspace);
    let limits = Limits { sandbox: false, ..limits() };
    let only = vec![CHECK.to_owned()];
    let assignment = ASSIGNMENT.to_owned();
    let options = Options { assignment, seed: 1, threads: 2, only, limits };
    let report = grade(&workspace, &submission, &options, |_| {}).expect("the harness works");
    assert!(report.sandbox.level < Level::Medium, "{:?}", report.sandbox);
    assert_eq!(report.sandbox.host.landlock, 0, "{:?}", report.sandbox);
}

#[test]
fn where_a_sandbox_is_asked_for_nothing_is_graded_without() {
    let workspace = workspace();
    let submission = solution(&workspace);
    let limits = Limits { sandbox: false, min_level: Level::Medium, ..limits() };
    let options =
        Options { assignment: ASSIGNMENT.to_owned(), seed: 1, threads: 2, only: Vec::new(), limits };
    let error = grade(&workspace, &submission, &options, |_| {}).expect_err("it is refused").to_string();
    for named in ["--allow-sandbox=weak", "`weak` here", "Landlock", "seccomp"] {
        assert!(error.contains(named), "{error}");
    }
}

/// The processes that a process has started, and that live.
fn children_of(parent: u32) -> Vec<u32> {
    let numbers = std::fs::read_dir("/proc").expect("Linux has it").flatten();
    let numbers = numbers.filter_map(|entry| entry.file_name().to_string_lossy().parse::<u32>().ok());
    numbers
        .filter(|number| {
            // `number (name) state parent …`, and a name may have spaces.
            let stat = std::fs::read_to_string(format!("/proc/{number}/stat")).unwrap_or_default();
            let after = stat.rsplit_once(')').map_or("", |(_, after)| after);
            let mut fields = after.split_whitespace();
            fields.next().is_some_and(|state| state != "Z")
                && fields.next() == Some(parent.to_string().as_str())
        })
        .collect()
}

#[test]
fn a_grader_that_is_killed_leaves_no_submission_behind_that_runs() {
    let workspace = workspace();
    for (attack, name) in [("sleep", "submission"), ("const_loop", "rustc")] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut grader = std::process::Command::new(env!("CARGO_BIN_EXE_grader"))
            .args(["grade", "--no-report", "--assignment", ASSIGNMENT])
            .arg(workspace.root().join(format!("grader/hostile/{attack}.rs")))
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .expect("the program starts");
        let start = Instant::now();
        let is_called = |number: &u32| {
            let called = std::fs::read_to_string(format!("/proc/{number}/comm")).unwrap_or_default();
            called.trim() == name
        };
        let mut running: Option<(u32, Instant)> = None;
        // It has to be the same one for a while: rustc is asked for its version first, and honest submissions are short.
        while running.is_none_or(|(_, since)| since.elapsed() < Duration::from_secs(2)) {
            assert!(start.elapsed() < Duration::from_secs(300), "{attack}: it never runs");
            assert!(grader.try_wait().expect("it can be asked").is_none(), "{attack}: it ended too soon");
            let found = children_of(grader.id()).into_iter().find(is_called);
            running = match (found, running) {
                (Some(found), Some((known, since))) if found == known => Some((known, since)),
                (found, _) => found.map(|found| (found, Instant::now())),
            };
            std::thread::sleep(Duration::from_millis(20));
        }
        grader.kill().expect("it can be killed");
        grader.wait().expect("it has ended");
        let (number, _) = running.expect("it was found");
        let killed = Instant::now();
        while is_called(&number) {
            assert!(killed.elapsed() < Duration::from_secs(20), "{attack}: {name} goes on");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}
