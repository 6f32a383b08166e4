//! Cargo's files without the packages that are not handed out. Everything else in them stays, comments included.

use std::collections::BTreeSet;

use toml_edit::{Array, DocumentMut, Item, Table, TomlError, value};

/// Who gets a copy of the checkout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Audience {
    /// Students.
    Students,
    /// A machine that grades, such as Gradescope's.
    Grading,
}

impl Audience {
    /// Packages that are not included, and their folders. Aliases have the names of the packages.
    fn excluded(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Students => {
                &[("lab", "grader/lab"), ("schemas", "grader/schemas"), ("solution", "solution")]
            }
            Self::Grading => &[("lab", "grader/lab"), ("schemas", "grader/schemas")],
        }
    }
}

fn parse(text: &str) -> Result<DocumentMut, String> {
    text.parse().map_err(|error: TomlError| error.to_string())
}

/// The root's `Cargo.toml`.
pub(super) fn workspace(text: &str, audience: Audience) -> Result<String, String> {
    let mut document = parse(text)?;
    let workspace = document.get_mut("workspace").ok_or("there is no `workspace`")?;
    let is_given = |member: &str| audience.excluded().iter().all(|(_, folder)| member != *folder);
    for (key, is_needed) in [("members", true), ("default-members", false)] {
        let Some(members) = workspace.get_mut(key).and_then(Item::as_array_mut) else {
            if is_needed {
                return Err(format!("there is no `workspace.{key}`"));
            }
            continue;
        };
        members.retain(|member| member.as_str().is_none_or(is_given));
    }
    if let Some(dependencies) = workspace.get_mut("dependencies").and_then(Item::as_table_mut) {
        audience.excluded().iter().for_each(|(name, _)| drop(dependencies.remove(name)));
    }
    Ok(document.to_string())
}

/// The command aliases of `.cargo/config.toml`.
pub(super) fn aliases(text: &str, audience: Audience) -> Result<String, String> {
    let mut document = parse(text)?;
    if let Some(aliases) = document.get_mut("alias").and_then(Item::as_table_mut) {
        audience.excluded().iter().for_each(|(name, _)| drop(aliases.remove(name)));
    }
    Ok(document.to_string())
}

/// A package's `Cargo.toml` without benchmarks.
pub(super) fn without_benches(text: &str, _: Audience) -> Result<String, String> {
    let mut document = parse(text)?;
    document.remove("bench");
    Ok(document.to_string())
}

/// A package's `Cargo.toml` without tests, benchmarks and examples. Unit tests are disabled too, since some need the
/// solution. Their dependencies stay, or `Cargo.lock` would no longer fit.
pub(super) fn without_tests(text: &str, _: Audience) -> Result<String, String> {
    let mut document = parse(text)?;
    for key in ["bench", "example", "test"] {
        document.remove(key);
    }
    // A package of programs alone has no library to switch tests off in.
    if document.contains_key("lib") || !document.contains_key("bin") {
        let library = document.entry("lib").or_insert_with(|| Item::Table(Table::new()));
        if let Some(table) = library.as_table_mut() {
            table["doctest"] = value(false);
            table["test"] = value(false);
        }
    }
    if let Some(programs) = document.get_mut("bin").and_then(Item::as_array_of_tables_mut) {
        for program in programs.iter_mut() {
            program["test"] = value(false);
        }
    }
    Ok(document.to_string())
}

/// `Cargo.lock` without the dependencies of packages that are not included.
pub(super) fn lock(text: &str, audience: Audience) -> Result<String, String> {
    let mut document = parse(text)?;
    let packages = document
        .get_mut("package")
        .and_then(Item::as_array_of_tables_mut)
        .ok_or("there is no `[[package]]`")?;
    let text =
        |table: &Table, key: &str| table.get(key).and_then(Item::as_str).unwrap_or_default().to_owned();
    // Packages of the workspace have no source; all others are dependencies of these.
    let mut wanted: Vec<(String, Option<String>)> = packages
        .iter()
        .filter(|table| {
            !table.contains_key("source")
                && audience.excluded().iter().all(|(name, _)| text(table, "name") != *name)
        })
        .map(|table| (text(table, "name"), None))
        .collect();
    let mut needed = BTreeSet::new();
    while let Some((name, version)) = wanted.pop() {
        // A dependency is `name`, or `name version` where there are several versions of it.
        let fits = |table: &&Table| {
            text(table, "name") == name
                && version.as_ref().is_none_or(|version| text(table, "version") == *version)
        };
        for table in packages.iter().filter(fits) {
            if needed.insert((name.clone(), text(table, "version"))) {
                let dependencies = table.get("dependencies").and_then(Item::as_array);
                wanted.extend(dependencies.into_iter().flat_map(Array::iter).filter_map(|dependency| {
                    let mut words = dependency.as_str()?.split(' ').map(str::to_owned);
                    Some((words.next()?, words.next()))
                }));
            }
        }
    }
    packages.retain(|table| needed.contains(&(text(table, "name"), text(table, "version"))));
    Ok(document.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependencies_of_the_solution_alone_leave_the_lock_file() {
        let text = r#"version = 4
[[package]]
name = "arty"
version = "0.1.0"
dependencies = ["a 1.0.0"]
[[package]]
name = "solution"
version = "0.1.0"
dependencies = ["a 2.0.0", "b"]
[[package]]
name = "a"
version = "1.0.0"
source = "registry"
[[package]]
name = "a"
version = "2.0.0"
source = "registry"
[[package]]
name = "b"
version = "1.0.0"
source = "registry"
"#;
        let left = lock(text, Audience::Students).expect("it is a lock file");
        let names: Vec<&str> = left.lines().filter(|line| line.starts_with("name")).collect();
        assert_eq!(names, ["name = \"arty\"", "name = \"a\""], "{left}");
        assert!(left.contains("1.0.0") && !left.contains("2.0.0"), "{left}");
    }

    #[test]
    fn other_members_aliases_and_comments_stay() {
        let text = "# why\n[workspace]\nmembers = [\"a\", \"solution\", \"b\"]\n";
        let workspace = |text| super::workspace(text, Audience::Students);
        assert_eq!(workspace(text).as_deref(), Ok("# why\n[workspace]\nmembers = [\"a\", \"b\"]\n"));
        assert!(workspace("[package]\n").is_err() && workspace("[[").is_err());
        let aliased = "[alias]\na = \"b\"\nsolution = \"c\"\n";
        assert_eq!(aliases(aliased, Audience::Grading).as_deref(), Ok(aliased));
        assert_eq!(aliases(aliased, Audience::Students).as_deref(), Ok("[alias]\na = \"b\"\n"));
        let text = "[package]\nname = \"x\"\n[[bin]]\nname = \"x\"\n[[bench]]\nname = \"y\"\n";
        let left = without_tests(text, Audience::Students).expect("it is TOML");
        assert_eq!(left.matches("test = false").count(), 1, "{left}");
        assert!(!left.contains("bench") && !left.contains("[lib]"), "{left}");
        let of_library = without_tests("[package]\nname = \"x\"\n", Audience::Students).expect("it is TOML");
        assert_eq!(of_library.matches("test = false").count(), 2, "doctests, too: {of_library}");
    }
}
