//! Progress display: a bar on a terminal, otherwise a line every few seconds.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::messages;
use super::numbers::{clock, counted, speed};
use super::passes::Passes;
use super::plan::Plan;

/// The state of a rendering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    /// Fraction of the work done, in [0, 1].
    pub(super) fraction: f64,
    pub(super) elapsed: Duration,
    /// Samples per pixel so far.
    pub(super) samples: u64,
    /// Samples of all pixels per second.
    pub(super) speed: f64,
}

impl State {
    /// The state after some passes.
    pub(super) fn new(passes: &Passes, elapsed: Duration, plan: &Plan) -> Self {
        let samples = passes.done();
        let all = samples as f64 * f64::from(plan.width) * f64::from(plan.height);
        let speed = all / elapsed.as_secs_f64().max(1e-9);
        Self { fraction: passes.fraction(elapsed), elapsed, samples, speed }
    }

    /// Estimated remaining time.
    fn remaining(&self) -> Duration {
        let seconds = self.elapsed.as_secs_f64() * (1.0 / self.fraction - 1.0);
        Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
    }

    /// The text after the percentage and the elapsed time.
    fn rest(&self) -> String {
        let samples = counted(self.samples, "sample");
        format!("{}  {samples} per pixel  {} left", speed(self.speed), clock(self.remaining()))
    }
}

/// How progress is shown.
#[derive(Debug)]
pub(super) enum Progress {
    /// Not at all.
    Hidden,
    /// As a bar on a terminal.
    Bar(ProgressBar),
    /// As a line every few seconds.
    Lines {
        /// When the next line is due.
        next: Instant,
    },
}

/// Resolution of the bar.
const STEPS: u64 = 1000;
/// Interval between lines.
const LINE_PERIOD: Duration = Duration::from_secs(10);

impl Progress {
    /// A bar on a terminal, lines if standard error is redirected, nothing if `quiet`.
    pub(super) fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Hidden;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines { next: Instant::now() + LINE_PERIOD };
        }
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {elapsed_precise}  {msg}");
        let bar = ProgressBar::new(STEPS).with_style(style.expect("the template is valid"));
        // Keeps the clock running during a long pass.
        bar.enable_steady_tick(Duration::from_millis(500));
        Self::Bar(bar)
    }

    /// Shows the state if an update is due.
    pub(super) fn update(&mut self, state: &State) {
        match self {
            Self::Hidden => {}
            Self::Bar(bar) => {
                bar.set_position((state.fraction * STEPS as f64) as u64);
                bar.set_message(state.rest());
            }
            Self::Lines { next } => {
                let now = Instant::now();
                if now >= *next {
                    *next = now + LINE_PERIOD;
                    let percent = 100.0 * state.fraction;
                    messages::plain(format_args!(
                        "{percent:3.0} %  {}  {}",
                        clock(state.elapsed),
                        state.rest()
                    ));
                }
            }
        }
    }

    /// Prints something else without disturbing the bar.
    pub(super) fn interject(&self, speak: impl FnOnce()) {
        match self {
            Self::Bar(bar) => bar.suspend(speak),
            Self::Hidden | Self::Lines { .. } => speak(),
        }
    }

    /// Removes the bar.
    pub(super) fn finish(self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_shows_the_remaining_time() {
        let elapsed = Duration::from_secs(30);
        let state = State { fraction: 0.25, elapsed, samples: 16, speed: 2.5e6 };
        assert_eq!(state.rest(), "2.50 M samples/s  16 samples per pixel  1:30 left");
        let hopeless = State { fraction: 1e-300, ..state };
        assert_eq!(hopeless.remaining(), Duration::MAX);
    }
}
