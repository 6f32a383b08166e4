//! Keeping the pipe to the grader apart from what a submission reads and prints.

use std::fs::File;
use std::io;

/// The pipe: where requests come from, and where responses go.
///
/// Afterwards standard input is empty, and what is printed to standard output goes to standard error.
#[cfg(unix)]
pub(crate) fn take() -> io::Result<(File, File)> {
    use std::os::fd::AsFd;

    let input = io::stdin().as_fd().try_clone_to_owned()?;
    let output = io::stdout().as_fd().try_clone_to_owned()?;
    rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
    rustix::stdio::dup2_stdout(io::stderr())?;
    Ok((input.into(), output.into()))
}

/// The pipe: where requests come from, and where responses go. A submission that prints to standard output garbles
/// its own answers here.
#[cfg(windows)]
pub(crate) fn take() -> io::Result<(File, File)> {
    use std::os::windows::io::AsHandle;

    let input = io::stdin().as_handle().try_clone_to_owned()?;
    let output = io::stdout().as_handle().try_clone_to_owned()?;
    Ok((input.into(), output.into()))
}
