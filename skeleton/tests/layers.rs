//! Modules import only from modules that stand above them in the table of `lib.rs`.

use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The modules in the order of the table in the documentation of `lib.rs`.
fn layers() -> Vec<String> {
    let text = fs::read_to_string(sources().join("lib.rs")).expect("lib.rs can be read");
    let rows = text.lines().filter_map(|line| line.strip_prefix("//! | ")).skip(1);
    rows.filter_map(|row| row.split('`').nth(1)).map(str::to_owned).collect()
}

/// All library files below `folder`.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("the entry can be read").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found
}

/// The names of the modules between the crate's root and a file, its own included.
fn module_path(file: &Path) -> Vec<String> {
    let relative = file.strip_prefix(sources()).expect("it is below src").with_extension("");
    let names = relative.iter().map(|name| name.to_string_lossy().replace("no_probe", "probe"));
    names.filter(|name| name != "mod").collect()
}

/// The top-level modules that the code of a module at the given depth refers to, by `crate::…` or enough `super::`s.
fn references(tokens: TokenStream, depth: usize, found: &mut Vec<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let text = |index: usize| tokens.get(index).map(ToString::to_string).unwrap_or_default();
    let is_path = |index: usize| text(index) == ":" && text(index + 1) == ":";
    let mut index = 0;
    while index < tokens.len() {
        if let TokenTree::Group(group) = &tokens[index] {
            let inline_module =
                index >= 2 && text(index - 2) == "mod" && group.delimiter() == Delimiter::Brace;
            references(group.stream(), depth + usize::from(inline_module), found);
        }
        let (mut supers, mut end) = (0, index);
        while text(end) == "super" && is_path(end + 1) {
            supers += 1;
            end += 3;
        }
        if text(index) == "crate" && is_path(index + 1) {
            end += 3;
        } else if supers == 0 || supers < depth {
            index = end.max(index + 1);
            continue;
        }
        match tokens.get(end) {
            Some(TokenTree::Group(list)) => {
                let items: Vec<String> = list.stream().into_iter().map(|token| token.to_string()).collect();
                let starts = (0..items.len()).filter(|&item| item == 0 || items[item - 1] == ",");
                found.extend(starts.map(|item| items[item].clone()));
            }
            Some(name) => found.push(name.to_string()),
            None => {}
        }
        // A list of names is gone through once more, as a group.
        index = end.max(index + 1);
    }
}

/// What is wrong with the imports of one file.
fn upward_imports(layers: &[String], file: &Path, text: &str) -> Vec<String> {
    let path = module_path(file);
    let place = |name: &str| layers.iter().position(|layer| layer == name);
    let Some(own) = place(&path[0]) else { return vec![format!("lib.rs does not list `{}`", path[0])] };
    let mut found = Vec::new();
    references(TokenStream::from_str(text).expect("it is Rust"), path.len(), &mut found);
    let is_upward = |name: &String| place(name).is_none_or(|other| other > own);
    let upward = found.into_iter().filter(is_upward);
    upward.map(|name| format!("{} uses `{name}`, which is not above it", path.join("::"))).collect()
}

#[test]
fn modules_import_only_from_modules_above_them() {
    let layers = layers();
    assert!(layers.len() > 15, "the table is found: {layers:?}");
    let mut wrong = Vec::new();
    for file in files(&sources()) {
        let path = module_path(&file);
        // The program beside the library, which may use all of it.
        if ["lib", "main", "algorithms"].contains(&path[0].as_str()) {
            continue;
        }
        let text = fs::read_to_string(&file).expect("the file can be read");
        wrong.extend(upward_imports(&layers, &file, &text));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn an_upward_import_is_found_however_it_is_written() {
    let layers = ["math", "light", "scene"].map(str::to_owned);
    let file = sources().join("light/point.rs");
    for upward in [
        "use crate::scene::Hit;",
        "use crate::{math::Vec3, scene::Hit};",
        "fn f(hit: &crate::scene::Hit) {}",
        "use super::super::scene::Hit;",
        "mod tests { use super::super::super::scene::Hit; }",
        "use crate::unknown::Name;",
    ] {
        assert_eq!(upward_imports(&layers, &file, upward).len(), 1, "{upward}");
    }
    for fine in [
        "use crate::math::{Rgb, Vec3};",
        "use super::Light;",
        "use crate::light::Light;",
        "mod tests { use super::*; use super::super::Light; }",
        "/// See `crate::scene::Hit`.\nconst TEXT: &str = \"crate::scene::Hit\";",
    ] {
        assert!(upward_imports(&layers, &file, fine).is_empty(), "{fine}");
    }
}
