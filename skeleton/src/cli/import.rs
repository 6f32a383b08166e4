//! Starting the program that converts glTF files: it is a package of its own, so that this one is built without it.

use std::env;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};

use super::exit::Exit;
use super::messages;

/// The arguments of `arty import …` after these words; `None` for any other command line.
pub(super) fn requested(arguments: impl Iterator<Item = OsString>) -> Option<Vec<OsString>> {
    let mut arguments = arguments.skip(1);
    (arguments.next()? == "import").then(|| arguments.collect())
}

/// Lets Cargo build and run the program.
pub(super) fn run(arguments: Vec<OsString>) -> ExitCode {
    // `cargo run` tells where Cargo is.
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    let status = Command::new(cargo)
        .args(["run", "--release", "--bin", "arty-import", "--manifest-path"])
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
            messages::error(format_args!("`arty import` needs Cargo, which could not be started: {error}"));
            Exit::Broken.into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_word_asks_for_an_import() {
        let requested = |line: &str| requested(line.split(' ').map(OsString::from));
        assert_eq!(
            requested("arty import a.glb --overwrite"),
            Some(vec!["a.glb".into(), "--overwrite".into()])
        );
        assert_eq!(requested("arty import"), Some(Vec::new()));
        for line in ["arty", "arty a.yml import", "arty ./import"] {
            assert_eq!(requested(line), None, "{line}");
        }
    }
}
