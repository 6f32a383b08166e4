//! The last commit of a git repository, read without git: nothing of the repository runs, nothing in its configuration
//! is followed, and everything is counted.

mod delta;
mod objects;
mod pack;

use std::fs::File;
use std::path::{Component, Path, PathBuf};

use super::budget::Stop;
use super::collect::Collector;
use super::names::{self, Kind, shown};
use super::text::with_our_line_ends;
use super::{Note, Refusal, limits};
use objects::{Id, Kind as ObjectKind, Store, Trouble};

/// Git directory of a folder: its `.git`, or the folder itself if it is a bare repository; `None` if it is neither.
pub(super) fn repository_of(folder: &Path) -> Option<PathBuf> {
    let is_repository = |folder: &Path| {
        is_folder(&folder.join("objects")) && is_folder(&folder.join("refs")) && is_file(&folder.join("HEAD"))
    };
    let inner = folder.join(".git");
    // A `.git` that is a file or a link leads to somewhere else.
    if is_folder(&inner) && is_repository(&inner) {
        Some(inner)
    } else {
        is_repository(folder).then(|| folder.to_owned())
    }
}

/// True for a folder itself, but not for a link to one.
fn is_folder(path: &Path) -> bool {
    std::fs::symlink_metadata(path).is_ok_and(|entry| entry.is_dir())
}

/// True for an ordinary file: reading a pipe would wait for ever.
fn is_file(path: &Path) -> bool {
    std::fs::symlink_metadata(path).is_ok_and(|entry| entry.is_file())
}

/// Collects the files of the last commit of the repository in `folder`, which is called `inside`.
pub(super) fn collect(
    repository: &Path,
    folder: &Path,
    inside: &str,
    collector: &mut Collector,
) -> Result<(), Stop> {
    // These make git read files of somebody else as objects.
    for leads_out in ["objects/info/alternates", "objects/info/http-alternates", "commondir"] {
        if std::fs::symlink_metadata(repository.join(leads_out)).is_ok() {
            collector.obstacle(Refusal::Git(format!("it borrows from another one ({leads_out})")));
            return Ok(());
        }
    }
    let Some(head) = head(repository, collector)? else {
        collector.obstacle(Refusal::Git("there is no HEAD, or it is damaged".to_owned()));
        return Ok(());
    };
    let mut store = Store::open(&repository.join("objects"), &collector.budget());
    match tree_of(&mut store, &head) {
        Ok(tree) => walk(&mut store, tree, folder, inside, collector),
        Err(Trouble::Stop(stop)) => Err(stop),
        Err(_) => {
            collector.obstacle(Refusal::Git("its last commit is missing or damaged".to_owned()));
            Ok(())
        }
    }
}

/// Id of the last commit; `None` if there is none.
fn head(repository: &Path, collector: &Collector) -> Result<Option<Id>, Stop> {
    let read = |path: &Path, max: u64| -> Result<Option<String>, Stop> {
        if !is_file(path) {
            return Ok(None);
        }
        let Ok(mut file) = File::open(path) else { return Ok(None) };
        let bytes = collector.budget().read(&mut file, max)?.ok().flatten();
        Ok(bytes.and_then(|bytes| String::from_utf8(bytes).ok()))
    };
    const MAX_LENGTH: u64 = 4096;
    let mut content = read(&repository.join("HEAD"), MAX_LENGTH)?;
    for _ in 0..5 {
        let Some(text) = &content else { return Ok(None) };
        let Some(name) = text.strip_prefix("ref:").map(str::trim) else {
            return Ok(Id::parse(text.trim()));
        };
        let stays = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        if !stays || !name.starts_with("refs/") {
            return Ok(None);
        }
        content = match read(&repository.join(name), MAX_LENGTH)? {
            Some(own) => Some(own),
            None => read(&repository.join("packed-refs"), limits::ATTACHMENT)?.and_then(|packed| {
                let mut lines = packed.lines().filter_map(|line| line.split_once(' '));
                lines.find(|(_, packed)| *packed == name).map(|(id, _)| id.to_owned())
            }),
        };
    }
    Ok(None)
}

/// The tree of a commit.
fn tree_of(store: &mut Store, commit: &Id) -> Result<Id, Trouble> {
    let commit = store.read(commit, ObjectKind::Commit, limits::ATTACHMENT)?;
    let line = commit.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let id = line.strip_prefix(b"tree ").and_then(|id| std::str::from_utf8(id).ok());
    id.and_then(Id::parse).ok_or(Trouble::Damaged)
}

