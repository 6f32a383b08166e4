//! The loop that answers requests.

use std::any::Any;
use std::io::{BufReader, BufWriter, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::Mutex;

use arty::probe::Key;
use arty::scene::Scene;

use crate::confine::{allow_only_computing, close_files};
use crate::protocol::{MAX_MESSAGE, Request, Response, UNCONFINED, read_message, write_message};
use crate::submission::Submission;
use crate::{audit, directions, probe, render, replay, stdio};

/// Answers requests until the grader closes the pipe. Exit code 3 if the pipe breaks or this is not the first call.
pub fn serve(submission: Submission) -> ExitCode {
    let (input, output) = match stdio::take() {
        Ok(pipes) => pipes,
        Err(error) => {
            eprintln!("host: cannot take over the pipe to the grader: {error}");
            return ExitCode::from(3);
        }
    };
    let Some(key) = Key::take() else {
        eprintln!("host: serve() can run only once per process");
        return ExitCode::from(3);
    };
    // Staff can start a process without a sandbox, to measure the cost of the sandbox.
    let confined = std::env::args().nth(1).is_none_or(|argument| argument != UNCONFINED);
    if confined {
        close_files();
    }
    start_threads();
    if confined {
        allow_only_computing();
    }
    keep_panic_messages();
    let mut output = BufWriter::new(output);
    let answered = write_message(&mut output, &Response::Started)
        .and_then(|()| answer_all(&key, submission, &mut BufReader::new(input), &mut output));
    match answered {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("host: the pipe to the grader broke: {error}");
            ExitCode::from(3)
        }
    }
}

/// Starts the threads that render, as many as the environment asks for, and waits until all of them run: a submission can
/// start none.
fn start_threads() {
    rayon::broadcast(|_| ());
}

fn answer_all(
    key: &Key,
    submission: Submission,
    input: &mut impl Read,
    output: &mut impl Write,
) -> std::io::Result<()> {
    let mut scenes: Vec<Scene> = Vec::new();
    while let Some(request) = read_message(input, MAX_MESSAGE)? {
        let response = match request {
            Request::Scene(description, switches) => {
                scenes.push(Scene::new(&description));
                if let (false, Some(scene)) = (switches.emission_on_hit, scenes.last_mut()) {
                    scene.blacken_hits();
                }
                Response::SceneReady
            }
            Request::Render(job) => match scenes.get(job.scene as usize) {
                None => Response::Rejected { message: format!("there is no scene {}", job.scene) },
                Some(scene) => guarded(|| Response::Rendered(render::batches(key, submission, scene, &job))),
            },
            Request::Replay(job) => match scenes.get(job.scene as usize) {
                None => Response::Rejected { message: format!("there is no scene {}", job.scene) },
                Some(scene) => guarded(|| Response::Replayed(replay::path(key, submission, scene, &job))),
            },
            Request::Directions(job) => match scenes.get(job.scene as usize) {
                None => Response::Rejected { message: format!("there is no scene {}", job.scene) },
                Some(scene) => guarded(|| match directions::sample(submission, scene, &job) {
                    None => Response::Rejected { message: "there is nothing to sample".to_owned() },
                    Some(sampled) => Response::Directions(sampled),
                }),
            },
            Request::Probe(job)
                if job.stratified && !(job.samples.is_power_of_two() && job.samples <= 1 << 20) =>
            {
                Response::Rejected { message: format!("{} paths cannot be stratified", job.samples) }
            }
            Request::Audit(job) if !job.is_valid() => {
                Response::Rejected { message: "an audit's run cannot be made".to_owned() }
            }
            Request::Audit(job) => guarded(|| Response::Audited(audit::all(key, submission, &job))),
            Request::Probe(job) => guarded(|| Response::Probed(probe::all(key, submission, &job))),
        };
        write_message(output, &response)?;
    }
    Ok(())
}

/// Runs code of the submission and turns a panic into a response.
fn guarded(answer: impl FnOnce() -> Response) -> Response {
    catch_unwind(AssertUnwindSafe(answer)).unwrap_or_else(|_| Response::Panicked { message: first_panic() })
}

/// Message and location of the first panic.
static FIRST_PANIC: Mutex<Option<String>> = Mutex::new(None);

fn keep_panic_messages() {
    std::panic::set_hook(Box::new(|info| {
        let message = message_of(info.payload());
        let place = info
            .location()
            .map_or(String::new(), |location| format!(" ({}:{})", location.file(), location.line()));
        if let Ok(mut first) = FIRST_PANIC.lock() {
            first.get_or_insert_with(|| format!("{}{place}", beginning(message)));
        }
    }));
}

/// The payload of `panic!` is a `&str`, or a `String` if the message is formatted.
fn message_of(payload: &dyn Any) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("a value that is not text")
}

/// The beginning of a message, which may be gigabytes long.
fn beginning(message: &str) -> &str {
    let end = message.char_indices().nth(MAX_MESSAGE_CHARS).map_or(message.len(), |(end, _)| end);
    &message[..end]
}

/// Maximum number of characters of a panic message that are passed on.
const MAX_MESSAGE_CHARS: usize = 2000;

fn first_panic() -> String {
    FIRST_PANIC.lock().ok().and_then(|mut first| first.take()).unwrap_or_else(|| "(no message)".to_owned())
}
