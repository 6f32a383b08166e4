//! Starting the program of a submission, and talking to it without waiting for it.

use std::io::{BufReader, ErrorKind, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use host::protocol::Response;

use super::expected::Expected;

/// Starts a program, which may have been written a moment ago.
///
/// While another thread is between fork and exec, its child has all files open that this process had, and one that is
/// open for writing cannot be run.
pub(super) fn spawn(command: &mut Command) -> std::io::Result<Child> {
    for _ in 0..100 {
        match command.spawn() {
            Err(error) if error.kind() == ErrorKind::ExecutableFileBusy => {
                std::thread::sleep(Duration::from_millis(5));
            }
            other => return other,
        }
    }
    command.spawn()
}

/// How a process ended, and what that may mean.
pub(super) fn describe(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        use rustix::process::Signal;
        let is = |other: Signal| signal == other.as_raw();
        let why = if is(Signal::ABORT) {
            ": out of memory, stack overflow, or it aborted itself"
        } else if is(Signal::SEGV) {
            ": stack overflow, or memory that is not its own"
        } else {
            ""
        };
        return format!("{status}{why}");
    }
    status.to_string()
}

/// Has a thread write messages, so that a process that does not read them costs nobody else any time.
pub(super) fn send(mut pipe: ChildStdin) -> Sender<Vec<u8>> {
    let (sender, messages) = channel::<Vec<u8>>();
    std::thread::spawn(move || {
        for message in messages {
            if pipe.write_all(&message).is_err() {
                break;
            }
        }
    });
    sender
}

/// Has a thread read answers, each when it is expected and no earlier: what nobody asked for stays in the pipe.
pub(super) fn receive(pipe: ChildStdout) -> (Sender<Expected>, Receiver<std::io::Result<Option<Response>>>) {
    let (sender, responses) = channel();
    let (expected, queue) = channel::<Expected>();
    std::thread::spawn(move || {
        let mut answers = BufReader::new(pipe);
        for expected in queue {
            let message = expected.read(&mut answers);
            let last = !matches!(message, Ok(Some(_)));
            if sender.send(message).is_err() || last {
                break;
            }
        }
    });
    (expected, responses)
}
