//! The kinds of checks.

use serde::{Deserialize, Serialize};

/// What a check asks of a submission.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum CheckKind {
    /// Means against formulas for each pixel.
    ClosedForm,
    /// Noise against that of the other techniques.
    Efficiency,
    /// Means in scenes that are drawn at random, against the solution.
    HiddenVariants,
    /// Selection of lights against the selection probability that is divided by.
    LightPick,
    /// Means against a reference image.
    MeanBias,
    /// Means in scenes that are changed in ways that must not show.
    Metamorphic,
    /// MIS weights, one by one; `max_bounces` is the longest path that is looked at.
    MisWeights,
    /// Number of bounces that paths are given.
    PathLength,
    /// Independence of pixels, batches and seeds.
    Randomness,
    /// Rays per path; `max_bounces` is the longest path that is looked at.
    RayBudget,
    /// Scenes and densities at the ends of single precision.
    Stability,
    /// Means against the closed form of a uniformly emitting enclosure.
    WhiteFurnace,
}

impl CheckKind {
    /// All kinds, by name.
    pub const ALL: [Self; 12] = [
        Self::ClosedForm,
        Self::Efficiency,
        Self::HiddenVariants,
        Self::LightPick,
        Self::MeanBias,
        Self::Metamorphic,
        Self::MisWeights,
        Self::PathLength,
        Self::Randomness,
        Self::RayBudget,
        Self::Stability,
        Self::WhiteFurnace,
    ];

    /// Its name in rubrics, reports and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed-form",
            Self::Efficiency => "efficiency",
            Self::HiddenVariants => "hidden-variants",
            Self::LightPick => "light-pick",
            Self::MeanBias => "mean-bias",
            Self::Metamorphic => "metamorphic",
            Self::MisWeights => "mis-weights",
            Self::PathLength => "path-length",
            Self::Randomness => "randomness",
            Self::RayBudget => "ray-budget",
            Self::Stability => "stability",
            Self::WhiteFurnace => "white-furnace",
        }
    }

    /// True if it asks whether what is right in known scenes is right in others, too: it adds nothing about a submission
    /// that is wrong in the known ones.
    pub fn goes_further(self) -> bool {
        matches!(self, Self::HiddenVariants | Self::Metamorphic | Self::Stability)
    }

    /// True if it runs in a scene of the collection.
    pub fn needs_scene(self) -> bool {
        !matches!(
            self,
            Self::HiddenVariants
                | Self::LightPick
                | Self::MisWeights
                | Self::PathLength
                | Self::RayBudget
                | Self::Stability
        )
    }
}

impl std::fmt::Display for CheckKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
