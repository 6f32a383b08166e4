//! Compiling one submission: one call of rustc on its source and the fixed program around it.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::refuse::{Look, look};
use super::scratch::Scratch;
use super::shape::Shape;
use super::{Framework, Program, refuse};
use crate::sandbox::{self, Account, BUSY, Layers, Limits, Profile, Watch};
use serde::Deserialize;
use verdict::error::{Error, Result};
use verdict::submission::BuildFailure;
use verdict::text::clean;

/// A compiled submission. Its files are removed when this is dropped.
#[derive(Debug)]
pub struct SubmissionProgram {
    /// Path of the program.
    pub executable: PathBuf,
    /// Time that rustc took; zero if it was compiled earlier.
    pub compile_time: Duration,
    /// Limits when it runs.
    pub limits: Limits,
    /// Sandbox layers of rustc, if it was called now.
    pub layers: Layers,
    folder: Scratch,
    /// Time for which its processes have waited without computing.
    waited: Arc<Mutex<Duration>>,
}

impl SubmissionProgram {
    /// User that it runs as.
    pub(crate) fn account(&self) -> &Arc<Account> {
        self.folder.account()
    }

    /// Time for which its processes have waited without computing, shared by all of them.
    pub(crate) fn waited(&self) -> &Arc<Mutex<Duration>> {
        &self.waited
    }

    /// Restores a program from the bytes of its executable.
    pub fn again(executable: &[u8], limits: &Limits) -> Result<Self> {
        let trouble = |error| Error::Harness(format!("a program cannot be copied: {error}"));
        let folder = Scratch::new()?;
        let file = folder.path().join(executable_name());
        std::fs::write(&file, executable).map_err(trouble)?;
        #[cfg(unix)]
        std::fs::set_permissions(&file, std::os::unix::fs::PermissionsExt::from_mode(0o755))
            .map_err(trouble)?;
        folder.hand_over()?;
        Ok(Self {
            executable: file,
            compile_time: Duration::ZERO,
            limits: *limits,
            layers: Layers::default(),
            folder,
            waited: Arc::default(),
        })
    }
}

/// Compiles the source of a submission in a sandbox and inspects the linked program. A source with forbidden words is
/// not compiled. The outer error is the harness's, the inner one the submission's.
pub fn compile(
    framework: &Framework,
    source: &str,
    limits: &Limits,
) -> Result<std::result::Result<SubmissionProgram, BuildFailure>> {
    if !limits.inspect {
        return compile_anywhere(framework, source, limits);
    }
    let file = framework.program.file_name.as_str();
    let look = look(source);
    if let Look::Through(refusals) = &look
        && !refusals.is_empty()
    {
        return Ok(Err(refused(file, refusals)));
    }
    // Mostly it is known already; if not, there is a core for it.
    let (usual, compiled) =
        rayon::join(|| usual_shape(framework, limits), || compile_anywhere(framework, source, limits));
    let program = match compiled? {
        Ok(program) => program,
        Err(failure) => return Ok(Err(failure)),
    };
    if let Look::Unreadable(line) = look {
        let why = "this source compiles but cannot be inspected: rewrite this part";
        return Ok(Err(not_run(file, Some(line), &[why.to_owned()])));
    }
    usual?;
    let differences = differences(framework, &program)?;
    Ok(if differences.is_empty() { Ok(program) } else { Err(not_run(file, None, &differences)) })
}

/// Differences between a program and that of an empty submission in whatever decides what runs before `main`. Empty
/// unless something is wrong.
///
/// # Errors
/// If one of them cannot be read.
pub fn differences(framework: &Framework, program: &SubmissionProgram) -> Result<Vec<String>> {
    let usual = usual_shape(framework, &program.limits)?;
    Ok(Shape::of(&program.executable)?.differences(usual))
}

/// Compiles an empty submission. Other programs are compared with its shape.
///
/// # Errors
/// If it does not compile.
pub(crate) fn compile_empty(framework: &Framework, limits: &Limits) -> Result<SubmissionProgram> {
    let program = match compile_once(framework, framework.program.empty_submission, limits, true)? {
        Ok(program) => program,
        // A toolchain whose files lie where the sandbox does not expect them. The report will tell its level.
        Err(_) => compile_once(framework, framework.program.empty_submission, limits, false)?.map_err(
            |failure| {
                let folder = framework.dependencies.display();
                Error::Harness(format!(
                    "not even an empty submission compiles here, against the libraries in {folder}:\n{}",
                    failure.messages
                ))
            },
        )?,
    };
    framework.usual.get_or_init(|| Shape::of(&program.executable).ok());
    Ok(program)
}

