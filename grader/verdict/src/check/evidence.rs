//! What each kind of check measures.

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::means::{FurnaceTest, MeanTest};
use super::{CheckKind, StabilityTest, WeightTest};

/// The measurements of one check: one variant a kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[expect(missing_docs, reason = "the kinds of checks are documented at CheckKind")]
pub enum Evidence {
    ClosedForm(MeanTest),
    Efficiency(Noise),
    HiddenVariants(VariantTest),
    LightPick(LightShares),
    MeanBias(MeanTest),
    Metamorphic(ChangeTest),
    MisWeights(WeightTest),
    PathLength(PathLengths),
    Randomness(RandomNumbers),
    RayBudget(RayCounts),
    Stability(StabilityTest),
    WhiteFurnace(FurnaceTest),
}

impl Evidence {
    /// The kind of check that measures this.
    pub fn kind(&self) -> CheckKind {
        match self {
            Self::ClosedForm(_) => CheckKind::ClosedForm,
            Self::Efficiency(_) => CheckKind::Efficiency,
            Self::HiddenVariants(_) => CheckKind::HiddenVariants,
            Self::LightPick(_) => CheckKind::LightPick,
            Self::MeanBias(_) => CheckKind::MeanBias,
            Self::Metamorphic(_) => CheckKind::Metamorphic,
            Self::MisWeights(_) => CheckKind::MisWeights,
            Self::PathLength(_) => CheckKind::PathLength,
            Self::Randomness(_) => CheckKind::Randomness,
            Self::RayBudget(_) => CheckKind::RayBudget,
            Self::Stability(_) => CheckKind::Stability,
            Self::WhiteFurnace(_) => CheckKind::WhiteFurnace,
        }
    }

    /// The picture whose mean decided, where one did.
    pub fn mean_test(&self) -> Option<&MeanTest> {
        match self {
            Self::ClosedForm(test) | Self::MeanBias(test) => Some(test),
            Self::HiddenVariants(VariantTest { test, .. })
            | Self::Metamorphic(ChangeTest { test, .. })
            | Self::WhiteFurnace(FurnaceTest { test, .. }) => Some(test),
            Self::Efficiency(_)
            | Self::LightPick(_)
            | Self::MisWeights(_)
            | Self::PathLength(_)
            | Self::Randomness(_)
            | Self::RayBudget(_)
            | Self::Stability(_) => None,
        }
    }
}

/// The noise of a submission at equal sample counts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Noise {
    /// Variance relative to that of each of the solution's techniques, its own first; empty if there is no noise at all.
    pub ratios: Vec<VarianceOf>,
    /// The technique that it is as noisy as, where that is not its own.
    #[schemars(with = "Option<crate::schema::TechniqueName>")]
    pub as_noisy_as: Option<Technique>,
    /// True if it is noisier than the solution beyond chance.
    pub is_noisier: bool,
}

/// Variance of one sample of a submission, relative to that of a technique of the solution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VarianceOf {
    /// Technique of the solution.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Variance of the submission divided by that technique's.
    pub ratio: f64,
}

/// Means in scenes that are drawn at random.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VariantTest {
    /// The scene that decided, counted from 1.
    pub scene: u32,
    /// Scenes in the check.
    pub scenes: u32,
    /// What was found in it.
    pub test: MeanTest,
}

/// Means in scenes that are changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChangeTest {
    /// The change that decided.
    pub change: SceneChange,
    /// Changes in the check.
    pub changes: u32,
    /// True if the mean of the changed scene is wrong beyond chance.
    pub is_biased: bool,
    /// What was found in the changed scene.
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
    /// All lengths 100 times as long.
    Larger,
    /// All lengths a hundredth as long.
    Smaller,
    /// The scene rotated.
    Rotated,
    /// The scene moved.
    Moved,
    /// Triangles split into smaller ones.
    Tessellated,
    /// Each light split into two.
    LightsSplit,
    /// Black objects beside the scene.
    BlackObjects,
    /// The lights in two scenes, whose pictures are added up.
    LightsApart,
}

/// How much each of three lights contributes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LightShares {
    /// Contribution relative to the exact one, less 1; none if it is not finite.
    pub excess: [Option<f64>; 3],
    /// The first light that contributes too much or too little, counted from 0.
    pub wrong: Option<u32>,
}

/// Bounces of paths that nothing but `max_bounces` and Russian roulette should end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PathLengths {
    /// Maximum number of bounces that was asked for.
    pub max_bounces: u32,
    /// The number of bounces after which the submission ends all paths, if that is less.
    pub limit: Option<u32>,
}

/// Whether pixels, batches and seeds are independent and repeatable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RandomNumbers {
    /// They are.
    Independent,
    /// Different seeds gave the same image in these two batches.
    SameImage([u32; 2]),
    /// The same seed did not give the same image twice.
    NotRepeatable,
    /// Pixels share random numbers: the variance of sums over pixels, relative to that of independent pixels.
    SharedByPixels {
        /// That ratio.
        excess: f64,
        /// Pixels that vary together.
        pixels: PixelGroup,
    },
}

/// Which pixels vary together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PixelGroup {
    /// All pixels of the image.
    Image,
    /// Pixels of a row.
    Row,
    /// Pixels of a column.
    Column,
    /// Pixels of a tile of 4 × 4.
    Tile,
}

/// Rays that paths trace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RayCounts {
    /// What is beyond the budget, if anything is.
    pub excess: Option<TooManyRays>,
    /// Lights in the room.
    pub lights: u32,
    /// True if shadow rays start at perfect mirrors, which cannot reflect a sampled light.
    pub shadow_rays_at_mirrors: bool,
    /// True if shadow rays are traced in a scene without lights.
    pub shadow_rays_without_lights: bool,
}

/// A path that traces more rays than the sheet allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct TooManyRays {
    /// Maximum number of bounces.
    pub bounces: u32,
    /// Shadow rays of the path that traces most.
    pub shadow_rays: u32,
    /// Rays of the path that traces most, shadow rays included.
    pub rays: u32,
    /// How many are enough.
    pub allowed: u32,
}
