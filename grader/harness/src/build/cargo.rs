//! Cargo's build of the framework.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::Deserialize;

use super::compiler::Compiler;
use crate::workspace::Workspace;
use verdict::error::{Error, Result};

/// Arguments of Cargo.
const ARGUMENTS: [&str; 8] =
    ["build", "--package", "host", "--features", "serve", "--profile", "grading", "--locked"];

/// Paths of the compiled libraries in Cargo's target folder.
pub(super) struct Libraries {
    /// The library `arty`.
    pub(super) arty: PathBuf,
    /// The library `host`.
    pub(super) host: PathBuf,
    /// All of their dependencies.
    pub(super) all: Vec<PathBuf>,
}

impl Libraries {
    /// Folder of the dependencies.
    pub(super) fn dependencies(&self) -> PathBuf {
        // Cargo names the copy of a library beside the profile's programs; what it needs lies in `deps`.
        let folder = self.arty.parent().unwrap_or(Path::new("."));
        if folder.ends_with("deps") { folder.to_owned() } else { folder.join("deps") }
    }
}

/// Cargo's message about a built artifact.
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

/// Builds the framework with Cargo unless it is up to date. `key` is the hash of everything it is built from.
pub(super) fn build(workspace: &Workspace, compiler: &Compiler, key: &str) -> Result<Libraries> {
    // Cargo goes by the times of files. Those of a copy or an archive may be older than what was built of others.
    let stamp = workspace.framework_target().join("key");
    if workspace.framework_target().exists()
        && !std::fs::read_to_string(&stamp).is_ok_and(|built| built == key)
    {
        let _ = std::fs::remove_file(&stamp);
        run(
            workspace,
            compiler,
            &["clean", "--package", "arty", "--package", "host", "--profile", "grading"],
        )?;
    }
    let messages = run(
        workspace,
        compiler,
        &[&ARGUMENTS[..], &["--message-format", "json-render-diagnostics"]].concat(),
    )?;
    std::fs::write(&stamp, key).map_err(|error| Error::output(&stamp, error))?;
    let artifacts: Vec<Message> = messages
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .filter(|message: &Message| message.reason == "compiler-artifact")
        .collect();
    let has_extension = |file: &Path, extension: &str| file.extension() == Some(OsStr::new(extension));
    let library = |name: &str| {
        artifacts
            .iter()
            .filter(|message| message.target.as_ref().is_some_and(|target| target.name == name))
            .flat_map(|message| &message.filenames)
            .find(|file| has_extension(file, "rlib"))
            .cloned()
            .ok_or_else(|| Error::Harness(format!("cargo built no library `{name}`")))
    };
    let files = artifacts.iter().flat_map(|message| &message.filenames);
    // Those of macros are shared libraries.
    let libraries = files
        .filter(|file| has_extension(file, "rlib") || has_extension(file, std::env::consts::DLL_EXTENSION));
    Ok(Libraries { arty: library("arty")?, host: library("host")?, all: libraries.cloned().collect() })
}

/// Runs Cargo and returns its standard output.
fn run(workspace: &Workspace, compiler: &Compiler, arguments: &[&str]) -> Result<String> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .args(arguments)
        .arg("--target-dir")
        .arg(workspace.framework_target())
        .current_dir(workspace.root())
        .stdin(Stdio::null());
    // Neither what this process was built with nor somebody's settings may change what submissions are linked against.
    for (name, _) in std::env::vars_os() {
        if decides(&name.to_string_lossy()) {
            cargo.env_remove(name);
        }
    }
    // Flags given so stand in place of all others. Sources are named alike whatever the place of the checkout.
    let mut flags = std::ffi::OsString::from("--remap-path-prefix=");
    flags.push(workspace.root());
    flags.push("=arty");
    cargo.env("CARGO_ENCODED_RUSTFLAGS", flags).env("RUSTC", &compiler.rustc);
    let output =
        cargo.output().map_err(|error| Error::Harness(format!("cargo could not be run: {error}")))?;
    if !output.status.success() {
        let messages = String::from_utf8_lossy(&output.stderr);
        return Err(Error::Harness(format!("the framework does not build:\n{messages}")));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// True for environment variables that would change what Cargo builds.
fn decides(variable: &str) -> bool {
    let beginnings = ["CARGO_PROFILE_", "CARGO_BUILD_", "CARGO_INCREMENTAL", "RUSTC_BOOTSTRAP"];
    variable.contains("RUSTFLAGS")
        || beginnings.iter().any(|beginning| variable.starts_with(beginning))
            && variable != "CARGO_BUILD_JOBS"
}
