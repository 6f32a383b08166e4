//! The process that runs a hand-in, seen from the grader.

use std::borrow::Cow;
use std::io::{BufReader, BufWriter};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use arty::scene::SceneDescription;
use host::protocol::{
    ProbeJob, ProbedPath, RenderJob, Rendered, ReplayJob, Replayed, Request, Response, read_message,
    write_message,
};
use serde::{Deserialize, Serialize};

use crate::build::HandInProgram;
use crate::error::{Error, Result};

/// The longest answer that is accepted, in bytes.
const MAX_ANSWER: u32 = 256 << 20;

/// How long the hand-in may take for one job: a million samples at most, for which a correct one needs less than a
/// second.
const JOB_TIME: Duration = Duration::from_secs(30);

/// A running hand-in.
pub struct HostProcess {
    child: Child,
    requests: BufWriter<ChildStdin>,
    responses: Receiver<std::io::Result<Option<Response>>>,
    scenes: u32,
}

/// What a hand-in can do instead of answering. Each is a finding about it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// It panicked.
    Panic(String),
    /// It did not answer in time.
    Timeout,
    /// Its process ended.
    Crash(String),
    /// Its answer was not what was asked for.
    Malformed(String),
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Panic(message) => write!(f, "it panicked: {message}"),
            Self::Timeout => write!(f, "it did not finish within {} s", JOB_TIME.as_secs()),
            Self::Crash(status) => write!(f, "its process ended early ({status})"),
            Self::Malformed(what) => write!(f, "its answer was not what was asked for ({what})"),
        }
    }
}

/// The outer error is the harness's, the inner one the hand-in's.
type Answer<T> = Result<std::result::Result<T, Fault>>;

impl HostProcess {
    /// Starts the program, with an empty environment, in a folder of its own.
    pub fn start(program: &HandInProgram, threads: usize) -> Result<Self> {
        let mut child = Command::new(&program.executable)
            .env_clear()
            .env("RAYON_NUM_THREADS", threads.to_string())
            .current_dir(program.executable.parent().unwrap_or(&program.executable))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            // What a hand-in prints is nobody's verdict.
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| Error::Harness(format!("the hand-in's program does not start: {error}")))?;
        let requests = BufWriter::new(child.stdin.take().expect("stdin is piped"));
        let mut answers = BufReader::new(child.stdout.take().expect("stdout is piped"));
        let (sender, responses) = channel();
        std::thread::spawn(move || {
            loop {
                let message = read_message(&mut answers, MAX_ANSWER);
                let last = !matches!(message, Ok(Some(_)));
                if sender.send(message).is_err() || last {
                    break;
                }
            }
        });
        Ok(Self { child, requests, responses, scenes: 0 })
    }

    /// Sends a scene, and gives the number by which jobs refer to it.
    pub fn load(&mut self, scene: &SceneDescription) -> Answer<u32> {
        match self.ask(&Request::Scene(Cow::Borrowed(scene)))? {
            Ok(Response::SceneReady) => {
                self.scenes += 1;
                Ok(Ok(self.scenes - 1))
            }
            Ok(other) => unexpected(other),
            Err(fault) => Ok(Err(fault)),
        }
    }

    /// Has batches rendered. All means are finite and there are as many as asked for.
    pub fn render(&mut self, job: &RenderJob) -> Answer<Rendered> {
        let (pixels, batches) = ((job.width * job.height) as usize, job.seeds.len());
        match self.ask(&Request::Render(Cow::Borrowed(job)))? {
            Ok(Response::Rendered(rendered)) => Ok(check_shape(rendered, batches, pixels)),
            Ok(other) => unexpected(other),
            Err(fault) => Ok(Err(fault)),
        }
    }

    /// Follows paths through scripted scenes: for each scene as many as asked for. Their radiance may be anything.
    pub fn probe(&mut self, job: &ProbeJob) -> Answer<Vec<Vec<ProbedPath>>> {
        match self.ask(&Request::Probe(Cow::Borrowed(job)))? {
            Ok(Response::Probed(paths)) => {
                let whole = paths.len() == job.scenes.len()
                    && paths.iter().all(|paths| paths.len() as u64 == job.samples);
                Ok(if whole {
                    Ok(paths)
                } else {
                    Err(Fault::Malformed("the number of scenes or paths is wrong".to_owned()))
                })
            }
            Ok(other) => unexpected(other),
            Err(fault) => Ok(Err(fault)),
        }
    }

    /// Follows one path again, with every call written down. Its numbers may be anything.
    pub fn replay(&mut self, job: ReplayJob) -> Answer<Replayed> {
        match self.ask(&Request::Replay(job))? {
            Ok(Response::Replayed(path)) => Ok(Ok(path)),
            Ok(other) => unexpected(other),
            Err(fault) => Ok(Err(fault)),
        }
    }

    fn ask(&mut self, request: &Request<'_>) -> Answer<Response> {
        if write_message(&mut self.requests, request).is_err() {
            return Ok(Err(self.crash()));
        }
        match self.responses.recv_timeout(JOB_TIME) {
            Ok(Ok(Some(response))) => Ok(Ok(response)),
            Ok(Ok(None)) | Err(RecvTimeoutError::Disconnected) => Ok(Err(self.crash())),
            Ok(Err(error)) if error.kind() == std::io::ErrorKind::UnexpectedEof => Ok(Err(self.crash())),
            Ok(Err(error)) => Ok(Err(Fault::Malformed(error.to_string()))),
            Err(RecvTimeoutError::Timeout) => {
                let _ = self.child.kill();
                Ok(Err(Fault::Timeout))
            }
        }
    }

    fn crash(&mut self) -> Fault {
        // The pipe may close a moment before the process is gone.
        std::thread::sleep(Duration::from_millis(20));
        let _ = self.child.kill();
        let status = self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
        Fault::Crash(status)
    }
}

impl Drop for HostProcess {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn unexpected<T>(response: Response) -> Answer<T> {
    match response {
        Response::Panicked { message } => Ok(Err(Fault::Panic(message))),
        Response::Rejected { message } => Err(Error::Harness(format!("the host rejected a job: {message}"))),
        Response::SceneReady => Ok(Err(Fault::Malformed("it only said that a scene is ready".to_owned()))),
        Response::Replayed(_) => Ok(Err(Fault::Malformed("a path that nobody asked for".to_owned()))),
        Response::Probed(_) => Ok(Err(Fault::Malformed("paths that nobody asked for".to_owned()))),
        Response::Rendered(_) => Ok(Err(Fault::Malformed("a rendering that nobody asked for".to_owned()))),
    }
}

fn check_shape(rendered: Rendered, batches: usize, pixels: usize) -> std::result::Result<Rendered, Fault> {
    let whole =
        rendered.batches.len() == batches && rendered.batches.iter().all(|batch| batch.len() == pixels);
    if !whole {
        return Err(Fault::Malformed("the number of batches or pixels is wrong".to_owned()));
    }
    if rendered.batches.iter().flatten().flatten().any(|value| !value.is_finite()) {
        return Err(Fault::Malformed("a mean that is not finite".to_owned()));
    }
    Ok(rendered)
}
