//! Ctrl-C: the first one stops rendering and saves the image, the second one quits immediately.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::exit::{Exit, Failure};
use super::messages;

/// A flag that becomes true at the first interruption (Ctrl-C or SIGTERM). The second one ends the process without
/// saving anything.
///
/// # Errors
///
/// If the signal handler cannot be installed.
pub(super) fn stop_flag() -> Result<Arc<AtomicBool>, Failure> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
        // A path that never ends keeps the rendering from stopping: without an answer, nobody tries again.
        messages::plain("stopping, and saving the image; Ctrl-C again quits without saving");
    })?;
    Ok(flag)
}
