//! The last commit of a git repository, read without a checkout: no hook, filter or program of the repository runs.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::collect::{Collector, Stop, read_at_most};
use super::names::{self, Kind};
use super::text::with_our_line_ends;
use super::{Note, Refusal, limits};
use verdict::error::{Error, Result};

/// Git directory of a folder: its `.git`, or the folder itself if it is a bare repository; `None` if it is neither.
pub(super) fn repository_of(folder: &Path) -> Option<PathBuf> {
    let is_repository = |folder: &Path| {
        let is_dir = |name| std::fs::symlink_metadata(folder.join(name)).is_ok_and(|entry| entry.is_dir());
        // A `.git` that is a file or a link leads to somewhere else.
        is_dir("objects") && is_dir("refs") && folder.join("HEAD").is_file()
    };
    let inner = folder.join(".git");
    let inner_is_folder = std::fs::symlink_metadata(&inner).is_ok_and(|entry| entry.is_dir());
    if inner_is_folder && is_repository(&inner) {
        Some(inner)
    } else {
        is_repository(folder).then(|| folder.to_owned())
    }
}

/// Collects the files of the last commit. The inner error means that reading was stopped by a limit.
///
/// # Errors
/// If git cannot be run.
pub(super) fn collect(
    repository: &Path,
    folder: &Path,
    collector: &mut Collector,
) -> Result<std::result::Result<(), Stop>> {
    // These two make git read files of somebody else as objects.
    for leads_out in ["objects/info/alternates", "objects/info/http-alternates", "commondir"] {
        if std::fs::symlink_metadata(repository.join(leads_out)).is_ok() {
            collector.obstacle(Refusal::Git(format!("it borrows from another one ({leads_out})")));
            return Ok(Ok(()));
        }
    }
    let listed = git(repository, &["ls-tree", "-r", "-z", "--full-tree", "HEAD"], limits::ATTACHMENT)?;
    let Some(list) = listed else {
        collector.obstacle(Refusal::Git("there is no HEAD, or it is damaged".to_owned()));
        return Ok(Ok(()));
    };
    for entry in list.split(|&byte| byte == 0).filter(|entry| !entry.is_empty()) {
        if let Err(stop) = collector.count_entry() {
            return Ok(Err(stop));
        }
        // `<mode> <type> <object>\t<path>`
        let entry = String::from_utf8_lossy(entry);
        let Some((about, name)) = entry.split_once('\t') else { continue };
        let mut about = about.split(' ');
        let (Some(mode), Some("blob"), Some(object)) = (about.next(), about.next(), about.next()) else {
            continue;
        };
        if !collector.wants(name) {
            continue;
        }
        if mode == "120000" {
            if names::kind(name) == Kind::Named {
                collector.bad_source(Refusal::Link(name.to_owned()));
            }
            continue;
        }
        let max =
            if names::kind(name) == Kind::Explanation { limits::ATTACHMENT } else { limits::SOURCE + 1 };
        let Some(blob) = git(repository, &["cat-file", "blob", object], max)? else {
            collector.obstacle(Refusal::Git(format!("{name} is damaged")));
            continue;
        };
        if names::kind(name) == Kind::Named && differs_on_disk(&folder.join(name), &blob) {
            collector.note(Note::Uncommitted(name.to_owned()));
        }
        // Archives in a repository are nobody's submission.
        if !matches!(names::kind(name), Kind::Archive | Kind::UnknownArchive)
            && let Err(stop) = collector.offer(name, &mut blob.as_slice(), 0)
        {
            return Ok(Err(stop));
        }
    }
    Ok(Ok(()))
}

/// True if the file exists on disk and differs from the committed one.
fn differs_on_disk(path: &Path, blob: &[u8]) -> bool {
    let text = |bytes: &[u8]| with_our_line_ends(&String::from_utf8_lossy(bytes));
    let is_file = std::fs::symlink_metadata(path).is_ok_and(|entry| entry.is_file());
    let read = || std::fs::File::open(path).and_then(|mut file| read_at_most(&mut file, limits::SOURCE));
    is_file && matches!(read(), Ok(Some(bytes)) if text(&bytes) != text(blob))
}

/// Runs git and returns at most `max` bytes of its output; `None` if git fails.
fn git(repository: &Path, arguments: &[&str], max: u64) -> Result<Option<Vec<u8>>> {
    let mut command = Command::new("git");
    command
        .arg("--no-replace-objects")
        .arg("--git-dir")
        .arg(repository)
        // Whose files these are is of no interest: nothing of the repository is run.
        .args(["-c", "safe.directory=*", "-c", "core.hooksPath=/dev/null", "-c", "core.fsmonitor=false"])
        .args(["-c", "protocol.allow=never"])
        .args(arguments)
        .env_clear()
        .env("GIT_CONFIG_NOSYSTEM", "1")
        .env("GIT_CONFIG_GLOBAL", if cfg!(windows) { "NUL" } else { "/dev/null" })
        .env("GIT_NO_LAZY_FETCH", "1")
        .env("GIT_OPTIONAL_LOCKS", "0")
        .env("GIT_TERMINAL_PROMPT", "0")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null());
    for kept in ["PATH", "SystemRoot"] {
        if let Some(value) = std::env::var_os(kept) {
            command.env(kept, value);
        }
    }
    let trouble = |error: std::io::Error| Error::Harness(format!("git could not be run: {error}"));
    let mut child = command.spawn().map_err(trouble)?;
    let mut bytes = Vec::new();
    if let Some(output) = child.stdout.take() {
        output.take(max).read_to_end(&mut bytes).map_err(trouble)?;
    }
    let cut_off = bytes.len() as u64 >= max;
    let status = child.wait().map_err(trouble)?;
    Ok((status.success() || cut_off).then_some(bytes))
}
