//! Starting this program again after it was compiled, and what a panic says.

use std::process::Command;
use std::sync::Mutex;
use std::sync::PoisonError;

use crate::args::Args;

/// Replaces this process by a new one of the same program. Returns only if that fails: why.
pub(super) fn restart(args: &Args) -> String {
    let mut command = match std::env::current_exe() {
        // Where Linux finds that the file was replaced.
        Ok(program) => Command::new(program.to_string_lossy().trim_end_matches(" (deleted)")),
        Err(error) => return format!("cannot start again: {error}"),
    };
    command.args(args.to_line());
    #[cfg(unix)]
    {
        let error = std::os::unix::process::CommandExt::exec(&mut command);
        format!("cannot start again: {error}")
    }
    #[cfg(not(unix))]
    match command.spawn() {
        Ok(_) => std::process::exit(0),
        Err(error) => format!("cannot start again: {error}"),
    }
}

static FIRST_PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Keeps the message of the first panic, and prints only that one: every pixel may panic.
pub(super) fn keep_first_panic() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let mut first = FIRST_PANIC.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() {
            let text = info.payload().downcast_ref::<&str>().copied();
            let text = text.or_else(|| info.payload().downcast_ref::<String>().map(String::as_str));
            let message = text.unwrap_or("a value that is not text");
            let place = info.location().map_or(String::new(), |at| format!(" ({}:{})", at.file(), at.line()));
            *first = Some(format!("{message}{place}"));
            drop(first);
            usual(info);
        }
    }));
}

/// What the first panic said, and where it was.
pub(super) fn first_panic() -> String {
    FIRST_PANIC.lock().unwrap_or_else(PoisonError::into_inner).clone().unwrap_or_default()
}
