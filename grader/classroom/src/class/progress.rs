//! Progress of grading a class, on standard error.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use present::streams::note;
use verdict::check::{CheckResult, Verdict};

/// A live table on a terminal, one line per submission elsewhere.
pub(super) struct Progress {
    all: Option<MultiProgress>,
    total: ProgressBar,
    count: usize,
}

/// The line of one worker, hidden where there is no terminal.
pub(super) struct Line {
    bar: Option<ProgressBar>,
    passed: usize,
    done: usize,
}

impl Progress {
    pub(super) fn new(count: usize) -> Self {
        let all = std::io::stderr().is_terminal().then(MultiProgress::new);
        let total =
            all.as_ref().map_or_else(ProgressBar::hidden, |all| all.add(ProgressBar::new(count as u64)));
        if let Ok(style) =
            ProgressStyle::with_template("{bar:30} {pos} of {len} submissions, {elapsed} ({eta} to go)")
        {
            total.set_style(style);
        }
        Self { all, total, count }
    }

    /// Adds a line for a worker.
    pub(super) fn line(&self) -> Line {
        let bar = self.all.as_ref().map(|all| {
            let bar = all.add(ProgressBar::new_spinner());
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        Line { bar, passed: 0, done: 0 }
    }

    /// Counts one more submission as graded and prints its row.
    pub(super) fn ended(&self, number: usize, text: &str) {
        match &self.all {
            // A terminal that is gone does not end the run.
            Some(all) => drop(all.println(text)),
            None => note(format_args!("{number}/{} {text}", self.count)),
        }
        self.total.inc(1);
    }

    pub(super) fn finish(&self) {
        self.total.finish();
    }
}

impl Line {
    /// Shows that a submission is being compiled.
    pub(super) fn begin(&mut self, student: &str) {
        (self.passed, self.done) = (0, 0);
        if let Some(bar) = &self.bar {
            bar.set_prefix(student.to_owned());
            bar.set_message(format!("{student}: compiling"));
        }
    }

    /// Shows that a check has ended.
    pub(super) fn check(&mut self, check: &CheckResult) {
        self.done += 1;
        self.passed += usize::from(check.verdict == Verdict::Pass);
        if let Some(bar) = &self.bar {
            bar.set_message(format!("{}: {} of {} checks passed", bar.prefix(), self.passed, self.done));
        }
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