fn usual_shape<'a>(framework: &'a Framework, limits: &Limits) -> Result<&'a Shape> {
    if framework.usual.get().is_none() {
        compile_empty(framework, limits)?;
    }
    let usual = framework.usual.get().and_then(Option::as_ref);
    usual.ok_or_else(|| Error::Harness("the program of an empty submission cannot be read".to_owned()))
}

/// Failure of a source that is refused before it is compiled.
fn refused(file: &str, refusals: &[refuse::Refusal]) -> BuildFailure {
    let lines = refusals.iter().map(|refusal| {
        let refuse::Refusal { line, what, why } = refusal;
        format!("error: {what} is not allowed in a submission\n --> {file}:{line}\n  = {why}\n")
    });
    let line = refusals.first().and_then(|refusal| u32::try_from(refusal.line).ok());
    BuildFailure { messages: clean(&lines.collect::<Vec<_>>().join("\n")), line }
}

/// Failure of a program that was compiled but must not run.
fn not_run(file: &str, line: Option<usize>, why: &[String]) -> BuildFailure {
    let mut messages =
        "error: the program is not run: it differs from what safe Rust compiles to\n".to_owned();
    if let Some(line) = line {
        messages.push_str(&format!(" --> {file}:{line}\n"));
    }
    for why in why.iter().take(LISTED) {
        messages.push_str(&format!("  = it has: {why}\n"));
    }
    BuildFailure { messages: clean(&messages), line: line.and_then(|line| u32::try_from(line).ok()) }
}

/// Maximum number of differences that are listed.
const LISTED: usize = 20;

/// Compiles in the strongest sandbox that the toolchain works in.
fn compile_anywhere(
    framework: &Framework,
    source: &str,
    limits: &Limits,
) -> Result<std::result::Result<SubmissionProgram, BuildFailure>> {
    let failure = match compile_once(framework, source, limits, true)? {
        Ok(program) => return Ok(Ok(program)),
        Err(failure) => failure,
    };
    if !framework.is_there() {
        let folder = framework.dependencies.display();
        return Err(Error::Harness(format!("the framework's libraries are gone from {folder}: grade again")));
    }
    // No line of the submission is to blame: is it the machine? A missing linker, a full disk?
    if failure.line.is_some()
        || compile_once(framework, framework.program.empty_submission, limits, true)?.is_ok()
    {
        return Ok(Err(failure));
    }
    // Or a toolchain whose files lie where the sandbox does not expect them?
    compile_empty(framework, limits)?;
    compile_once(framework, source, limits, false)
}

fn compile_once(
    framework: &Framework,
    source: &str,
    limits: &Limits,
    locked: bool,
) -> Result<std::result::Result<SubmissionProgram, BuildFailure>> {
    let trouble = |what: &str, error: std::io::Error| Error::Harness(format!("{what}: {error}"));
    let folder = Scratch::new()?;
    let Program { file_name, text: program, .. } = &framework.program;
    for (name, text) in [("main.rs", program.as_str()), (file_name, source)] {
        std::fs::write(folder.path().join(name), text)
            .map_err(|error| trouble("the submission cannot be copied", error))?;
    }
    let messages = std::fs::File::create(folder.path().join(MESSAGES))
        .map_err(|error| trouble("no file for rustc's messages", error))?;
    folder.hand_over()?;
    let mut rustc = call(framework, folder.path());
    rustc.stderr(messages);
    let grants = &framework.grants;
    let profile = Profile::Compiler { grants, folder: folder.path(), locked, account: folder.account() };
    let layers = sandbox::prepare(&mut rustc, profile, limits)?;
    let kills = sandbox::out_of_memory_kills();
    let start = Instant::now();
    let status = run_in_time(&mut rustc, limits.compile_time)
        .map_err(|error| trouble("rustc could not be run", error))?;
    let compile_time = start.elapsed();
    let Some(status) = status else {
        let messages = format!("rustc did not finish within {} s\n", limits.compile_time.as_secs());
        return Ok(Err(BuildFailure { messages, line: None }));
    };
    sandbox::blame_machine(status, kills, "rustc")?;
    if status.success() {
        let executable = folder.path().join(executable_name());
        let limits = *limits;
        return Ok(Ok(SubmissionProgram {
            executable,
            compile_time,
            limits,
            layers,
            folder,
            waited: Arc::default(),
        }));
    }
    let messages = read_messages(&folder.path().join(MESSAGES))
        .map_err(|error| trouble("rustc's messages are gone", error))?;
    Ok(Err(build_failure(&framework.program.file_name, &messages, &status.to_string())))
}

