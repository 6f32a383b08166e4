//! Recording of the calls that an integrator makes for one path, with arguments and results.
//!
//! Recording is off until [`start_recording`] enables it for the current thread.

use std::borrow::Cow;
use std::cell::{Cell, RefCell};

use super::Key;
use crate::math::{Rgb, Vec3};

/// Maximum number of calls recorded for one path; further calls are only counted.
const MAX_CALLS: usize = 10_000;

/// One call of an integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// The function, such as `Scene::intersect`.
    pub function: &'static str,
    /// Arguments.
    pub given: Vec<Value>,
    /// Results; empty for `None`.
    pub got: Vec<Value>,
}

/// A named value of a [`Call`]: a number, a vector, a colour, or a boolean as 0 or 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The name of the argument or result, or the line that is printed.
    pub name: Cow<'static, str>,
    /// The components; none for a line that is printed.
    pub numbers: Vec<f32>,
}

/// All calls of one path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The first calls, in order.
    pub calls: Vec<Call>,
    /// Number of calls that were not recorded.
    pub left_out: u64,
}

thread_local! {
    static RECORDING: Cell<bool> = const { Cell::new(false) };
    static CALLS: RefCell<Recording> = const { RefCell::new(Recording { calls: Vec::new(), left_out: 0 }) };
}

/// Starts recording on this thread.
pub fn start_recording(_: &Key) {
    CALLS.take();
    RECORDING.set(true);
}

/// Stops recording on this thread and returns the recording.
pub fn take_recording(_: &Key) -> Recording {
    RECORDING.set(false);
    CALLS.take()
}

/// Records a call if recording is enabled. `call` should call a function that is not inlined, or every submission would
/// compile it again.
#[inline]
pub(crate) fn record(call: impl FnOnce() -> Call) {
    if RECORDING.get() {
        keep(call());
    }
}

/// Records a line that the integrator prints, if recording is enabled. Otherwise the line is not even formatted.
#[inline]
pub fn record_print(line: std::fmt::Arguments<'_>) {
    record(|| {
        let line = Value { name: Cow::Owned(line.to_string()), numbers: Vec::new() };
        Call { function: "prints", given: Vec::new(), got: vec![line] }
    });
}

#[cold]
fn keep(call: Call) {
    CALLS.with_borrow_mut(|recording| {
        if recording.calls.len() < MAX_CALLS {
            recording.calls.push(call);
        } else {
            recording.left_out += 1;
        }
    });
}

impl Call {
    /// A call without arguments and results.
    pub(crate) fn new(function: &'static str) -> Self {
        Self { function, given: Vec::new(), got: Vec::new() }
    }

    /// Adds an argument.
    pub(crate) fn given(mut self, name: &'static str, value: impl Numbers) -> Self {
        self.given.push(Value { name: Cow::Borrowed(name), numbers: value.numbers() });
        self
    }

    /// Adds a result.
    pub(crate) fn got(mut self, name: &'static str, value: impl Numbers) -> Self {
        self.got.push(Value { name: Cow::Borrowed(name), numbers: value.numbers() });
        self
    }
}

/// Values that can be recorded as numbers.
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
