//! Evidence of the check `mis-weights`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::means::SLIGHT;

/// MIS weights of a submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WeightTest {
    /// What is wrong with the weights; `None` if they are right.
    pub fault: Option<WeightFault>,
    /// The measured weights; `None` if a path returned NaN or infinity.
    pub measured: Option<MeasuredWeights>,
}

impl WeightTest {
    /// True if both weights depend on the densities as they should, and all sums are close to one.
    pub(super) fn is_slightly_wrong(&self) -> bool {
        let Some(measured) = &self.measured else { return false };
        let is_heuristic =
            |form: WeightForm| matches!(form.whole_exponents(), Some([ratio, 0, 0, 0, 0]) if ratio > 0);
        let is_near_one = |it: &OnlyWayWeight| it.weight.is_some_and(|weight| (weight - 1.0).abs() <= SLIGHT);
        is_heuristic(measured.light)
            && is_heuristic(measured.bsdf)
            && measured.largest_deviation() <= SLIGHT
            && measured.only_way.iter().all(is_near_one)
    }
}

/// What is wrong with MIS weights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightFault {
    /// A path returned NaN or infinity at these densities.
    NotANumber {
        /// Density of the light sample, per solid angle.
        light: f64,
        /// Density of the BSDF sample, per solid angle.
        bsdf: f64,
    },
    /// At the first vertex of a path, the weights do not sum to one or do not increase with p_L / p_B.
    FirstVertex,
    /// The weights are right at the first vertex and wrong at later ones.
    LaterVertices,
    /// Light that only one technique can find does not have weight 1.
    OnlyWay(OnlyWay),
}

/// MIS weights as functions of the densities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeasuredWeights {
    /// Weight of light samples, w_L.
    pub light: WeightForm,
    /// One minus the weight of BSDF samples, 1 − w_B.
    pub bsdf: WeightForm,
    /// Minimum and maximum of w_L + w_B at the first vertex.
    pub sum: [f64; 2],
    /// Maximum of |w_L + w_B − 1| at the first vertex, in excess of noise.
    pub deviation_at_first_vertex: f64,
    /// Maximum of |w_L + w_B − 1| at later vertices, in excess of noise.
    pub deviation_at_later_vertices: f64,
    /// Weights of light that only one technique can find; each should be 1.
    pub only_way: Vec<OnlyWayWeight>,
    /// For paths with one vertex and moderate densities: log₁₀ (p_L / p_B), w_L and w_B, sorted by the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<[f32; 3]>,
}

impl MeasuredWeights {
    /// Maximum of |w_L + w_B − 1| at all vertices, in excess of noise.
    pub fn largest_deviation(&self) -> f64 {
        self.deviation_at_first_vertex.max(self.deviation_at_later_vertices)
    }
}

/// Functional form of a weight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightForm {
    /// The weight is constant.
    Constant(f64),
    /// The odds w / (1 − w) are a product of powers, with these exponents of p_L / p_B, distance, cosine at the light,
    /// number of lights, and 1 / density per area.
    Powers([f64; WeightForm::FACTORS]),
    /// Any other form.
    Other,
}

impl WeightForm {
    /// Number of factors that a weight may depend on.
    pub const FACTORS: usize = 5;

    /// Exponents of the factors; `None` unless the odds are a product of powers.
    pub fn exponents(&self) -> Option<&[f64; Self::FACTORS]> {
        match self {
            Self::Powers(exponents) => Some(exponents),
            Self::Constant(_) | Self::Other => None,
        }
    }

    /// Exponents rounded to integers; `None` unless all are integers up to noise.
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
    /// A light hit after a delta bounce.
    AfterDelta,
    /// A light without an area.
    PointLight,
    /// A light hit after a delta bounce off another light.
    AfterLight,
}

impl OnlyWay {
    /// All cases.
    pub const ALL: [Self; 4] = [Self::SeenByCamera, Self::AfterDelta, Self::PointLight, Self::AfterLight];
}

/// Measured weight of light that only one technique can find.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OnlyWayWeight {
    /// The light.
    pub light: OnlyWay,
    /// Its weight, which should be 1; `None` if a path returned NaN or infinity.
    pub weight: Option<f64>,
}
