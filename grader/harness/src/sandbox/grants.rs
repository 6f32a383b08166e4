//! What a compiler needs: which files it may read, and which programs it may start.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Files and folders, as they are named without symbolic links.
#[derive(Clone, Debug, Default)]
pub struct Grants {
    /// What may be read, folders with all that is in them.
    pub read: BTreeSet<PathBuf>,
    /// Programs that may be started, likewise.
    pub execute: BTreeSet<PathBuf>,
}

impl Grants {
    /// What rustc needs to compile and link a program: its own files, those of the C compiler that it has link, and
    /// the folders of the libraries that the submission is linked against.
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

    /// Programs are read, too: they may be scripts.
    fn execute(&mut self, path: &Path) {
        self.read(path);
        self.execute.extend(path.canonicalize());
    }

    /// The folder that a file is in, as it is named, and the one where it really is.
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

/// The programs that load shared libraries, as this process has one: the kernel starts them before any other.
pub(super) fn loaders() -> BTreeSet<PathBuf> {
    let is_loader =
        |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("ld-"));
    mapped().into_iter().filter(is_loader).collect()
}

/// The files that are mapped into this process: among them its loader and its shared libraries.
pub(super) fn mapped() -> BTreeSet<PathBuf> {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap_or_default();
    maps.lines().filter_map(|line| line.find('/').map(|start| PathBuf::from(&line[start..]))).collect()
}

/// The C compiler that rustc has link.
pub fn linker() -> Option<PathBuf> {
    find(Path::new("cc"))
}

/// The first program of that name in the search path.
fn find(name: &Path) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// What a C compiler says about one of its files.
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
