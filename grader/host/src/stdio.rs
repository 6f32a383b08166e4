//! Separates the pipe to the grader from the standard streams of a submission.

use std::fs::File;
use std::io;

/// Takes over standard input and output as the pipe to the grader: requests come from the first file, responses go to
/// the second.
///
/// Afterwards standard input is empty, and standard output is redirected to standard error.
#[cfg(unix)]
pub(crate) fn take() -> io::Result<(File, File)> {
    use std::os::fd::AsFd;

    let input = io::stdin().as_fd().try_clone_to_owned()?;
    let output = io::stdout().as_fd().try_clone_to_owned()?;
    rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
    rustix::stdio::dup2_stdout(io::stderr())?;
    Ok((input.into(), output.into()))
}

/// Takes over standard input and output as the pipe to the grader: requests come from the first file, responses go to
/// the second. On Windows, a submission that prints to standard output corrupts its own responses.
#[cfg(windows)]
pub(crate) fn take() -> io::Result<(File, File)> {
    use std::os::windows::io::AsHandle;

    let input = io::stdin().as_handle().try_clone_to_owned()?;
    let output = io::stdout().as_handle().try_clone_to_owned()?;
    Ok((input.into(), output.into()))
}
