//! Starting programs that are packages of their own, so that this one is built without them: the window, and the conversion
//! of glTF files.

use std::env;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};

use super::exit::Exit;
use super::messages;

/// The arguments of `arty import …` after these words; `None` for any other command line.
pub(super) fn import_requested(arguments: impl Iterator<Item = OsString>) -> Option<Vec<OsString>> {
    let mut arguments = arguments.skip(1);
    (arguments.next()? == "import").then(|| arguments.collect())
}

/// Converts a glTF file.
pub(super) fn import(arguments: Vec<OsString>) -> ExitCode {
    run(&["--bin", "arty-import"], arguments)
}

/// The other arguments of a command line with `--view`, whose options are those of the window; `None` for any other command
/// line, and in another program than the student's, whose algorithm the window does not have.
pub(super) fn window_requested(
    executable: &Path,
    arguments: impl Iterator<Item = OsString>,
) -> Option<Vec<OsString>> {
    let is_students = executable.file_stem().is_some_and(|name| name == "arty");
    let (view, others): (Vec<_>, Vec<_>) = arguments.skip(1).partition(|argument| argument == "--view");
    (is_students && !view.is_empty()).then_some(others)
}

/// Opens the window.
pub(super) fn window(arguments: Vec<OsString>) -> ExitCode {
    run(&["--bin", "arty-view", "--features", "arty-view/window"], arguments)
}

/// Lets Cargo build and run a program of this workspace.
fn run(program: &[&str], arguments: Vec<OsString>) -> ExitCode {
    // `cargo run` tells where Cargo is.
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    let status = Command::new(cargo)
        .args(["run", "--release"])
        .args(program)
        .arg("--manifest-path")
        .arg(manifest)
        .arg("--")
        .args(arguments)
        .status();
    match status {
        // Cargo's own failures have the status 101, and it has said why.
        Ok(status) => {
            status.code().and_then(|code| u8::try_from(code).ok()).map_or(Exit::Broken.into(), Into::into)
        }
        Err(error) => {
            messages::error(format_args!("this needs Cargo, which could not be started: {error}"));
            Exit::Broken.into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> impl Iterator<Item = OsString> {
        line.split(' ').map(OsString::from)
    }

    #[test]
    fn only_the_first_word_asks_for_an_import() {
        let requested = |line: &str| import_requested(words(line));
        assert_eq!(
            requested("arty import a.glb --overwrite"),
            Some(vec!["a.glb".into(), "--overwrite".into()])
        );
        assert_eq!(requested("arty import"), Some(Vec::new()));
        for line in ["arty", "arty a.yml import", "arty ./import"] {
            assert_eq!(requested(line), None, "{line}");
        }
    }

    #[test]
    fn only_the_students_program_has_a_window() {
        let requested = |program: &str, line| window_requested(Path::new(program), words(line));
        let line = "arty a.yml --view --watch";
        assert_eq!(requested("/x/arty", line), Some(vec!["a.yml".into(), "--watch".into()]));
        assert_eq!(requested("/x/solution", line), None);
        assert_eq!(requested("/x/arty", "arty a.yml --watch"), None);
    }
}
