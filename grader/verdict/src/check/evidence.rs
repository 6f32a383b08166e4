//! The measurements of each kind of check.

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::means::{FurnaceTest, MeanTest, SLIGHT};
use super::{CheckKind, SamplingTest, StabilityTest, WeightTest};
use crate::audit::{Fact, Unit};

/// The measurements of one check: one variant per kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[expect(missing_docs, reason = "the kinds of checks are documented at CheckKind")]
pub enum Evidence {
    ClosedForm(MeanTest),
    Efficiency(Noise),
    Facts(FailedFacts),
    HiddenVariants(VariantTest),
    LightPick(LightShares),
    MeanBias(MeanTest),
    Metamorphic(ChangeTest),
    MisWeights(WeightTest),
    PathLength(PathLengths),
    Randomness(RandomNumbers),
    RayBudget(RayCounts),
    Sampling(SamplingTest),
    Stability(StabilityTest),
    VariedScene(MeanTest),
    WhiteFurnace(FurnaceTest),
}

impl Evidence {
    /// The kind of check that measures this.
    pub fn kind(&self) -> CheckKind {
        match self {
            Self::ClosedForm(_) => CheckKind::ClosedForm,
            Self::Efficiency(_) => CheckKind::Efficiency,
            Self::Facts(_) => CheckKind::Facts,
            Self::HiddenVariants(_) => CheckKind::HiddenVariants,
            Self::LightPick(_) => CheckKind::LightPick,
            Self::MeanBias(_) => CheckKind::MeanBias,
            Self::Metamorphic(_) => CheckKind::Metamorphic,
            Self::MisWeights(_) => CheckKind::MisWeights,
            Self::PathLength(_) => CheckKind::PathLength,
            Self::Randomness(_) => CheckKind::Randomness,
            Self::RayBudget(_) => CheckKind::RayBudget,
            Self::Sampling(_) => CheckKind::Sampling,
            Self::Stability(_) => CheckKind::Stability,
            Self::VariedScene(_) => CheckKind::VariedScene,
            Self::WhiteFurnace(_) => CheckKind::WhiteFurnace,
        }
    }

    /// The test of the picture whose mean decided; `None` for kinds that do not test means.
    pub fn mean_test(&self) -> Option<&MeanTest> {
        match self {
            Self::ClosedForm(test) | Self::MeanBias(test) | Self::VariedScene(test) => Some(test),
            Self::HiddenVariants(VariantTest { test, .. })
            | Self::Metamorphic(ChangeTest { test, .. })
            | Self::WhiteFurnace(FurnaceTest { test, .. }) => Some(test),
            Self::Efficiency(_)
            | Self::Facts(_)
            | Self::LightPick(_)
            | Self::MisWeights(_)
            | Self::PathLength(_)
            | Self::Randomness(_)
            | Self::RayBudget(_)
            | Self::Sampling(_)
            | Self::Stability(_) => None,
        }
    }
}

/// The noise of a submission at equal sample counts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Noise {
    /// Variance relative to each of the solution's techniques, its own first; empty if the submission has no noise.
    pub ratios: Vec<VarianceOf>,
    /// The other technique that the submission is as noisy as, if any.
    #[schemars(with = "Option<crate::schema::TechniqueName>")]
    pub as_noisy_as: Option<Technique>,
    /// True if the submission is significantly noisier than the solution.
    pub is_noisier: bool,
}

/// Variance of one sample of a submission relative to a technique of the solution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VarianceOf {
    /// Technique of the solution.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Variance of the submission divided by that of the technique.
    pub ratio: f64,
}

/// Means in randomly generated scenes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VariantTest {
    /// Number of the scene that decided, counted from 1.
    pub scene: u32,
    /// Number of scenes in the check.
    pub scenes: u32,
    /// Test of its mean.
    pub test: MeanTest,
}

/// Means in transformed scenes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChangeTest {
    /// The change that decided.
    pub change: SceneChange,
    /// Number of changes in the check.
    pub changes: u32,
    /// True if the mean of the changed scene is significantly wrong.
    pub is_biased: bool,
    /// Test of the mean of the changed scene.
    pub test: MeanTest,
}

