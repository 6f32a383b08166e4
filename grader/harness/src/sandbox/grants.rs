//! Files that the compiler may read and programs that it may start.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Files and folders, by paths without symbolic links.
#[derive(Clone, Debug, Default)]
pub struct Grants {
    /// Files, and folders with everything in them, that may be read.
    pub read: BTreeSet<PathBuf>,
    /// Programs that may be started, and folders of programs.
    pub execute: BTreeSet<PathBuf>,
}

impl Grants {
    /// Whatever rustc needs to compile and link a program: its own files, those of the C compiler that links, and the
    /// folders of the libraries that the submission is linked against.
    pub(crate) fn of_toolchain(rustc: &Path, sysroot: &Path, libraries: &[&Path]) -> Self {
        let mut grants = Self::default();
        grants.execute(rustc);
        grants.read(&sysroot.join("lib"));
        grants.execute(&sysroot.join("lib/rustlib"));
        for folder in libraries {
            grants.read(folder);
        }
        for loader in loaders() {
            grants.execute(&loader);
            grants.read_folder_of(&loader);
        }
        if let Some(linker) = linker() {
            grants.execute(&linker);
            for program in ["collect2", "ld", "ld.lld"] {
                // A bare name is to be found in the search path.
                let named = ask(&linker, &format!("-print-prog-name={program}"));
                let Some(path) = named.and_then(|path| find(&path)) else { continue };
                grants.execute(&path);
                // Its plugins lie beside the compiler's own program.
                if program == "collect2" {
                    grants.read_folder_of(&path);
                }
            }
            for file in ["libc.so.6", "crt1.o", "crtbegin.o", "libgcc_s.so.1", "libgcc.a"] {
                if let Some(path) = ask(&linker, &format!("-print-file-name={file}")) {
                    grants.read_folder_of(&path);
                }
            }
        }
        grants
    }

    fn read(&mut self, path: &Path) {
        self.read.extend(path.canonicalize());
    }

    /// Adds programs. They may be read, too: some are scripts.
    fn execute(&mut self, path: &Path) {
        self.read(path);
        self.execute.extend(path.canonicalize());
    }

    /// Folders of a file: that of its path, and that of the file itself if the path is a symbolic link.
    fn read_folder_of(&mut self, file: &Path) {
        let real = file.canonicalize().ok();
        for folder in [Some(file), real.as_deref()].into_iter().flatten().filter_map(Path::parent) {
            // A name without a folder is one that the compiler does not know.
            if folder.is_absolute() {
                self.read(folder);
            }
        }
    }
}

/// Dynamic loaders, which the kernel starts before any other program; known from those of this process.
pub(super) fn loaders() -> BTreeSet<PathBuf> {
    let is_loader =
        |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("ld-"));
    mapped().into_iter().filter(is_loader).collect()
}

/// Files mapped into this process, among them its loader and its shared libraries.
pub(super) fn mapped() -> BTreeSet<PathBuf> {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap_or_default();
    maps.lines().filter_map(|line| line.find('/').map(|start| PathBuf::from(&line[start..]))).collect()
}

/// Path of the C compiler that rustc links with.
pub fn linker() -> Option<PathBuf> {
    find(Path::new("cc"))
}

/// First program of that name in the search path.
fn find(name: &Path) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// Asks a C compiler for the path of one of its files.
pub(super) fn ask(compiler: &Path, question: &str) -> Option<PathBuf> {
    let output = Command::new(compiler)
        .arg(question)
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    let answer = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    (!answer.is_empty()).then(|| PathBuf::from(answer))
}
