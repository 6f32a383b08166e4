//! The schemas in the checkout are those of the types, and each shipped file names its own.

use std::path::{Path, PathBuf};

use schemas::{FileSchema, all, files};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `UPDATE_SCHEMA=1 cargo test -p schemas` regenerates the files.
#[test]
fn the_stored_schemas_match_the_types() {
    for FileSchema { path, schema, .. } in all() {
        let (file, current) = (root().join(path), format!("{schema:#}\n"));
        if std::env::var_os("UPDATE_SCHEMA").is_some() {
            std::fs::write(&file, &current).expect("it can be written");
        }
        let kept = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
        assert!(kept == current, "{path} is stale: run UPDATE_SCHEMA=1 cargo test -p schemas");
    }
}

#[test]
fn each_shipped_file_names_its_schema() {
    for schema in all() {
        let stored = root().join(schema.path).canonicalize().expect("it is stored");
        let files = files(&root(), &schema).expect("they can be listed");
        assert!(!files.is_empty(), "{}", schema.path);
        for file in files {
            let text = std::fs::read_to_string(&file).expect("it can be read");
            let first = text.lines().next().unwrap_or_default();
            let named = first.strip_prefix("# yaml-language-server: $schema=");
            let named = named.and_then(|path| file.parent()?.join(path).canonicalize().ok());
            assert_eq!(named.as_ref(), Some(&stored), "{}: {first}", file.display());
        }
    }
}
