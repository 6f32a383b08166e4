//! The kinds of checks.

use serde::{Deserialize, Serialize};

/// A kind of check.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum CheckKind {
    /// Means against a closed form for each pixel.
    ClosedForm,
    /// Variance against that of the other techniques.
    Efficiency,
    /// Dependence of the estimator on each factor, in scripted scenes.
    Facts,
    /// Means in randomly generated scenes, against the solution.
    HiddenVariants,
    /// Frequency of light selection against the selection probability in the estimator.
    LightPick,
    /// Means against a reference image.
    MeanBias,
    /// Means in scenes that are transformed with a known effect on the image.
    Metamorphic,
    /// Individual MIS weights, on paths of up to `max_bounces` bounces.
    MisWeights,
    /// Length of paths against `max_bounces`.
    PathLength,
    /// Independence of pixels, batches and seeds; repeatability.
    Randomness,
    /// Rays per path, on paths of up to `max_bounces` bounces.
    RayBudget,
    /// Sampled directions of an environment against their density, and that against the one of the sheet.
    Sampling,
    /// Scenes and densities near the limits of single precision.
    Stability,
    /// Means in a random variation of a known scene, against the solution.
    VariedScene,
    /// Means against the closed form of a uniformly emitting enclosure (white furnace test).
    WhiteFurnace,
}

impl CheckKind {
    /// All kinds, by name.
    pub const ALL: [Self; 15] = [
        Self::ClosedForm,
        Self::Efficiency,
        Self::Facts,
        Self::HiddenVariants,
        Self::LightPick,
        Self::MeanBias,
        Self::Metamorphic,
        Self::MisWeights,
        Self::PathLength,
        Self::Randomness,
        Self::RayBudget,
        Self::Sampling,
        Self::Stability,
        Self::VariedScene,
        Self::WhiteFurnace,
    ];

    /// Name in rubrics, in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed-form",
            Self::Efficiency => "efficiency",
            Self::Facts => "facts",
            Self::HiddenVariants => "hidden-variants",
            Self::LightPick => "light-pick",
            Self::MeanBias => "mean-bias",
            Self::Metamorphic => "metamorphic",
            Self::MisWeights => "mis-weights",
            Self::PathLength => "path-length",
            Self::Randomness => "randomness",
            Self::RayBudget => "ray-budget",
            Self::Sampling => "sampling",
            Self::Stability => "stability",
            Self::VariedScene => "varied-scene",
            Self::WhiteFurnace => "white-furnace",
        }
    }

    /// True if it tests whether a submission that is right in the known scenes is right in others, too. It tells
    /// nothing new about a submission that is wrong in the known scenes.
    pub fn tests_generalisation(self) -> bool {
        matches!(self, Self::HiddenVariants | Self::Metamorphic | Self::Stability)
    }

    /// True if its scenes depend on the seed. What it should give is then rendered by the solution during the grade, and
    /// its measurements cannot be compared with those of another grade.
    pub fn draws_scenes(self) -> bool {
        matches!(self, Self::HiddenVariants | Self::VariedScene)
    }

    /// True if it runs in a scene of `scenes/`.
    pub fn needs_scene(self) -> bool {
        !matches!(
            self,
            Self::Facts
                | Self::HiddenVariants
                | Self::LightPick
                | Self::MisWeights
                | Self::PathLength
                | Self::RayBudget
                | Self::Sampling
                | Self::Stability
        )
    }
}

impl std::fmt::Display for CheckKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
