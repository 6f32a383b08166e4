//! Why a check does not apply to a scene.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a check does not apply, whatever the submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WhyNot {
    /// The scene has no lights: every technique returns black.
    NoLights,
    /// No light has an area: BSDF sampling returns black.
    BsdfFindsNothing,
    /// BSDF sampling finds a light so rarely that a mean cannot be judged.
    BsdfFindsLittle {
        /// Share of bounces that hit a light.
        share: f64,
        /// Share that the check needs.
        needed: f64,
    },
    /// No light has an area: there are no MIS weights to test.
    NothingToWeigh,
    /// No light has an area: only one technique finds light.
    OneTechnique,
    /// Every surface is black, a mirror or glass: next event estimation contributes nothing.
    NothingLit,
    /// The scene has only one light: there is no light selection to test.
    OneLight,
    /// The scene is not closed: light escapes.
    NotEnclosed,
    /// The enclosure does not emit uniformly: there is no closed form.
    NotUniform,
    /// Some surface is not flat, diffuse and untextured.
    NotFlatDiffuse,
    /// The closed form covers one bounce only.
    SeveralBounces,
    /// The scene has this many lights, too many for a closed form.
    ManyLights(usize),
    /// The closed form does not cover spot lights.
    SpotLight,
    /// An area light or the environment is partly occluded.
    PartlyHidden,
    /// The reference does not record the noise of the other techniques.
    UnknownNoise,
    /// The variances of the techniques are too similar to tell them apart.
    AlikeNoise {
        /// Largest ratio of the variance of another technique to that of this one.
        at_most: f64,
        /// Ratio that the check needs.
        needed: f64,
    },
    /// The check does not support the technique.
    Technique,
    /// The check does not support the number of bounces.
    Bounces {
        /// Minimum.
        min: u32,
        /// Maximum.
        max: u32,
    },
    /// The check does not support `emission_on_hit: off`, or not with this technique.
    EmissionOff,
    /// The scene is missing in this checkout: only staff have it.
    SceneNotHere,
    /// The solution is missing in this checkout: only staff have it.
    NoSolution,
}
