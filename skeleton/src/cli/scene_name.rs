//! Scenes that are given by name instead of by file.

use std::path::{Path, PathBuf};

use crate::diagnostic::Diagnostic;

/// The file of a scene: what is given if it exists, else `scenes/<name>.yml` in the current folder or one above it.
///
/// # Errors
/// If there is no such file; names the scene that was probably meant.
pub fn resolve(given: &Path) -> Result<PathBuf, Diagnostic> {
    let current = std::env::current_dir().unwrap_or_default();
    resolve_in(given, &current)
}

fn resolve_in(given: &Path, current: &Path) -> Result<PathBuf, Diagnostic> {
    if given.exists() {
        return Ok(given.to_owned());
    }
    let folder = current.ancestors().map(|above| above.join("scenes")).find(|folder| folder.is_dir());
    let is_name = given.components().count() == 1;
    let folder = if is_name { folder } else { given.parent().map(Path::to_owned) };
    let wanted = given.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let Some(folder) = folder else { return Err(missing(given, None)) };
    let file = folder.join(format!("{wanted}.yml"));
    // Shorter to read where it lies below the current folder.
    if is_name && file.is_file() {
        return Ok(file.strip_prefix(current).map(Path::to_owned).unwrap_or(file));
    }
    Err(missing(given, nearest(&wanted, &names_in(&folder))))
}

fn missing(given: &Path, nearest: Option<&String>) -> Diagnostic {
    let meant = nearest.map_or(String::new(), |name| format!("; did you mean `{name}`?"));
    Diagnostic::about(given, format!("no such file, and no scene of this name{meant}"))
}

/// Names of the scenes in a folder.
fn names_in(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let name = |path: PathBuf| Some(path.file_stem()?.to_string_lossy().into_owned());
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "yml");
    let mut names: Vec<String> = files.map(|file| file.path()).filter(is_scene).filter_map(name).collect();
    names.sort();
    names
}

/// The name that is most like another one; `None` if none is like it.
fn nearest<'a>(wanted: &str, names: &'a [String]) -> Option<&'a String> {
    let likeness = |name: &&String| strsim::normalized_damerau_levenshtein(wanted, name);
    let best = names.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(&best) > 0.5).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_found_by_its_name_and_a_similar_name_is_suggested() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let below = folder.path().join("report");
        for name in ["scenes", "report"] {
            std::fs::create_dir(folder.path().join(name)).expect("it can be made");
        }
        let file = folder.path().join("scenes/cornell_box.yml");
        std::fs::write(&file, "").expect("it can be written");
        for name in ["cornell_box", "cornell_box.yml"] {
            let found = resolve_in(Path::new(name), folder.path()).expect("it is there");
            assert_eq!(found, Path::new("scenes/cornell_box.yml"));
            assert_eq!(resolve_in(Path::new(name), &below).expect("it is above"), file);
        }
        assert_eq!(resolve_in(&file, &below).expect("a file is itself"), file);
        for typo in ["cornel_box", "cornell-box.yml"] {
            let message = resolve_in(Path::new(typo), &below).expect_err("it is not there").to_string();
            assert!(message.contains("did you mean `cornell_box`?"), "{message}");
        }
        let in_folder = folder.path().join("scenes/cornelbox.yml");
        let message = resolve_in(&in_folder, &below).expect_err("it is not there").to_string();
        assert!(message.contains("did you mean `cornell_box`?"), "{message}");
        let message =
            resolve_in(Path::new("x.yml"), folder.path()).expect_err("nothing is like it").to_string();
        assert!(!message.contains("mean"), "{message}");
    }
}