/// Collects the files of a tree.
fn walk(
    store: &mut Store,
    tree: Id,
    folder: &Path,
    inside: &str,
    collector: &mut Collector,
) -> Result<(), Stop> {
    let mut waiting = vec![(tree, String::new(), 0)];
    while let Some((tree, prefix, depth)) = waiting.pop() {
        let content = match store.read(&tree, ObjectKind::Tree, limits::ATTACHMENT) {
            Ok(content) => content,
            Err(Trouble::Stop(stop)) => return Err(stop),
            Err(_) => {
                collector.obstacle(Refusal::Git(format!("its folder {} is damaged", shown(inside, &prefix))));
                continue;
            }
        };
        for entry in entries(&content, tree.length()) {
            collector.budget().entry()?;
            let path = format!("{prefix}{}", entry.name);
            match entry.mode {
                b"40000" if depth < limits::DEPTH && !names::is_left_behind(&path) => {
                    waiting.push((entry.id, format!("{path}/"), depth + 1));
                }
                b"120000" if collector.kind(&path) == Kind::Named => {
                    collector.bad_source(Refusal::Link(shown(inside, &path)));
                }
                b"100644" | b"100755" | b"100664" if collector.wants(&path) => {
                    collect_blob(store, &entry.id, &folder.join(&path), &shown(inside, &path), collector)?;
                }
                // A file of a course system, a submodule, or nothing that git writes.
                _ => {}
            }
        }
    }
    Ok(())
}

/// Collects one file. `on_disk` is its place in a checkout.
fn collect_blob(
    store: &mut Store,
    id: &Id,
    on_disk: &Path,
    name: &str,
    collector: &mut Collector,
) -> Result<(), Stop> {
    let kind = collector.kind(name);
    // Archives in a repository are nobody's submission.
    if matches!(kind, Kind::Archive | Kind::UnknownArchive) {
        return Ok(());
    }
    let max =
        if matches!(kind, Kind::Text | Kind::Explanation) { limits::ATTACHMENT } else { limits::SOURCE };
    let blob = match store.read(id, ObjectKind::Blob, max) {
        Ok(blob) => blob,
        Err(Trouble::Stop(stop)) => return Err(stop),
        Err(Trouble::TooLarge) if kind == Kind::Named => {
            collector.bad_source(Refusal::TooLarge { name: name.to_owned(), max });
            return Ok(());
        }
        Err(_) => {
            collector.obstacle(Refusal::Git(format!("{name} is damaged or too large")));
            return Ok(());
        }
    };
    if kind == Kind::Named && differs_on_disk(on_disk, &blob, collector)? {
        collector.note(Note::Uncommitted(name.to_owned()));
    }
    collector.offer(name, &mut blob.as_slice(), 0)
}

/// An entry of a tree.
struct Entry<'a> {
    mode: &'a [u8],
    name: String,
    id: Id,
}

/// The entries of a tree: `<mode> <name>\0<id>`, until something else follows.
fn entries(mut tree: &[u8], id_length: usize) -> impl Iterator<Item = Entry<'_>> {
    std::iter::from_fn(move || {
        let blank = tree.iter().position(|&byte| byte == b' ')?;
        let zero = blank + tree[blank..].iter().position(|&byte| byte == 0)?;
        let id = tree.get(zero + 1..zero + 1 + id_length)?;
        let name = String::from_utf8_lossy(&tree[blank + 1..zero]).into_owned();
        let entry = Entry { mode: &tree[..blank], name, id: Id::new(id) };
        tree = &tree[zero + 1 + id_length..];
        Some(entry)
    })
}

/// True if the file exists on disk and differs from the committed one.
fn differs_on_disk(path: &Path, blob: &[u8], collector: &Collector) -> Result<bool, Stop> {
    let text = |bytes: &[u8]| with_our_line_ends(&String::from_utf8_lossy(bytes));
    if !is_file(path) {
        return Ok(false);
    }
    let Ok(mut file) = File::open(path) else { return Ok(false) };
    let on_disk = collector.budget().read(&mut file, limits::SOURCE)?;
    Ok(matches!(on_disk, Ok(Some(bytes)) if text(&bytes) != text(blob)))
}
