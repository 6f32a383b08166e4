//! The autograder for Gradescope: a zip archive with `setup.sh`, `run_autograder` and the grader.

use std::io::Write;
use std::path::{Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::files;
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use verdict::error::{Error, Result};

const SETUP: &str = include_str!("gradescope/setup.sh");
const RUN: &str = include_str!("gradescope/run_autograder");

/// Packs the autograder of an assignment, and returns its size in bytes. Unlike a handout it contains the solution.
///
/// # Errors
/// If a file cannot be read or the archive cannot be written.
pub fn autograder(workspace: &Workspace, assignment: &Assignment, out: &Path) -> Result<usize> {
    let files = files::for_grading(workspace, assignment)?;
    let solution = assignment.solution_file();
    let solution = solution.strip_prefix(workspace.root()).unwrap_or(&solution).display().to_string();
    let bytes =
        archive(&files, &solution).map_err(|error| Error::Harness(format!("the archive: {error}")))?;
    arty::image::write_aside(out, |writer| writer.write_all(&bytes))
        .map_err(|error| Error::Output(error.to_string()))?;
    Ok(bytes.len())
}

/// The archive; equal files give equal bytes. Gradescope unpacks it at `/autograder/source`.
fn archive(files: &[(PathBuf, Vec<u8>)], solution: &str) -> zip::result::ZipResult<Vec<u8>> {
    let mut writer = ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = |mode| {
        SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::DEFAULT)
            .unix_permissions(mode)
    };
    for (name, text) in
        [("setup.sh", SETUP.replace("@SOLUTION@", solution)), ("run_autograder", RUN.to_owned())]
    {
        writer.start_file(name, options(0o755))?;
        writer.write_all(text.as_bytes())?;
    }
    for (path, bytes) in files {
        let name: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
        writer.start_file(name.join("/"), options(0o644))?;
        writer.write_all(bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}
