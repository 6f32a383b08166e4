//! What a person sees while the checks of a grade run. All of it goes to standard error.

use std::io::{IsTerminal, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use verdict::check::{CheckResult, Verdict};

use crate::terminal::{loud, one_line, paint};
use crate::words::explanation;

/// A bar with what fails above it on a terminal; a line for each check elsewhere.
pub struct Progress {
    bar: ProgressBar,
    kind: Kind,
    passed: usize,
    done: usize,
}

#[derive(PartialEq)]
enum Kind {
    Terminal,
    Lines,
    Hidden,
}

impl Progress {
    /// As standard error is: a terminal or not.
    pub fn new() -> Self {
        let kind = if std::io::stderr().is_terminal() { Kind::Terminal } else { Kind::Lines };
        Self { bar: ProgressBar::hidden(), kind, passed: 0, done: 0 }
    }

    /// Nothing is shown.
    pub fn hidden() -> Self {
        Self { bar: ProgressBar::hidden(), kind: Kind::Hidden, passed: 0, done: 0 }
    }

    /// A sentence that stays.
    pub fn say(&self, text: &str) {
        match self.kind {
            Kind::Terminal => self.bar.suspend(|| write_line(text)),
            Kind::Lines => write_line(text),
            Kind::Hidden => {}
        }
    }

    /// Something of unknown length begins.
    pub fn begin(&mut self, what: &str) {
        if self.kind == Kind::Terminal {
            self.bar = ProgressBar::new_spinner().with_message(what.to_owned());
            self.bar.enable_steady_tick(Duration::from_millis(150));
        }
    }

    /// So many checks will be run, after the submission is compiled.
    pub fn expect(&mut self, checks: usize) {
        if self.kind == Kind::Terminal {
            self.bar.finish_and_clear();
            self.bar = ProgressBar::new(checks as u64).with_message("compiling");
            if let Ok(style) = ProgressStyle::with_template("{bar:24} {pos} of {len} checks, {msg}") {
                self.bar.set_style(style);
            }
            self.bar.enable_steady_tick(Duration::from_millis(150));
        }
    }

    /// A check has ended.
    pub fn ended(&mut self, check: &CheckResult) {
        self.done += 1;
        self.passed += usize::from(check.verdict == Verdict::Pass);
        let line = || format!("{:>12}  {}  {}", loud(&check.verdict), check.id, explanation(check));
        match self.kind {
            Kind::Terminal => {
                if check.verdict != Verdict::Pass {
                    let line = paint(&check.verdict, &one_line(&line()));
                    self.bar.suspend(|| write_line(&line));
                }
                self.bar.set_message(format!("{} passed", self.passed));
                self.bar.inc(1);
            }
            Kind::Lines => write_line(&line()),
            Kind::Hidden => {}
        }
    }

    /// All have ended.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Writes a line, whether or not anybody reads it.
fn write_line(text: &str) {
    let _ = writeln!(anstream::stderr(), "{text}");
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}
