//! What is found where MIS weights are read one by one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The weights of a submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WeightTest {
    /// What is wrong, if anything is.
    pub fault: Option<WeightFault>,
    /// The weights; none where a path returned NaN or infinity.
    pub measured: Option<MeasuredWeights>,
}

/// What is wrong with the weights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightFault {
    /// A path returned NaN or infinity at these densities per solid angle.
    NotANumber {
        /// That of the light sample.
        light: f64,
        /// That of the BSDF sample.
        bsdf: f64,
    },
    /// At the first vertex of a path they do not sum to one, or do not rise with p_L / p_B.
    FirstVertex,
    /// They are right at the first vertex and wrong at later ones.
    LaterVertices,
    /// Light that only one technique can find does not count in full.
    OnlyWay(OnlyWay),
}

/// Weights as functions of the densities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasuredWeights {
    /// Weights of light samples.
    pub light: WeightForm,
    /// One minus the weights of BSDF samples.
    pub bsdf: WeightForm,
    /// Smallest and largest sum of the two weights at the first vertex.
    pub sum: [f64; 2],
    /// Largest |w_L + w_B − 1| at the first vertex, beyond noise.
    pub deviation_at_first_vertex: f64,
    /// Largest |w_L + w_B − 1| at later vertices, beyond noise.
    pub deviation_at_later_vertices: f64,
    /// Weights of light that only one technique can find; each should be 1.
    pub only_way: Vec<OnlyWayWeight>,
    /// For paths with one vertex, with ordinary densities: log₁₀ (p_L / p_B), w_L and w_B, in the order of the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<[f32; 3]>,
}

impl MeasuredWeights {
    /// Largest |w_L + w_B − 1| anywhere, beyond noise.
    pub fn largest_deviation(&self) -> f64 {
        self.deviation_at_first_vertex.max(self.deviation_at_later_vertices)
    }
}

/// How a weight depends on what it may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightForm {
    /// It is always the same.
    Constant(f64),
    /// Its odds are a product of powers: exponents of p_L / p_B, distance, cosine at the light, number of lights, and
    /// 1 / density per area.
    Powers([f64; WeightForm::FACTORS]),
    /// Anything else.
    Other,
}

impl WeightForm {
    /// Factors that weights may depend on.
    pub const FACTORS: usize = 5;

    /// Exponents, where the odds are a product of powers.
    pub fn exponents(&self) -> Option<&[f64; Self::FACTORS]> {
        match self {
            Self::Powers(exponents) => Some(exponents),
            Self::Constant(_) | Self::Other => None,
        }
    }

    /// Exponents that are whole numbers but for noise.
    pub fn whole_exponents(&self) -> Option<[i32; Self::FACTORS]> {
        let exponents = self.exponents()?;
        let is_whole = |exponent: &f64| (exponent - exponent.round()).abs() < 0.15;
        exponents.iter().all(is_whole).then(|| exponents.map(|exponent| exponent.round() as i32))
    }
}

/// Light that only one technique can find.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OnlyWay {
    /// A light that the camera sees.
    SeenByCamera,
    /// A light that is hit after a delta bounce.
    AfterDelta,
    /// A light without area.
    PointLight,
}

impl OnlyWay {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::SeenByCamera, Self::AfterDelta, Self::PointLight];
}

/// Weight of light that only one technique can find.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OnlyWayWeight {
    /// Which light.
    pub light: OnlyWay,
    /// Its weight; none if a path returned NaN or infinity.
    pub weight: Option<f64>,
}
