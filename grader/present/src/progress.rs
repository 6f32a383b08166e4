//! What a person sees while the checks of a grade run. All of it goes to standard error.

use std::io::{IsTerminal, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use verdict::check::{CheckResult, Verdict};

use crate::terminal::{loud, one_line, paint};
use crate::words::explanation;

/// A bar with what fails above it on a terminal; a line for each check elsewhere. Either can do without the checks.
pub struct Progress {
    bar: ProgressBar,
    kind: Kind,
    /// True if each check that ends is shown.
    shows_checks: bool,
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
        Self { bar: ProgressBar::hidden(), kind, shows_checks: true, passed: 0, done: 0 }
    }

    /// The same without a line for each check.
    pub fn without_checks() -> Self {
        Self { shows_checks: false, ..Self::new() }
    }

    /// Nothing is shown.
    pub fn hidden() -> Self {
        Self { bar: ProgressBar::hidden(), kind: Kind::Hidden, shows_checks: false, passed: 0, done: 0 }
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
        // After a loop without end, nearly all checks are not run: that is said once.
        let shown = self.shows_checks && !matches!(check.verdict, Verdict::NotRun { .. });
        match self.kind {
            Kind::Terminal => {
                if shown && check.verdict != Verdict::Pass {
                    let line = paint(&check.verdict, &one_line(&line()));
                    self.bar.suspend(|| write_line(&line));
                }
                self.bar.set_message(format!("{} passed", self.passed));
                self.bar.inc(1);
            }
            Kind::Lines if shown => write_line(&line()),
            Kind::Lines | Kind::Hidden => {}
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
