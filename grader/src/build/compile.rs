//! One call of rustc: the hand-in, the fixed program around it, the framework.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use super::Framework;
use crate::error::{Error, Result};

/// The program around a hand-in.
const PROGRAM: &str = include_str!("../../host/program/main.rs");

/// A hand-in, compiled. Its files are removed when this is dropped.
#[derive(Debug)]
pub struct HandInProgram {
    /// The program.
    pub executable: PathBuf,
    /// How long rustc took.
    pub compile_time: Duration,
    _folder: TempDir,
}

/// Why a hand-in does not compile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BuildFailure {
    /// rustc's messages as it shows them on a terminal without colours; lines are those of the hand-in.
    pub messages: String,
    /// The line of the first error in the hand-in, where rustc names one.
    pub line: Option<u32>,
}

/// How long rustc may take. Constants can be computed at compile time for as long as one likes.
const COMPILE_TIME: Duration = Duration::from_secs(30);

/// A hand-in that compiles wherever compiling works at all.
const EMPTY_HAND_IN: &str = "use arty::prelude::*;
pub struct PathTracer;
impl PathTracer { pub fn new(_: Settings) -> Self { Self } }
impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb { Rgb::BLACK }
}
";

/// Compiles the source of a hand-in. The outer error is the harness's, the inner one the hand-in's.
pub fn compile(
    framework: &Framework,
    source: &str,
) -> Result<std::result::Result<HandInProgram, BuildFailure>> {
    let failure = match compile_once(framework, source)? {
        Ok(program) => return Ok(Ok(program)),
        Err(failure) => failure,
    };
    // No line of the hand-in is to blame: is it the machine? A missing linker, a full disk?
    if failure.line.is_none()
        && let Err(machine) = compile_once(framework, EMPTY_HAND_IN)?
    {
        let messages = machine.messages;
        return Err(Error::Harness(format!("not even an empty hand-in compiles here:\n{messages}")));
    }
    Ok(Err(failure))
}

fn compile_once(
    framework: &Framework,
    source: &str,
) -> Result<std::result::Result<HandInProgram, BuildFailure>> {
    let trouble = |what: &str, error: std::io::Error| Error::Harness(format!("{what}: {error}"));
    let folder = tempfile::Builder::new()
        .prefix("arty-hand-in-")
        .tempdir()
        .map_err(|error| trouble("no temporary folder", error))?;
    for (name, text) in [("main.rs", PROGRAM), ("render_pt.rs", source)] {
        std::fs::write(folder.path().join(name), text)
            .map_err(|error| trouble("the hand-in cannot be copied", error))?;
    }
    let start = Instant::now();
    let status =
        run_in_time(framework, folder.path()).map_err(|error| trouble("rustc could not be run", error))?;
    let compile_time = start.elapsed();
    let Some(status) = status else {
        let messages = format!("rustc did not finish within {} s\n", COMPILE_TIME.as_secs());
        return Ok(Err(BuildFailure { messages, line: None }));
    };
    if status.success() {
        let executable = folder.path().join(executable_name());
        return Ok(Ok(HandInProgram { executable, compile_time, _folder: folder }));
    }
    let messages = std::fs::read(folder.path().join(MESSAGES))
        .map_err(|error| trouble("rustc's messages are gone", error))?;
    Ok(Err(build_failure(&String::from_utf8_lossy(&messages), &status.to_string())))
}

/// The file that rustc's messages go to: unlike a pipe it never fills up.
const MESSAGES: &str = "messages.json";

/// Runs rustc; `None` if it had to be ended.
fn run_in_time(framework: &Framework, folder: &Path) -> std::io::Result<Option<ExitStatus>> {
    let messages = std::fs::File::create(folder.join(MESSAGES))?;
    let mut rustc = call(framework, folder).stderr(messages).spawn()?;
    let deadline = Instant::now() + COMPILE_TIME;
    loop {
        if let Some(status) = rustc.try_wait()? {
            return Ok(Some(status));
        }
        if Instant::now() >= deadline {
            rustc.kill()?;
            rustc.wait()?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn executable_name() -> String {
    format!("hand-in{}", std::env::consts::EXE_SUFFIX)
}

/// The call. No link-time optimisation: it would make a tenth of a second into several, for a tenth more speed.
fn call(framework: &Framework, folder: &Path) -> Command {
    let external = |name: &str, library: &Path| {
        let mut argument = std::ffi::OsString::from(format!("{name}="));
        argument.push(library);
        argument
    };
    let mut dependencies = std::ffi::OsString::from("dependency=");
    dependencies.push(&framework.dependencies);
    let mut command = super::framework::rustc();
    command
        .args(["main.rs", "--crate-name", "hand_in", "--edition", "2024", "--crate-type", "bin", "-o"])
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
        .env_remove("RUSTFLAGS")
        .stdin(Stdio::null());
    command
}

/// The part of rustc's JSON messages that is shown.
#[derive(Deserialize)]
struct Message {
    rendered: Option<String>,
    level: String,
    #[serde(default)]
    spans: Vec<Span>,
}

#[derive(Deserialize)]
struct Span {
    file_name: String,
    line_start: u32,
    is_primary: bool,
}

fn build_failure(stderr: &str, status: &str) -> BuildFailure {
    let mut messages = String::new();
    let mut line = None;
    for text in stderr.lines() {
        match serde_json::from_str::<Message>(text) {
            Ok(message) if message.level == "error" => {
                messages.push_str(message.rendered.as_deref().unwrap_or_default());
                let own = |span: &&Span| span.is_primary && span.file_name == "render_pt.rs";
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
    BuildFailure { messages, line }
}
