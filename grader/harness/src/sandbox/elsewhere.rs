//! Systems without a sandbox: macOS, Windows and others.

use std::path::Path;
use std::process::{Child, Command};
use std::time::Duration;

use verdict::sandbox::Layers;

use super::Limits;
use super::process::Profile;
use verdict::error::Result;

/// Sandbox support of this machine: none.
#[derive(Clone, Debug, Default)]
pub struct Machine;

impl Machine {
    /// This machine.
    pub fn here() -> &'static Self {
        &Self
    }

    /// Layers that are available: none.
    pub fn layers(&self) -> Layers {
        Layers::default()
    }

    /// Steps that raise the sandbox level of this machine, one sentence each.
    pub fn advice(&self) -> Vec<String> {
        vec!["only Linux has a sandbox for submissions: grade files of others there".to_owned()]
    }
}

pub(super) fn confine(_: &mut Command, _: Profile<'_>, _: &Limits) -> Result<Layers> {
    Ok(Layers::default())
}

/// Processor time of a process: unknown here.
pub(crate) fn processor_time(_: &Child) -> Option<Duration> {
    None
}

/// For how long its threads were ready to run and did not: unknown here.
pub(crate) fn delay(_: &Child) -> Option<Duration> {
    None
}

/// Layers that the system confirms for a process: unknown here, so all of them.
pub(crate) fn confirmed(_: &Child, set: Layers) -> Layers {
    set
}

/// Number of processes that the system has ended for lack of memory: unknown here.
pub(crate) fn out_of_memory_kills() -> Option<u64> {
    None
}

/// User that a submission is compiled and run as: here that of the grader.
#[derive(Debug)]
pub(crate) struct Account;

impl Account {
    /// Takes a user id.
    ///
    /// # Errors
    /// Never.
    pub(crate) fn take() -> Result<Self> {
        Ok(Self)
    }

    /// Gives a folder and its files to the user, who owns them already here.
    ///
    /// # Errors
    /// Never.
    pub(crate) fn own(&self, _: &Path) -> Result<()> {
        Ok(())
    }
}
