//! What reading a submission has cost so far, over all folders, archives and repositories in it.

use std::cell::{Cell, RefCell};
use std::io::Read;
use std::rc::Rc;
use std::time::Duration;

use cpu_time::ThreadTime;

use super::{Refusal, limits};

/// Reading was stopped; [`Budget::exceeded`] has the reason.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop;

/// Counts what a submission costs, and stops reading it at the [`limits`].
#[derive(Debug)]
pub(super) struct Budget {
    entries: Cell<usize>,
    bytes: Cell<u64>,
    kept: Cell<u64>,
    /// Processor time: a busy machine refuses nobody.
    start: ThreadTime,
    exceeded: RefCell<Option<Refusal>>,
}

impl Budget {
    /// A budget of which nothing is used.
    pub(super) fn new() -> Rc<Self> {
        Rc::new(Self {
            entries: Cell::default(),
            bytes: Cell::default(),
            kept: Cell::default(),
            start: ThreadTime::now(),
            exceeded: RefCell::default(),
        })
    }

    /// Counts an entry of a folder, archive or repository.
    pub(super) fn entry(&self) -> Result<(), Stop> {
        self.entries.set(self.entries.get() + 1);
        if self.entries.get() > limits::ENTRIES {
            return Err(self.exceed(format!("more than {} files", limits::ENTRIES)));
        }
        Ok(())
    }

    /// Counts bytes that were read or unpacked, and looks at the clock.
    pub(super) fn bytes(&self, count: u64) -> Result<(), Stop> {
        self.bytes.set(self.bytes.get().saturating_add(count));
        if self.bytes.get() > limits::BYTES {
            return Err(self.exceed(format!("more than {} bytes", limits::BYTES)));
        }
        if self.start.elapsed() > Duration::from_secs(limits::SECONDS) {
            return Err(self.exceed(format!("reading it takes more than {} seconds", limits::SECONDS)));
        }
        Ok(())
    }

    /// Counts bytes of sources that stay in memory.
    pub(super) fn keep(&self, count: u64) -> Result<(), Stop> {
        self.kept.set(self.kept.get().saturating_add(count));
        if self.kept.get() > limits::KEPT {
            return Err(self.exceed(format!("more than {} bytes of sources", limits::KEPT)));
        }
        Ok(())
    }

    /// Stops reading. The first reason stays.
    pub(super) fn exceed(&self, why: String) -> Stop {
        self.exceeded.borrow_mut().get_or_insert(Refusal::Bomb(why));
        Stop
    }

    /// Why reading was stopped; `None` if it was not.
    pub(super) fn exceeded(&self) -> Option<Refusal> {
        self.exceeded.borrow().clone()
    }

    /// Reads to the end; `None` if there are more than `max` bytes. The inner error is that of the reader.
    pub(super) fn read(
        self: &Rc<Self>,
        reader: &mut dyn Read,
        max: u64,
    ) -> Result<std::io::Result<Option<Vec<u8>>>, Stop> {
        let mut bytes = Vec::new();
        let outcome = Metered::new(reader, self).take(max + 1).read_to_end(&mut bytes);
        if self.exceeded.borrow().is_some() {
            return Err(Stop);
        }
        Ok(outcome.map(|_| (bytes.len() as u64 <= max).then_some(bytes)))
    }
}

/// A reader whose bytes are counted. It fails when the budget is exceeded.
pub(super) struct Metered<R> {
    inner: R,
    budget: Rc<Budget>,
}

impl<R: Read> Metered<R> {
    pub(super) fn new(inner: R, budget: &Rc<Budget>) -> Self {
        Self { inner, budget: Rc::clone(budget) }
    }
}

impl<R: Read> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.inner.read(buffer)?;
        let stopped = |Stop| std::io::Error::other("a limit of intake");
        self.budget.bytes(count as u64).map_err(stopped)?;
        Ok(count)
    }
}
