//! JSON schemas of the formats that other programs read.

use schemars::JsonSchema;

use crate::report::Report;
use crate::rubric::Rubric;

/// Names of techniques, as the renderer writes them.
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
#[expect(dead_code, reason = "only its schema is used: the technique itself is the renderer's type")]
pub(crate) enum TechniqueName {
    Bsdf,
    Nee,
    Mis,
}

/// The schema of `rubric.yml`, as JSON.
pub fn rubric() -> serde_json::Value {
    schemars::schema_for!(Rubric).into()
}

/// The schema of `report.json`, as JSON.
pub fn report() -> serde_json::Value {
    schemars::schema_for!(Report).into()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    /// `UPDATE_SCHEMA=1 cargo test -p verdict schema` regenerates the file.
    #[test]
    fn the_stored_schema_matches_the_types() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("report.schema.json");
        let current = format!("{:#}\n", super::report());
        if std::env::var_os("UPDATE_SCHEMA").is_some() {
            std::fs::write(&file, &current).expect("it can be written");
        }
        let kept = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
        assert!(
            kept == current,
            "{} is stale: run UPDATE_SCHEMA=1 cargo test -p verdict schema",
            file.display()
        );
    }
}
