//! Cargo's build of the framework.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde::Deserialize;

use crate::error::{Error, Result};
use crate::workspace::Workspace;

/// What Cargo is asked for.
pub(super) const ARGUMENTS: [&str; 8] =
    ["build", "--package", "host", "--features", "serve", "--profile", "grading", "--locked"];

/// The compiled libraries, where Cargo has put them.
pub(super) struct Libraries {
    /// The library `arty`.
    pub(super) arty: PathBuf,
    /// The library `host`.
    pub(super) host: PathBuf,
    /// All that was compiled for them, too.
    pub(super) all: Vec<PathBuf>,
}

/// The part of Cargo's messages that names what was built.
#[derive(Deserialize)]
struct Message {
    reason: String,
    target: Option<Target>,
    #[serde(default)]
    filenames: Vec<PathBuf>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
}

/// Has Cargo build the framework, or find that it is up to date.
pub(super) fn build(workspace: &Workspace) -> Result<Libraries> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .args(ARGUMENTS)
        .args(["--message-format", "json-render-diagnostics", "--target-dir"])
        .arg(workspace.framework_target())
        .current_dir(workspace.root())
        .stdin(Stdio::null());
    // What this process was built with must not change what hand-ins are linked against.
    for (name, _) in std::env::vars_os() {
        if decides(&name.to_string_lossy()) {
            cargo.env_remove(name);
        }
    }
    let output =
        cargo.output().map_err(|error| Error::Harness(format!("cargo could not be run: {error}")))?;
    if !output.status.success() {
        let messages = String::from_utf8_lossy(&output.stderr);
        return Err(Error::Harness(format!("the framework does not build:\n{messages}")));
    }
    let messages = String::from_utf8_lossy(&output.stdout);
    let artifacts: Vec<Message> = messages
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .filter(|message: &Message| message.reason == "compiler-artifact")
        .collect();
    let library = |name: &str| {
        artifacts
            .iter()
            .filter(|message| message.target.as_ref().is_some_and(|target| target.name == name))
            .flat_map(|message| &message.filenames)
            .find(|file| file.extension().is_some_and(|extension| extension == "rlib"))
            .cloned()
            .ok_or_else(|| Error::Harness(format!("cargo built no library `{name}`")))
    };
    let is_library = |file: &PathBuf| {
        file.extension().is_some_and(|extension| {
            extension == "rlib" || extension == std::ffi::OsStr::new(std::env::consts::DLL_EXTENSION)
        })
    };
    Ok(Libraries {
        arty: library("arty")?,
        host: library("host")?,
        all: artifacts
            .iter()
            .flat_map(|message| &message.filenames)
            .filter(|file| is_library(file))
            .cloned()
            .collect(),
    })
}

/// True for variables by which the environment would change what Cargo builds.
fn decides(variable: &str) -> bool {
    variable.contains("RUSTFLAGS")
        || variable.starts_with("CARGO_PROFILE_")
        || variable == "CARGO_BUILD_TARGET"
}
