//! What an integrator has called for one path, and what it got.
//!
//! Recording is off until [`start_recording`] switches it on for the current thread; then each call leaves a line.

use std::cell::{Cell, RefCell};

use super::Key;
use crate::math::{Rgb, Vec3};

/// Calls that are kept of one path; the rest are only counted.
const MOST_CALLS: usize = 10_000;

/// One call of an integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// What was called, as in `Scene::intersect`.
    pub function: &'static str,
    /// What it was given.
    pub given: Vec<Value>,
    /// What it gave; nothing for `None`.
    pub got: Vec<Value>,
}

/// A named value of a [`Call`]: a number, a vector or colour, or a truth value as 0 or 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// What it is, as the interface calls it.
    pub name: &'static str,
    /// Its numbers.
    pub numbers: Vec<f32>,
}

/// All calls of one path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The first of them, in order.
    pub calls: Vec<Call>,
    /// How many more there were.
    pub left_out: u64,
}

thread_local! {
    static RECORDING: Cell<bool> = const { Cell::new(false) };
    static CALLS: RefCell<Recording> = const { RefCell::new(Recording { calls: Vec::new(), left_out: 0 }) };
}

/// Begins to record the calls of this thread.
pub fn start_recording(_: &Key) {
    CALLS.take();
    RECORDING.set(true);
}

/// Ends that, and gives what was recorded.
pub fn take_recording(_: &Key) -> Recording {
    RECORDING.set(false);
    CALLS.take()
}

/// Adds a call, if anybody listens. What makes the call should be a function that is not inlined: it would be compiled
/// again with every hand-in.
#[inline]
pub(crate) fn record(call: impl FnOnce() -> Call) {
    if RECORDING.get() {
        keep(call());
    }
}

#[cold]
fn keep(call: Call) {
    CALLS.with_borrow_mut(|recording| {
        if recording.calls.len() < MOST_CALLS {
            recording.calls.push(call);
        } else {
            recording.left_out += 1;
        }
    });
}

impl Call {
    /// A call that was given and gave nothing yet.
    pub(crate) fn new(function: &'static str) -> Self {
        Self { function, given: Vec::new(), got: Vec::new() }
    }

    /// The same with something that it was given.
    pub(crate) fn given(mut self, name: &'static str, value: impl Numbers) -> Self {
        self.given.push(Value { name, numbers: value.numbers() });
        self
    }

    /// The same with something that it gave.
    pub(crate) fn got(mut self, name: &'static str, value: impl Numbers) -> Self {
        self.got.push(Value { name, numbers: value.numbers() });
        self
    }
}

/// What can be written down as numbers.
pub(crate) trait Numbers {
    fn numbers(self) -> Vec<f32>;
}

impl Numbers for f32 {
    fn numbers(self) -> Vec<f32> {
        vec![self]
    }
}

impl Numbers for (f32, f32) {
    fn numbers(self) -> Vec<f32> {
        vec![self.0, self.1]
    }
}

impl Numbers for bool {
    fn numbers(self) -> Vec<f32> {
        vec![f32::from(u8::from(self))]
    }
}

impl Numbers for usize {
    fn numbers(self) -> Vec<f32> {
        vec![self as f32]
    }
}

impl Numbers for Vec3 {
    fn numbers(self) -> Vec<f32> {
        self.to_array().to_vec()
    }
}

impl Numbers for Rgb {
    fn numbers(self) -> Vec<f32> {
        self.to_array().to_vec()
    }
}
