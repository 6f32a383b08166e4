//! Why a check means nothing in a scene.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a check is skipped whatever the submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WhyNot {
    /// There are no lights: every technique gives black.
    NoLights,
    /// No light has an area, so that BSDF sampling gives black.
    BsdfFindsNothing,
    /// No light has an area, so that there is nothing to weigh.
    NothingToWeigh,
    /// No light has an area, so that there is only one technique.
    OneTechnique,
    /// Every surface is black, a mirror or glass: next event estimation has nothing to do.
    NothingLit,
    /// There is only one light to choose.
    OneLight,
    /// The camera is not enclosed, so that light gets lost.
    NotEnclosed,
    /// The enclosure does not emit the same everywhere: there is no closed form.
    NotUniform,
    /// There is more than flat, diffuse, plainly coloured surfaces.
    NotFlatDiffuse,
    /// Only light after one bounce has a closed form.
    SeveralBounces,
    /// There are so many lights, too many to add up their formulas.
    ManyLights(usize),
    /// A spot light has no closed form here.
    SpotLight,
    /// A light with an area is partly hidden.
    PartlyHidden,
    /// The reference does not say how noisy the other techniques are.
    UnknownNoise,
    /// The other techniques are at most so many times as noisy, which does not tell them apart.
    AlikeNoise {
        /// How many times.
        at_most: f64,
        /// How many are needed.
        needed: f64,
    },
    /// The check is not about that technique.
    Technique,
    /// The check is about other numbers of bounces.
    Bounces {
        /// The fewest.
        min: u32,
        /// The most.
        max: u32,
    },
    /// The check cannot be told that lights that are hit emit nothing, or not with that technique.
    EmissionOff,
    /// The scene is not here: staff have it.
    SceneNotHere,
    /// There is no solution here to compare with: staff have it.
    NoSolution,
}
