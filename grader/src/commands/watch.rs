//! `grader grade --watch`.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use super::intake::reader;
use ::intake::Wanted;
use notify_debouncer_mini::new_debouncer;
use notify_debouncer_mini::notify::{self, RecursiveMode};

use harness::workspace::Workspace;
use judge::grade::{Grader, Options};
use present::page::write_watched_pages;
use present::summary_since;
use verdict::check::Verdict;
use verdict::error::{Error, Result};
use verdict::report::Report;
use verdict::submission::Submission;

/// Time without changes after which a save counts as complete.
const QUIET: Duration = Duration::from_millis(150);

/// Maximum number of lines of the compiler's messages: usually those of the first error.
const MESSAGE_LINES: usize = 24;

/// Grades a submission now and on every change until interrupted. Faults of the submission, and a file that is missing
/// for a moment, are shown and end nothing.
///
/// # Errors
/// If the folder of the submission cannot be watched.
pub(super) fn watch(
    workspace: &Workspace,
    path: &Path,
    wanted: &Wanted,
    options: &Options,
    file: &Path,
) -> Result<()> {
    let (sender, changes) = channel();
    let trouble =
        |error: notify::Error| Error::Harness(format!("{}: cannot be watched: {error}", path.display()));
    let mut debouncer = new_debouncer(QUIET, sender).map_err(trouble)?;
    // The folder, not the file: many editors write another file and give it the name.
    let (folder, mode) = if path.is_dir() {
        (path.to_owned(), RecursiveMode::Recursive)
    } else {
        (folder_of(path), RecursiveMode::NonRecursive)
    };
    debouncer.watcher().watch(&folder, mode).map_err(trouble)?;

    let grader = Grader::new(workspace, options)?;
    let (mut last, mut earlier) = (None, None);
    loop {
        match reader().read(path, wanted) {
            Ok(submission) if last.as_ref() == Some(&submission.hash()) => {}
            Ok(submission) => {
                last = Some(submission.hash());
                let (text, report) = grade_once(&grader, &submission, file, earlier.as_ref());
                show(&text, path);
                // A file that does not compile has no checks to compare with.
                earlier = report.filter(|report| !report.checks.is_empty()).or(earlier);
            }
            Err(error) => {
                last = None;
                show(&format!("waiting: {error}"), path);
            }
        }
        if !wait_for(&changes) {
            return Err(Error::Harness(format!("{}: can no longer be watched", path.display())));
        }
    }
}

/// Waits for a change, and drops others that have arrived meanwhile; false if there will be no more.
fn wait_for<T>(changes: &Receiver<T>) -> bool {
    let more = changes.recv().is_ok();
    while changes.try_recv().is_ok() {}
    more
}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

/// Grades, and returns what to show and the report. The number of checks is drawn again after each check.
fn grade_once(
    grader: &Grader,
    submission: &Submission,
    file: &Path,
    earlier: Option<&Report>,
) -> (String, Option<Report>) {
    let (mut done, mut passed) = (0, 0);
    show("compiling …", &submission.path);
    let graded = grader.grade(submission, |check| {
        done += 1;
        passed += usize::from(check.verdict == Verdict::Pass);
        if std::io::stdout().is_terminal() {
            show(&format!("{done} of {} checks, {passed} passed …", grader.planned()), &submission.path);
        }
    });
    let report = match graded {
        Ok(report) => report,
        Err(error) => return (format!("error: {error}"), None),
    };
    let mut text = finished(&report, earlier);
    let saved = report.save(file).and_then(|()| write_watched_pages(&report, file));
    if let Err(error) = saved {
        text += &format!("\nerror: {error}");
    }
    (text, Some(report))
}

/// Clears the screen and shows a text; in a pipe, texts follow each other.
fn show(text: &str, path: &Path) {
    let mut out = anstream::stdout().lock();
    let clear = if out.is_terminal() { "\x1b[2J\x1b[3J\x1b[H" } else { "" };
    // The reader may be gone.
    let _ = writeln!(out, "{clear}{} (Ctrl-C to stop)\n{text}", path.display());
    let _ = out.flush();
}

/// The text at the end of a grade.
fn finished(report: &Report, earlier: Option<&Report>) -> String {
    if let Some(failure) = &report.submission.build_failure {
        let lines: Vec<&str> = failure.messages.lines().collect();
        let more = lines.len().saturating_sub(MESSAGE_LINES);
        let mut text =
            format!("the submission does not compile:\n\n{}", lines[..lines.len() - more].join("\n"));
        if more > 0 {
            text += &format!("\n… and {more} more lines: save again after fixing these");
        }
        return text;
    }
    summary_since(report, earlier)
}
