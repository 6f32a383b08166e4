//! What sandbox hand-ins get on this machine, found out with an empty one before any code of a student is compiled.

use crate::build::{EMPTY_HAND_IN, Framework, compile};
use crate::host_process::HostProcess;
use crate::sandbox::{Level, Limits};
use verdict::error::{Error, Result};
use verdict::report::Sandbox;

/// Refuses a machine whose sandbox is worse than `limits.least`. A machine on which nothing compiles or starts is not
/// refused here: it says so of each hand-in, and earlier results are kept.
///
/// # Errors
/// If the sandbox is worse.
pub fn require_on_this_machine(framework: &Framework, limits: &Limits) -> Result<()> {
    if limits.least == Level::None {
        return Ok(());
    }
    let Ok(Ok(program)) = compile(framework, EMPTY_HAND_IN, limits) else { return Ok(()) };
    let Ok(host) = HostProcess::start(&program, 1) else { return Ok(()) };
    require(&Sandbox::new(program.layers, host.layers(), Vec::new()), limits.least)
}

/// Refuses a sandbox that is worse than `least`.
///
/// # Errors
/// If it is.
pub fn require(sandbox: &Sandbox, least: Level) -> Result<()> {
    if sandbox.level >= least {
        return Ok(());
    }
    let Sandbox { level, missing, .. } = sandbox;
    Err(Error::Input(format!(
        "the sandbox is `{level}` here ({missing}), and `{least}` is asked for: see `grader doctor`, or give \
         --allow-sandbox={level} if you trust everybody whose file is graded"
    )))
}
