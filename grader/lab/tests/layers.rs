//! The layers of the project: which package may depend on which. Cargo enforces what the manifests say; these tests hold
//! the manifests to the layers.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, Item, Table};

/// For each package the packages of the project that it may depend on.
const LAYERS: [(&str, &[&str]); 14] = [
    ("arty", &[]),
    ("arty-import", &["arty"]),
    ("arty-view", &["arty"]),
    ("host", &["arty"]),
    ("verdict", &["arty"]),
    ("harness", &["arty", "host", "verdict"]),
    ("judge", &["arty", "host", "verdict", "harness"]),
    ("intake", &["arty", "verdict"]),
    ("present", &["arty", "verdict"]),
    ("classroom", &["arty", "verdict", "harness", "judge", "intake", "present"]),
    ("grader", &["arty", "host", "verdict", "harness", "judge", "intake", "present", "classroom"]),
    (
        "lab",
        &[
            "arty",
            "host",
            "verdict",
            "harness",
            "judge",
            "intake",
            "present",
            "classroom",
            "grader",
            "solution",
        ],
    ),
    ("schemas", &["arty", "verdict", "judge", "classroom"]),
    ("solution", &["arty", "arty-view"]),
];

/// Packages of the project, each with those that it depends on.
type Dependencies = BTreeMap<String, BTreeSet<String>>;

/// The checkout, two folders above this package.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn manifest(folder: &Path) -> DocumentMut {
    let path = folder.join("Cargo.toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn members() -> Vec<DocumentMut> {
    let root = root();
    let workspace = manifest(&root);
    let members = workspace["workspace"]["members"].as_array().expect("the workspace has members");
    members.iter().map(|member| manifest(&root.join(member.as_str().expect("a folder")))).collect()
}

fn name(manifest: &DocumentMut) -> String {
    manifest["package"]["name"].as_str().expect("a package has a name").to_owned()
}

/// Dependencies in the tables of one kind, those for single systems included.
fn dependencies(manifest: &Table, kinds: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (key, item) in manifest {
        let Some(table) = item.as_table_like() else { continue };
        if kinds.contains(&key) {
            // A dependency may be renamed: `verdict2 = { package = "verdict" }`.
            found.extend(table.iter().map(|(name, value)| {
                let package = value.get("package").and_then(Item::as_str);
                package.unwrap_or(name).to_owned()
            }));
        }
        if key == "target" {
            for table in table.iter().filter_map(|(_, item)| item.as_table()) {
                found.extend(dependencies(table, kinds));
            }
        }
    }
    found
}

/// The project's own packages among the dependencies of these kinds.
fn graph(kinds: &[&str]) -> Dependencies {
    let manifests = members();
    let own: BTreeSet<String> = manifests.iter().map(name).collect();
    let of = |manifest: &DocumentMut| {
        let mut found = dependencies(manifest.as_table(), kinds);
        found.retain(|other| own.contains(other) && *other != name(manifest));
        (name(manifest), found)
    };
    manifests.iter().map(of).collect()
}

#[test]
fn packages_depend_only_on_the_layers_below_them() {
    let allowed: BTreeMap<&str, &[&str]> = LAYERS.into();
    let found = graph(&["dependencies", "build-dependencies", "dev-dependencies"]);
    assert_eq!(
        found.keys().map(String::as_str).collect::<Vec<_>>(),
        allowed.keys().copied().collect::<Vec<_>>()
    );
    for (package, dependencies) in found {
        for dependency in dependencies {
            let is_allowed = allowed[package.as_str()].contains(&dependency.as_str());
            assert!(is_allowed, "{package} must not depend on {dependency}: see LAYERS");
        }
    }
}

/// Sentences are made in `present`: what decides a verdict cannot read one.
#[test]
fn nothing_that_judges_knows_the_sentences() {
    let graph = graph(&["dependencies", "build-dependencies"]);
    let mut closure = BTreeSet::new();
    let mut open = vec!["judge"];
    while let Some(package) = open.pop() {
        if closure.insert(package) {
            open.extend(graph[package].iter().map(String::as_str));
        }
    }
    assert_eq!(closure, BTreeSet::from(["arty", "harness", "host", "judge", "verdict"]));
}

/// What a student builds for a grade.
#[test]
fn the_grader_is_built_without_laboratory_solution_window_and_import() {
    let graph = graph(&["dependencies", "build-dependencies"]);
    for (package, dependencies) in graph.iter().filter(|(package, _)| *package != "lab") {
        // The window takes long to build, and is no part of a grade.
        let window = (package != "solution").then_some("arty-view");
        for kept in ["lab", "solution", "arty-import"].into_iter().chain(window) {
            assert!(!dependencies.contains(kept), "{package} depends on {kept}");
        }
    }
}
