//! The prebuilt framework that every hand-in is linked against.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::Deserialize;

use crate::error::{Error, Result};
use crate::sandbox::Grants;
use crate::workspace::Workspace;

/// The compiled libraries of the framework, as Cargo built them from this checkout.
///
/// The hand-in has no part in this build: no file of it ever reaches Cargo.
#[derive(Clone, Debug)]
pub struct Framework {
    /// The library `arty`.
    pub arty: PathBuf,
    /// The library `host`.
    pub host: PathBuf,
    /// The folder with these and all that they need.
    pub dependencies: PathBuf,
    /// The compiler, as it names itself.
    pub toolchain: String,
    /// The compiler's program.
    pub rustc: PathBuf,
    /// What the compiler needs to be granted.
    pub grants: Grants,
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

impl Framework {
    /// Builds the framework, or finds that it is up to date.
    pub fn build(workspace: &Workspace) -> Result<Self> {
        let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["build", "--package", "host", "--features", "serve", "--profile", "grading", "--locked"])
            .args(["--message-format", "json-render-diagnostics", "--target-dir"])
            .arg(workspace.framework_target())
            .current_dir(workspace.root())
            // What this process was built with must not change what hand-ins are linked against.
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env_remove("CARGO_BUILD_TARGET")
            .stdin(Stdio::null())
            .output()
            .map_err(|error| Error::Harness(format!("cargo could not be run: {error}")))?;
        if !output.status.success() {
            let messages = String::from_utf8_lossy(&output.stderr);
            return Err(Error::Harness(format!("the framework does not build:\n{messages}")));
        }
        let messages = String::from_utf8_lossy(&output.stdout);
        let library = |name: &str| {
            messages
                .lines()
                .filter_map(|line| serde_json::from_str::<Message>(line).ok())
                .filter(|message| message.reason == "compiler-artifact")
                .filter(|message| message.target.as_ref().is_some_and(|target| target.name == name))
                .flat_map(|message| message.filenames)
                .find(|file| file.extension().is_some_and(|extension| extension == "rlib"))
                .ok_or_else(|| Error::Harness(format!("cargo built no library `{name}`")))
        };
        let (arty, host) = (library("arty")?, library("host")?);
        // Cargo names the copy beside the profile's programs; the libraries it needs lie in `deps`.
        let dependencies = dependencies_folder(&arty);
        let toolchain = ask_rustc("--version")?;
        let sysroot = PathBuf::from(ask_rustc("--print=sysroot")?);
        // Past the one that only looks up which compiler is meant.
        let rustc = Some(sysroot.join("bin").join(format!("rustc{}", std::env::consts::EXE_SUFFIX)))
            .filter(|rustc| rustc.is_file())
            .unwrap_or_else(named_rustc);
        let libraries = [Some(dependencies.as_path()), arty.parent(), host.parent()];
        let libraries: Vec<&Path> = libraries.into_iter().flatten().collect();
        let grants = Grants::of_toolchain(&rustc, &sysroot, &libraries);
        Ok(Self { arty, host, dependencies, toolchain, rustc, grants })
    }
}

impl Framework {
    /// BLAKE3 over the compiled libraries.
    pub fn hash(&self) -> Result<String> {
        let mut hasher = blake3::Hasher::new();
        for library in [&self.arty, &self.host] {
            let bytes = std::fs::read(library)
                .map_err(|error| Error::Harness(format!("{}: {error}", library.display())))?;
            hasher.update(&bytes);
        }
        Ok(hasher.finalize().to_hex().to_string())
    }
}

/// What rustc answers to a question about itself.
fn ask_rustc(question: &str) -> Result<String> {
    let output = Command::new(named_rustc())
        .arg(question)
        .output()
        .map_err(|error| Error::Harness(format!("rustc could not be run: {error}")))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The compiler that Cargo would use.
fn named_rustc() -> PathBuf {
    std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()).into()
}

fn dependencies_folder(library: &Path) -> PathBuf {
    let folder = library.parent().unwrap_or(Path::new("."));
    if folder.ends_with("deps") { folder.to_owned() } else { folder.join("deps") }
}
