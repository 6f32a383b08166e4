//! Intake in a process of its own, which has locked itself in before it reads the first byte of a submission.
//!
//! The program that is started locks itself in and calls [`serve`]. What it answers is data; whatever else happens to it
//! is a finding about the submission.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::channel;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::{Intake, Note, Refusal, Wanted, limits};
use verdict::error::{Error, Result};
use verdict::submission::{Explanation, Submission};

/// Name of the hidden command of the program that is started: `COMMAND [--source=PATH] -- PATH…`, with what is
/// [`Wanted`] as JSON on standard input.
pub const COMMAND: &str = "__intake";

/// Who reads submissions.
#[derive(Clone, Debug)]
pub enum Reader {
    /// This process.
    Here,
    /// A process for each submission: this program with the command [`COMMAND`].
    Apart(PathBuf),
}

/// Result of a process, as JSON on its standard output.
#[derive(Serialize, Deserialize)]
struct Answer {
    outcome: std::result::Result<String, Refusal>,
    notes: Vec<Note>,
    explanations: Vec<Explanation>,
    checksums: Vec<String>,
}

/// Maximum size of an answer in bytes: that of a source and its explanations, escaped.
const MAX_ANSWER: u64 = 64 << 20;
/// Maximum wall time of a process. Its [processor time](limits::SECONDS) is what ends it before, unless it waits.
const MAX_TIME: Duration = Duration::from_secs(4 * limits::SECONDS);

impl Reader {
    /// Takes in a submission; see [`crate::take`].
    ///
    /// # Errors
    /// If a path does not exist, or the process cannot be started.
    pub fn take(&self, paths: &[PathBuf], wanted: &Wanted, source: Option<&str>) -> Result<Intake> {
        let Self::Apart(program) = self else { return super::take(paths, wanted, source) };
        super::check_exist(paths)?;
        let mut command = Command::new(program);
        command.arg(COMMAND).args(source.map(|source| format!("--source={source}"))).arg("--").args(paths);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let path = paths.first().cloned().unwrap_or_else(|| (&wanted.file_name).into());
        let (answer, status) = ask(command, wanted)
            .map_err(|error| Error::Harness(format!("{} cannot be started: {error}", program.display())))?;
        Ok(match answer {
            Some(answer) => Intake {
                outcome: answer.outcome.map(|source| Submission { path, source }),
                notes: answer.notes,
                explanations: answer.explanations,
                checksums: answer.checksums,
            },
            None => refused(why(status)),
        })
    }

    /// Reads the source of a submission; see [`crate::read`].
    ///
    /// # Errors
    /// If it contains nothing to grade.
    pub fn read(&self, path: &Path, wanted: &Wanted) -> Result<Submission> {
        self.take(&[path.to_owned()], wanted, None)?.outcome.map_err(|refusal| Error::file(path, refusal))
    }
}

/// Takes in a submission in the process that [`Reader::Apart`] has started, and answers on standard output. Call
/// `lock` to lock the process in: by then it has read all that it needs except the submission.
///
/// # Errors
/// If `lock` fails, or nobody reads the answer.
pub fn serve(paths: &[PathBuf], source: Option<&str>, lock: impl FnOnce() -> Result<()>) -> Result<()> {
    let broken = |error: std::io::Error| Error::Harness(format!("the pipe of intake: {error}"));
    let mut wanted = String::new();
    std::io::stdin().read_to_string(&mut wanted).map_err(broken)?;
    let wanted: Wanted = serde_json::from_str(&wanted).map_err(|error| broken(error.into()))?;
    lock()?;
    let Intake { outcome, notes, explanations, checksums } = super::take(paths, &wanted, source)?;
    let answer = Answer { outcome: outcome.map(|it| it.source), notes, explanations, checksums };
    let text = serde_json::to_vec(&answer).map_err(|error| broken(error.into()))?;
    std::io::stdout().write_all(&text).map_err(broken)
}

/// Starts the process and waits for its answer; `None` if there is no valid one.
fn ask(mut command: Command, wanted: &Wanted) -> std::io::Result<(Option<Answer>, Option<ExitStatus>)> {
    let wanted = serde_json::to_vec(wanted)?;
    let mut child = command.spawn()?;
    let (send, receive) = channel();
    let reader = child.stdout.take().map(|output| {
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            let outcome = output.take(MAX_ANSWER).read_to_end(&mut bytes);
            // Nobody waits any more if it took too long.
            let _ = send.send(outcome.map(|_| bytes));
        })
    });
    if let Some(mut input) = child.stdin.take() {
        // A process that ends early says so by its status.
        let _ = input.write_all(&wanted);
    }
    let bytes = receive.recv_timeout(MAX_TIME);
    let status = end(&mut child, bytes.is_ok())?;
    if let Some(reader) = reader {
        // It ends with the process, whose output it reads.
        let _ = reader.join();
    }
    let ended_well = status.is_some_and(|status| status.success());
    let answer = bytes.ok().and_then(std::result::Result::ok).filter(|_| ended_well);
    Ok((answer.and_then(|bytes| serde_json::from_slice(&bytes).ok()), status))
}

/// Waits for a process that has answered, or ends one that has not; then there is no status.
fn end(child: &mut Child, answered: bool) -> std::io::Result<Option<ExitStatus>> {
    if answered {
        return child.wait().map(Some);
    }
    child.kill()?;
    child.wait().map(|_| None)
}

/// The refusal that follows from the exit status of a process without an answer; `None` if it was stopped.
fn why(status: Option<ExitStatus>) -> Refusal {
    let Some(status) = status else {
        return Refusal::Bomb(format!("reading it takes more than {} s", MAX_TIME.as_secs()));
    };
    match status.code() {
        // A signal: the system ends what exceeds its limits, and a failed allocation aborts.
        None => Refusal::Bomb("more memory or processor time".to_owned()),
        Some(code) => Refusal::Failed(code),
    }
}

fn refused(refusal: Refusal) -> Intake {
    Intake { outcome: Err(refusal), notes: Vec::new(), explanations: Vec::new(), checksums: Vec::new() }
}
