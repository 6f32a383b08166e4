//! Floating-point numbers in JSON, which has neither NaN nor infinity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An `f64` that may be NaN or infinite; in JSON these values are the strings `"NaN"`, `"inf"` and `"-inf"`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(from = "Json", into = "Json")]
#[schemars(with = "Json")]
pub struct Float(pub f64);

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum Json {
    Finite(f64),
    Other(Other),
}

#[derive(Serialize, Deserialize, JsonSchema)]
enum Other {
    NaN,
    #[serde(rename = "inf")]
    Infinity,
    #[serde(rename = "-inf")]
    NegativeInfinity,
}

impl From<Float> for Json {
    fn from(Float(value): Float) -> Self {
        if value.is_finite() {
            Self::Finite(value)
        } else if value.is_nan() {
            Self::Other(Other::NaN)
        } else {
            Self::Other(if value > 0.0 { Other::Infinity } else { Other::NegativeInfinity })
        }
    }
}

impl From<Json> for Float {
    fn from(json: Json) -> Self {
        Self(match json {
            Json::Finite(value) => value,
            Json::Other(Other::NaN) => f64::NAN,
            Json::Other(Other::Infinity) => f64::INFINITY,
            Json::Other(Other::NegativeInfinity) => f64::NEG_INFINITY,
        })
    }
}

impl From<f64> for Float {
    fn from(value: f64) -> Self {
        Self(value)
    }
}

impl From<f32> for Float {
    fn from(value: f32) -> Self {
        Self(f64::from(value))
    }
}

/// NaN equals itself, so that two reports with the same numbers are equal.
impl PartialEq for Float {
    fn eq(&self, other: &Self) -> bool {
        self.0.total_cmp(&other.0).is_eq() || self.0 == other.0
    }
}

impl std::fmt::Display for Float {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl std::fmt::LowerExp for Float {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_survives_json() {
        for value in [0.0, -0.0, 1.5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, f64::MAX] {
            let text = serde_json::to_string(&Float(value)).expect("it is JSON");
            assert_eq!(serde_json::from_str::<Float>(&text).expect(&text), Float(value), "{text}");
        }
        assert!(serde_json::from_str::<Float>("\"many\"").is_err());
    }
}
