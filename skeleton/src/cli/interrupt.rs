//! Ctrl-C: the first asks for what is there so far, the second is obeyed at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::exit::{Exit, Failure};

/// A flag that becomes true at the first interruption (Ctrl-C, or a request to terminate). The second one ends the
/// process, with nothing saved.
///
/// # Errors
///
/// If the system does not let the program catch interruptions.
pub(super) fn stop_flag() -> Result<Arc<AtomicBool>, Failure> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
    })?;
    Ok(flag)
}
