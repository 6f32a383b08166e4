//! Compiling the algorithm again when its file is saved.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, SystemTime};

/// Time between two looks at the file.
const PERIOD: Duration = Duration::from_millis(150);

/// Maximum number of lines of the compiler's messages: usually those of the first error.
const LINES: usize = 30;

/// What became of a saved file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reload {
    /// It is being compiled.
    Compiling,
    /// The program is compiled: start it again.
    Ready,
    /// It does not compile: the compiler's messages.
    Failed(String),
}

/// Watches a file on a thread of its own, and compiles the program with `build` when the file has changed. Ends when `tell`
/// returns false.
pub fn watch(source: PathBuf, mut build: Command, tell: impl Fn(Reload) -> bool + Send + 'static) {
    let mut last = state(&source);
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(PERIOD);
            let now = state(&source);
            // Missing for a moment: many editors write another file and give it the name.
            if now.is_none() || now == last {
                continue;
            }
            last = now;
            if !tell(Reload::Compiling) || !tell(compile(&mut build)) {
                return;
            }
        }
    });
}

/// What changes when a file is saved; `None` if there is no file.
fn state(source: &Path) -> Option<(SystemTime, u64)> {
    let metadata = std::fs::metadata(source).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// Compiles the program.
fn compile(build: &mut Command) -> Reload {
    match build.output() {
        Err(error) => Reload::Failed(format!("{}: {error}", build.get_program().display())),
        Ok(output) if output.status.success() => Reload::Ready,
        Ok(output) => Reload::Failed(beginning(&String::from_utf8_lossy(&output.stderr))),
    }
}

/// The first lines of the compiler's messages.
fn beginning(messages: &str) -> String {
    let lines: Vec<&str> = messages.lines().filter(|line| !line.trim().is_empty()).collect();
    let mut text = lines[..lines.len().min(LINES)].join("\n");
    if lines.len() > LINES {
        text += &format!("\n... and {} more lines", lines.len() - LINES);
    }
    text
}

#[cfg(all(test, unix))]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn messages_of_the_compiler_are_kept_and_cut() {
        assert_eq!(compile(&mut shell("true")), Reload::Ready);
        let failed = compile(&mut shell("echo 'error: no' >&2; echo >&2; echo '--> here' >&2; exit 101"));
        assert_eq!(failed, Reload::Failed("error: no\n--> here".to_owned()));
        let many = "line\n".repeat(100);
        assert!(beginning(&many).ends_with("\n... and 70 more lines"));
        let missing = compile(&mut Command::new("/nowhere/cargo"));
        assert!(
            matches!(&missing, Reload::Failed(why) if why.starts_with("/nowhere/cargo: ")),
            "{missing:?}"
        );
    }

    #[test]
    fn a_saved_file_is_compiled_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let (source, log) = (folder.path().join("render_pt.rs"), folder.path().join("log"));
        std::fs::write(&source, "one").expect("writing works");
        let (sender, received) = channel();
        let build = shell(&format!("echo compiled >> {}", log.display()));
        watch(source.clone(), build, move |reload| sender.send(reload).is_ok());
        std::fs::write(&source, "another").expect("writing works");
        let next = || received.recv_timeout(Duration::from_secs(20)).expect("the change is noticed");
        assert_eq!((next(), next()), (Reload::Compiling, Reload::Ready));
        assert!(received.recv_timeout(4 * PERIOD).is_err(), "nothing has changed since");
        assert_eq!(std::fs::read_to_string(log).expect("it ran"), "compiled\n");
    }
}
