//! The compiler that Cargo would use.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use verdict::error::{Error, Result};

/// A Rust compiler.
pub(super) struct Compiler {
    /// Path of rustc.
    pub(super) rustc: PathBuf,
    /// Folder of its libraries (the sysroot).
    pub(super) sysroot: PathBuf,
    /// Output of `rustc -vV`; the first line is name and version.
    pub(super) version: String,
}

impl Compiler {
    /// Finds the compiler of a checkout, which may have a toolchain of its own.
    pub(super) fn of(root: &Path) -> Result<Self> {
        // Both at once: rustup's stand-in takes its time to find out whom to ask.
        let (version, sysroot) = rayon::join(|| ask(root, "-vV"), || ask(root, "--print=sysroot"));
        let (version, sysroot) = (version?, PathBuf::from(sysroot?));
        // Past the one that only looks up which compiler is meant.
        let rustc = Some(sysroot.join("bin").join(format!("rustc{}", std::env::consts::EXE_SUFFIX)))
            .filter(|rustc| rustc.is_file())
            .unwrap_or_else(named);
        Ok(Self { rustc, sysroot, version })
    }

    /// Name and version.
    pub(super) fn name(&self) -> &str {
        self.version.lines().next().unwrap_or_default()
    }
}

/// Runs rustc and returns its standard output.
fn ask(root: &Path, question: &str) -> Result<String> {
    let trouble = |what: &str| Error::Harness(format!("rustc could not be run: {what}"));
    let output = Command::new(named())
        .arg(question)
        .current_dir(root)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| trouble(&error.to_string()))?;
    if !output.status.success() {
        return Err(trouble(String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The compiler that environment variables name.
fn named() -> PathBuf {
    std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()).into()
}
