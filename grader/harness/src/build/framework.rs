//! The prebuilt framework that every submission is linked against.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::cargo;
use super::compiler::Compiler;
use super::kept::{self, Kept};
use super::program::Program;
use super::shape::Shape;
use crate::sandbox::Grants;
use crate::tree_hash::hash_tree;
use crate::workspace::Workspace;
use verdict::error::Result;
use verdict::rubric::StudentFile;

/// The compiled libraries of the framework, as Cargo built them from the sources of this checkout, and the program that
/// is compiled around submissions.
///
/// The submission has no part in this build: no file of it ever reaches Cargo.
#[derive(Clone, Debug)]
pub struct Framework {
    /// The library `arty`.
    pub arty: PathBuf,
    /// The library `host`.
    pub host: PathBuf,
    /// Folder of these libraries and their dependencies.
    pub dependencies: PathBuf,
    /// BLAKE3 of everything that they are built from.
    pub hash: String,
    /// Name and version of the compiler.
    pub toolchain: String,
    /// Path of rustc.
    pub rustc: PathBuf,
    /// The fixed program around submissions.
    pub program: Program,
    /// Files that the sandbox must grant to the compiler.
    pub grants: Grants,
    /// Shape of the program of an empty submission, once one has been compiled; `None` if it could not be read.
    pub(super) usual: Arc<OnceLock<Option<Shape>>>,
    /// Lock that keeps the libraries from being removed.
    kept: Option<Arc<Kept>>,
}

impl Framework {
    /// Takes the framework from the user's cache, or builds it and adds it to the cache. `file` is what students hand in.
    ///
    /// # Errors
    /// If it does not build, or if there is no compiler.
    pub fn build(workspace: &Workspace, file: &StudentFile) -> Result<Self> {
        let program = Program::around(file);
        let compiler = Compiler::of(workspace.root())?;
        let (cache_dir, key) = (kept::cache_dir(), key_of(workspace, &compiler)?);
        let find = || Kept::find(cache_dir.as_deref()?, &key);
        if let Some(kept) = find() {
            return Ok(Self::of_kept(kept, key, &compiler, program));
        }
        let built = cargo::build(workspace, &compiler, &key)?;
        // Somebody may have saved another source meanwhile, or have been faster.
        if let Some(cache_dir) = &cache_dir
            && key_of(workspace, &compiler).is_ok_and(|now| now == key)
            && find().is_none()
        {
            // Who cannot keep it uses what Cargo has built.
            let _ = Kept::keep(cache_dir, &key, &built);
        }
        Ok(match find() {
            Some(kept) => Self::of_kept(kept, key, &compiler, program),
            None => {
                let dependencies = built.dependencies();
                Self::new([built.arty, built.host, dependencies], key, &compiler, program)
            }
        })
    }

    /// True if no framework was ever built for this user or in this checkout, so that the build will take a while.
    pub fn is_first(workspace: &Workspace) -> bool {
        !workspace.framework_target().exists()
            && !kept::cache_dir().is_some_and(|cache_dir| cache_dir.exists())
    }

    fn of_kept(kept: Kept, key: String, compiler: &Compiler, program: Program) -> Self {
        let framework = Self::new([kept.arty(), kept.host(), kept.libraries()], key, compiler, program);
        Self { kept: Some(Arc::new(kept)), ..framework }
    }

    fn new(
        [arty, host, dependencies]: [PathBuf; 3],
        key: String,
        compiler: &Compiler,
        program: Program,
    ) -> Self {
        let folders = [Some(dependencies.as_path()), arty.parent(), host.parent()];
        let folders: Vec<&Path> = folders.into_iter().flatten().collect();
        Self {
            hash: key,
            toolchain: compiler.name().to_owned(),
            rustc: compiler.rustc.clone(),
            grants: Grants::of_toolchain(&compiler.rustc, &compiler.sysroot, &folders),
            program,
            arty,
            host,
            dependencies,
            usual: Arc::default(),
            kept: None,
        }
    }

    /// Hash of everything that decides how a source is compiled, except the source and the libraries.
    pub fn recipe(&self) -> blake3::Hash {
        blake3::hash(&[self.program.text.as_bytes(), include_bytes!("compile.rs")].concat())
    }

    /// True as long as the libraries are there.
    pub(super) fn is_there(&self) -> bool {
        self.arty.is_file() && self.host.is_file() && self.kept.as_ref().is_none_or(|kept| kept.is_whole())
    }
}

/// Parts of `skeleton/src` that are not compiled into the libraries: the student's file and the command line.
const NO_PART: [&str; 3] = ["algorithms", "cli", "main.rs"];

/// Hash of everything that decides what Cargo builds: arguments, sources, versions of dependencies, settings, compiler.
fn key_of(workspace: &Workspace, compiler: &Compiler) -> Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update(include_bytes!("cargo.rs"));
    hasher.update(compiler.version.as_bytes()).update(compiler.sysroot.as_os_str().as_encoded_bytes());
    let others =
        ["Cargo.toml", "Cargo.lock", "skeleton/Cargo.toml", "grader/host/Cargo.toml", "grader/host/src"];
    for path in others {
        hash_tree(&workspace.root().join(path), &[], &mut hasher)?;
    }
    hash_tree(&workspace.root().join("skeleton/src"), &NO_PART, &mut hasher)?;
    Ok(hasher.finalize().to_hex().to_string())
}
