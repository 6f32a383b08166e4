//! Files needed to load a submission's program, and the layers that the kernel confirms for a running one.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::sync::OnceLock;

use host::confine::landlock as files;
use landlock::{AccessFs, PathBeneath, PathFd, RulesetCreated, RulesetCreatedAttr};
use verdict::sandbox::Layers;

use super::super::grants;

/// Landlock rules for a host: its own program, the loader and the libraries that every Rust program needs.
pub(super) fn rules(program: &Path) -> Result<RulesetCreated, Box<dyn std::error::Error>> {
    let (mut ruleset, _) = files::ruleset().ok_or("the kernel has none any more")?;
    let read = AccessFs::ReadFile;
    let needed = needed();
    let executes = [program].into_iter().chain(needed.loaders.iter().map(PathBuf::as_path));
    let executes = executes.map(|path| (path, read | AccessFs::Execute));
    let reads = needed.libraries.iter().map(|path| (path.as_path(), read.into()));
    for (path, access) in executes.chain(reads) {
        let file = PathFd::new(path).map_err(|error| format!("{}: {error}", path.display()))?;
        ruleset = ruleset.add_rule(PathBeneath::new(file, access))?;
    }
    Ok(ruleset)
}

/// Files needed to load a program, besides the program itself.
struct Needed {
    loaders: BTreeSet<PathBuf>,
    /// Shared libraries, the loader's cache of their paths, and `/dev/null`.
    libraries: BTreeSet<PathBuf>,
}

/// Libraries that Rust programs are linked against; on newer systems those after the third are part of the first.
const LIBRARIES: [&str; 6] =
    ["libc.so.6", "libm.so.6", "libgcc_s.so.1", "libpthread.so.0", "libdl.so.2", "librt.so.1"];

fn needed() -> &'static Needed {
    static NEEDED: OnceLock<Needed> = OnceLock::new();
    NEEDED.get_or_init(|| {
        // The grader is a program of Rust, too.
        let mapped = grants::mapped();
        let compiler = grants::linker();
        let library = |name: &str| {
            let own = mapped.iter().find(|path| path.file_name().is_some_and(|found| found == name)).cloned();
            own.or_else(|| {
                let path = grants::ask(compiler.as_deref()?, &format!("-print-file-name={name}"))?;
                path.is_absolute().then_some(path)
            })
        };
        let others = ["/etc/ld.so.cache", "/dev/null"].map(PathBuf::from);
        let libraries = LIBRARIES.iter().filter_map(|name| library(name)).chain(others);
        Needed {
            loaders: grants::loaders(),
            libraries: libraries.filter_map(|path| path.canonicalize().ok()).collect(),
        }
    })
}

/// The layers of these that the kernel confirms for a process. To be called after its program has started and before
/// its first job.
pub(crate) fn confirmed(child: &Child, set: Layers) -> Layers {
    let Ok(status) = std::fs::read_to_string(format!("/proc/{}/status", child.id())) else { return set };
    let field = |name: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(name))?;
        Some(line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    };
    // Of one that is gone already there is nothing to see.
    if field("State:")
        .is_none_or(|state| state.first().is_none_or(|state| matches!(state.as_str(), "Z" | "X")))
    {
        return set;
    }
    let is = |name: &str, value: &str| {
        field(name).is_none_or(|found| found.first().is_some_and(|found| found == value))
    };
    let root = field("Uid:").is_some_and(|ids| ids.iter().any(|id| id == "0"));
    Layers {
        landlock: if is("NoNewPrivs:", "1") { set.landlock } else { 0 },
        seccomp: set.seccomp && is("Seccomp:", "2"),
        limits: set.limits,
        unprivileged: set.unprivileged && !root,
    }
}