/// A change of a scene with a known effect on its picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SceneChange {
    /// All lights 1000 times as bright.
    Brighter,
    /// All lights a thousandth as bright.
    Dimmer,
    /// The scene scaled by 100.
    Larger,
    /// The scene scaled by 1/100.
    Smaller,
    /// The scene rotated.
    Rotated,
    /// The scene translated.
    Moved,
    /// Triangles split into smaller ones.
    Tessellated,
    /// Each light split into two.
    LightsSplit,
    /// Black objects added beside the scene.
    BlackObjects,
    /// The lights divided between two scenes, whose pictures are summed.
    LightsApart,
}

/// Contribution of each of three lights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LightShares {
    /// Relative error of each contribution; `None` if it is not finite. For the technique `bsdf`, which cannot find these
    /// lights: the contribution relative to that of a light sample.
    pub excess: [Option<f64>; 3],
    /// The first light whose contribution is wrong, counted from 0; `None` if all are right.
    pub wrong: Option<u32>,
}

impl LightShares {
    /// True if all errors are small.
    pub(super) fn are_slightly_wrong(&self) -> bool {
        self.excess.iter().all(|excess| excess.is_some_and(|excess| excess.abs() <= SLIGHT))
    }
}

/// Facts about an estimator that fail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FailedFacts {
    /// The facts that fail, in the order in which they should be read.
    pub failed: Vec<Fact>,
    /// Number of all facts that were measured.
    pub measured: u32,
}

impl FailedFacts {
    /// True if all that fails is a ratio that should be 1 and is close to it.
    pub(super) fn are_slight(&self) -> bool {
        let is_slight = |fact: &Fact| {
            let is_ratio = fact.factor.unit() == Unit::Ratio && fact.expected == 1.0;
            is_ratio && fact.measured.is_some_and(|measured| (measured - 1.0).abs() <= SLIGHT)
        };
        self.failed.iter().all(is_slight)
    }
}

/// Lengths of paths that only `max_bounces` and Russian roulette may end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PathLengths {
    /// Requested maximum number of bounces.
    pub max_bounces: u32,
    /// Number of bounces after which the submission ends all paths, if smaller than requested.
    pub limit: Option<u32>,
}

/// Whether pixels, batches and seeds are independent and repeatable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RandomNumbers {
    /// No dependence was found.
    Independent,
    /// These two batches have different seeds and the same image.
    SameImage([u32; 2]),
    /// Rendering the same seed again gave another image.
    NotRepeatable,
    /// Pixels share random numbers.
    SharedByPixels {
        /// Variance of sums over pixels, relative to that of independent pixels.
        excess: f64,
        /// The pixels that are correlated.
        pixels: PixelGroup,
    },
}

/// A group of pixels that may be correlated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PixelGroup {
    /// All pixels of the image.
    Image,
    /// The pixels of a row.
    Row,
    /// The pixels of a column.
    Column,
    /// The pixels of a 4 × 4 tile.
    Tile,
}

/// Numbers of rays that paths trace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RayCounts {
    /// A path that exceeds the budget, if any.
    pub excess: Option<TooManyRays>,
    /// Number of lights in the room.
    pub lights: u32,
    /// True if shadow rays start at perfect mirrors, which cannot reflect a sampled light.
    pub shadow_rays_at_mirrors: bool,
    /// True if shadow rays are traced in a scene without lights.
    pub shadow_rays_without_lights: bool,
    /// The message of a panic in a scene without lights; `None` if there was none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub panic_without_lights: Option<String>,
}

/// Rays of a path that exceeds the budget of the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct TooManyRays {
    /// Maximum number of bounces.
    pub bounces: u32,
    /// Maximum number of shadow rays per path.
    pub shadow_rays: u32,
    /// Maximum number of rays per path, including shadow rays.
    pub rays: u32,
    /// Maximum number of rays that the budget allows.
    pub allowed: u32,
}