/// Runs rustc; `None` if it had to be ended.
fn run_in_time(rustc: &mut Command, time: Duration) -> std::io::Result<Option<ExitStatus>> {
    let mut rustc = rustc.spawn()?;
    let mut watch = Watch::start(&rustc);
    loop {
        if let Some(status) = rustc.try_wait()? {
            return Ok(Some(status));
        }
        let spent = watch.spent(&rustc);
        if spent.computed >= time || spent.waited >= time || spent.wall >= time * BUSY {
            sandbox::end(&mut rustc);
            rustc.wait()?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The file that rustc's messages go to: unlike a pipe it never fills up.
const MESSAGES: &str = "messages.json";

/// The beginning of rustc's messages: as much as anyone will read.
fn read_messages(file: &Path) -> std::io::Result<String> {
    let mut bytes = Vec::new();
    std::fs::File::open(file)?.take(LONGEST_MESSAGES).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Bytes of rustc's messages that are looked at. The terminal's form of them is a quarter of it.
const LONGEST_MESSAGES: u64 = 256 << 10;

fn executable_name() -> String {
    format!("submission{}", std::env::consts::EXE_SUFFIX)
}

/// What rustc's call of the linker may need of the environment, on one system or another. `env!` can read no more.
const KEPT: [&str; 14] = [
    "PATH",
    // macOS: where its developer tools are.
    "DEVELOPER_DIR",
    "SDKROOT",
    // Windows: where its own libraries and the linker's are.
    "SystemRoot",
    "ProgramFiles",
    "ProgramFiles(x86)",
    "ProgramData",
    "VCINSTALLDIR",
    "LIB",
    "LIBPATH",
    "INCLUDE",
    "TMP",
    "TEMP",
    "PATHEXT",
];

/// The call. No link-time optimisation: it would make a tenth of a second into several, for a tenth more speed.
fn call(framework: &Framework, folder: &Path) -> Command {
    let external = |name: &str, library: &Path| {
        let mut argument = std::ffi::OsString::from(format!("{name}="));
        argument.push(library);
        argument
    };
    let mut dependencies = std::ffi::OsString::from("dependency=");
    dependencies.push(&framework.dependencies);
    let mut command = Command::new(&framework.rustc);
    command
        .env_clear()
        .envs(KEPT.iter().filter_map(|&name| Some((name, std::env::var_os(name)?))))
        // The linker's intermediate files.
        .env("TMPDIR", folder)
        .args(["main.rs", "--crate-name", "submission", "--edition", "2024", "--crate-type", "bin", "-o"])
        .arg(executable_name())
        .args(["-C", "opt-level=3", "-C", "codegen-units=1", "-C", "debuginfo=0", "-C", "strip=debuginfo"])
        // The student's warnings are the student's matter. (Capping lints would lift the ban on unsafe code.)
        .args(["-A", "warnings", "--error-format", "json"])
        .arg("-L")
        .arg(dependencies)
        .arg("--extern")
        .arg(external("arty", &framework.arty))
        .arg("--extern")
        .arg(external("host", &framework.host))
        .current_dir(folder)
        .stdin(Stdio::null());
    command
}

/// The part of rustc's JSON messages that is shown.
#[derive(Deserialize)]
struct Message {
    rendered: Option<String>,
    level: String,
    code: Option<Code>,
    #[serde(default)]
    spans: Vec<Span>,
}

/// rustc's code of an error, such as `E0432`.
#[derive(Deserialize)]
struct Code {
    code: String,
}

/// Codes of errors about names that cannot be resolved: an import, or the beginning of a path. rustc's own advice, to add
/// a crate, is of no use here.
const UNRESOLVED: [&str; 2] = ["E0432", "E0433"];

#[derive(Deserialize)]
struct Span {
    file_name: String,
    line_start: u32,
    is_primary: bool,
}

fn build_failure(file: &str, stderr: &str, status: &str) -> BuildFailure {
    let (mut messages, mut line, mut is_unresolved) = (String::new(), None, false);
    for text in stderr.lines() {
        match serde_json::from_str::<Message>(text) {
            Ok(message) if message.level == "error" => {
                messages.push_str(message.rendered.as_deref().unwrap_or_default());
                is_unresolved |= message.code.is_some_and(|code| UNRESOLVED.contains(&code.code.as_str()));
                let own = |span: &&Span| span.is_primary && span.file_name == file;
                line = line.or(message.spans.iter().find(own).map(|span| span.line_start));
            }
            Ok(_) => {}
            Err(_) => {
                messages.push_str(text);
                messages.push('\n');
            }
        }
    }
    if messages.is_empty() {
        messages = format!("rustc ended with {status} and said nothing\n");
    }
    if is_unresolved {
        messages.push_str(
            "note: a submission may use `std` and `arty::prelude` only: no other crate can be added\n",
        );
    }
    BuildFailure { messages: clean(&messages), line }
}
