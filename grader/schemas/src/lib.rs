//! **schemas**: JSON schemas of the YAML files that people write, made from the types that read them.
//!
//! Each shipped file names its schema in its first line, where the YAML language server of many editors looks for it.
//! Schemas do not know tags such as `!point_light`: the server must be told that they exist (`.vscode/settings.json`).
//!
//! The package keeps the derivation of schemas out of every other build.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// A schema, and the files that it is for.
pub struct FileSchema {
    /// Path of the schema, relative to the checkout.
    pub path: &'static str,
    /// The schema.
    pub schema: Value,
    /// True for the shipped files that it is for, given by their path relative to the checkout.
    pub is_for: fn(&str) -> bool,
}

/// All schemas.
pub fn all() -> Vec<FileSchema> {
    let mut all = vec![
        FileSchema {
            path: "scenes/scene.schema.json",
            schema: arty::scene::file::schema().into(),
            is_for: |path| path.starts_with("scenes/") && !path.ends_with("/answers.yml"),
        },
        FileSchema {
            path: "assignments/rubric.schema.json",
            schema: verdict::schema::rubric(),
            is_for: |path| path.starts_with("assignments/") && path.ends_with("/rubric.yml"),
        },
        FileSchema {
            path: "assignments/causes.schema.json",
            schema: judge::diagnosis::CausesFile::schema(),
            is_for: |path| path.starts_with("assignments/") && path.ends_with("/causes.yml"),
        },
        FileSchema {
            path: "assignments/course.schema.json",
            schema: classroom::policy::Course::schema(),
            is_for: |path| path.starts_with("assignments/") && path.ends_with("/course.example.yml"),
        },
    ];
    all.iter_mut().for_each(|file| adapt(&mut file.schema));
    all
}

/// Adapts a derived schema to what is read, at every level.
///
/// - Texts may be any scalar, such as the number in `student: 12345`, except names of values and texts with a minimum
///   length.
/// - `null` is no default: editors would write it into files, and not all keys that may be missing may be `null`.
fn adapt(schema: &mut Value) {
    match schema {
        Value::Object(keys) => {
            keys.retain(|key, value| !(key == "default" && value.is_null()));
            let is_special = ["const", "enum", "minLength"].iter().any(|key| keys.contains_key(*key));
            let is_text = |kind: &Value| *kind == json!("string") || *kind == json!(["string", "null"]);
            if let Some(kind) = keys.get_mut("type").filter(|kind| !is_special && is_text(kind)) {
                *kind = json!(["string", "number", "boolean", "null"]);
            }
            keys.values_mut().for_each(adapt);
        }
        Value::Array(items) => items.iter_mut().for_each(adapt),
        _ => {}
    }
}

/// The shipped files of a schema in a checkout, sorted.
///
/// # Errors
/// If a folder cannot be read.
pub fn files(root: &Path, schema: &FileSchema) -> std::io::Result<Vec<PathBuf>> {
    let (mut found, mut open) = (Vec::new(), vec![root.join("scenes"), root.join("assignments")]);
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            let relative = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            if path.is_dir() {
                open.push(path);
            } else if relative.ends_with(".yml") && (schema.is_for)(&relative) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}
