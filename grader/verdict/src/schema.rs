//! JSON schemas of the formats that other programs read.

use schemars::JsonSchema;

use crate::report::Report;

/// Names of techniques, as the renderer writes them.
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
#[expect(dead_code, reason = "only its schema is used: the technique itself is the renderer's type")]
pub(crate) enum TechniqueName {
    Bsdf,
    Nee,
    Mis,
}

/// The schema of `report.json`, as JSON.
pub fn report() -> serde_json::Value {
    schemars::schema_for!(Report).into()
}
