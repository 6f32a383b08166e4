//! Systems that have no sandbox for us: macOS, Windows and others.

use std::path::Path;
use std::process::{Child, Command};
use std::time::Duration;

use verdict::sandbox::Layers;

use super::Limits;
use super::process::Profile;
use verdict::error::Result;

/// What this machine can do to confine a submission: nothing.
#[derive(Clone, Debug, Default)]
pub struct Machine;

impl Machine {
    /// The machine that this runs on.
    pub fn here() -> &'static Self {
        &Self
    }

    /// The layers that are possible here.
    pub fn layers(&self) -> Layers {
        Layers::default()
    }

    /// What could be done for a better level.
    pub fn advice(&self) -> Vec<String> {
        vec!["only Linux has a sandbox for submissions: grade files of others there".to_owned()]
    }
}

pub(super) fn confine(_: &mut Command, _: Profile<'_>, _: &Limits) -> Result<Layers> {
    Ok(Layers::default())
}

/// The processor time that a process has had, all threads together: not known here.
pub(crate) fn processor_time(_: &Child) -> Option<Duration> {
    None
}

/// These layers, without what the system denies of a process: it tells nothing here.
pub(crate) fn confirmed(_: &Child, set: Layers) -> Layers {
    set
}

/// How many processes the system has ended for want of memory: not known here.
pub(crate) fn out_of_memory_kills() -> Option<u64> {
    None
}

/// The user that a submission is compiled and run as: that of the grader, here.
#[derive(Debug)]
pub(crate) struct Account;

impl Account {
    /// Takes it.
    ///
    /// # Errors
    /// None here.
    pub(crate) fn take() -> Result<Self> {
        Ok(Self)
    }

    /// Gives it a folder and its files: they are its own, here.
    ///
    /// # Errors
    /// None here.
    pub(crate) fn own(&self, _: &Path) -> Result<()> {
        Ok(())
    }
}
