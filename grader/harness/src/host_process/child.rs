//! Starting a program, its pipes, and its end.

use std::io::{BufReader, ErrorKind, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use host::protocol::Response;

use super::expected::Expected;

/// Starts a program whose file may have been written a moment ago.
///
/// While another thread is between fork and exec, its child holds all open files of this process, and a file that is
/// open for writing cannot be executed: then starting is tried again.
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

/// True if the kernel ended a process because it started a thread
/// ([`host_filters`](host::confine::seccomp::host_filters)).
pub(super) fn started_thread(status: ExitStatus) -> bool {
    #[cfg(target_os = "linux")]
    return std::os::unix::process::ExitStatusExt::signal(&status)
        == Some(rustix::process::Signal::SYS.as_raw());
    #[cfg(not(target_os = "linux"))]
    {
        let _ = status;
        false
    }
}

/// Exit status of a process, and what it may mean.
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

/// Starts a thread that writes messages, so that a process that does not read them blocks nothing else.
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

/// Starts a thread that reads each answer when it is expected. Anything else stays in the pipe.
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
