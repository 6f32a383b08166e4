//! The prebuilt framework that every hand-in is linked against.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::cargo::{self, Libraries};
use super::compiler::Compiler;
use super::kept::{self, Kept};
use crate::error::{Error, Result};
use crate::sandbox::Grants;
use crate::tree_hash::hash_tree;
use crate::workspace::Workspace;

/// The compiled libraries of the framework, as Cargo built them from the sources of this checkout.
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
    /// BLAKE3 over the two libraries.
    pub hash: String,
    /// The folder for what is found out with it and need not be found out again.
    pub answers: PathBuf,
    /// The compiler, as it names itself.
    pub toolchain: String,
    /// The compiler's program.
    pub rustc: PathBuf,
    /// What the compiler needs to be granted.
    pub grants: Grants,
    /// Nobody removes it as long as this is there.
    _kept: Option<Arc<Kept>>,
}

impl Framework {
    /// Takes the framework from where it is kept for all checkouts of this user, or builds it and keeps it there.
    ///
    /// # Errors
    /// If it does not build, or if there is no compiler.
    pub fn build(workspace: &Workspace) -> Result<Self> {
        let compiler = Compiler::find()?;
        let (shelf, key) = (kept::shelf(), key(workspace, &compiler)?);
        let find = || Kept::find(shelf.as_deref()?, &key);
        if let Some(kept) = find() {
            return Ok(Self::kept(kept, &compiler));
        }
        let built = cargo::build(workspace)?;
        // Unless somebody has saved another source meanwhile.
        if let Some(shelf) =
            shelf.as_deref().filter(|_| self::key(workspace, &compiler).is_ok_and(|now| now == key))
        {
            // Who cannot keep it uses what Cargo has built.
            let _ = Kept::keep(shelf, &key, &built);
        }
        find()
            .map_or_else(|| Self::built(built, workspace, &compiler), |kept| Ok(Self::kept(kept, &compiler)))
    }

    /// True if none was ever built for this user or in this checkout, so that it is worth a word that it takes its time.
    pub fn is_first(workspace: &Workspace) -> bool {
        !workspace.framework_target().exists() && !kept::shelf().is_some_and(|shelf| shelf.exists())
    }

    fn kept(kept: Kept, compiler: &Compiler) -> Self {
        Self {
            arty: kept.arty(),
            host: kept.host(),
            dependencies: kept.libraries(),
            hash: kept.hash().to_owned(),
            answers: kept.folder().join(ANSWERS),
            toolchain: compiler.name().to_owned(),
            rustc: compiler.rustc.clone(),
            grants: Grants::of_toolchain(&compiler.rustc, &compiler.sysroot, &[&kept.libraries()]),
            _kept: Some(Arc::new(kept)),
        }
    }

    fn built(
        Libraries { arty, host, .. }: Libraries,
        workspace: &Workspace,
        compiler: &Compiler,
    ) -> Result<Self> {
        // Cargo names the copy of `host` beside the profile's programs; the libraries it needs lie in `deps`.
        let dependencies = dependencies_folder(&arty);
        let folders = [Some(dependencies.as_path()), arty.parent(), host.parent()];
        let folders: Vec<&Path> = folders.into_iter().flatten().collect();
        Ok(Self {
            hash: kept::hash(&arty, &host)
                .map_err(|error| Error::Harness(format!("the framework cannot be read: {error}")))?,
            answers: workspace.framework_target().join(ANSWERS),
            toolchain: compiler.name().to_owned(),
            rustc: compiler.rustc.clone(),
            grants: Grants::of_toolchain(&compiler.rustc, &compiler.sysroot, &folders),
            arty,
            host,
            dependencies,
            _kept: None,
        })
    }
}

/// The folder for answers, beside the libraries.
const ANSWERS: &str = "answers";

/// What has no part in the libraries: the student's file, the programs, tests.
const NO_PART: [&str; 4] = ["algorithms", "cli", "main.rs", "tests"];

/// Over all that decides what Cargo builds: sources and versions of dependencies, settings, the compiler.
fn key(workspace: &Workspace, compiler: &Compiler) -> Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update(cargo::ARGUMENTS.join(" ").as_bytes());
    hasher.update(compiler.version.as_bytes()).update(compiler.sysroot.as_os_str().as_encoded_bytes());
    let own = [
        "Cargo.toml",
        "Cargo.lock",
        ".cargo/config.toml",
        "skeleton/Cargo.toml",
        "skeleton/src",
        "grader/host/Cargo.toml",
        "grader/host/src",
    ];
    let settings = etcetera::home_dir().ok().map(|home| home.join(".cargo"));
    let settings = std::env::var_os("CARGO_HOME").map(PathBuf::from).or(settings);
    let settings = settings.map(|folder| folder.join("config.toml")).filter(|file| file.is_file());
    for path in own.iter().map(|name| workspace.root().join(name)).chain(settings) {
        hash_tree(&path, &NO_PART, &mut hasher)?;
    }
    Ok(hasher.finalize().to_hex().to_string())
}

fn dependencies_folder(library: &Path) -> PathBuf {
    let folder = library.parent().unwrap_or(Path::new("."));
    if folder.ends_with("deps") { folder.to_owned() } else { folder.join("deps") }
}
