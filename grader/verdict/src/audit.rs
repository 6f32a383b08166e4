//! The audit: facts about the factors of an estimator, measured in scripted scenes.
//!
//! A scripted scene answers every call with known numbers. One answer is doubled at a time: the logarithm of the ratio
//! of the results is the exponent of that answer in the estimator. A correct estimator has known exponents, so each
//! [`Fact`] holds or fails whatever the mistake is.

use std::fmt;

use arty::integrator::Technique;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::Fault;

/// The facts about one submission.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Audit {
    /// All facts, in the order in which failed ones should be read.
    pub facts: Vec<Fact>,
    /// What ended the submission before all facts were measured; `None` if nothing did.
    pub fault: Option<Fault>,
    /// Wall time in seconds.
    pub seconds: f64,
}

/// One measured property of an estimator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Fact {
    /// The part of the estimator.
    pub term: Term,
    /// The factor that was changed or observed.
    pub factor: Factor,
    /// The technique.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Where on the path, or with how many lights.
    pub place: Place,
    /// The value of a correct estimator, in the unit of [`Factor::unit`].
    pub expected: f64,
    /// The measured value; `None` if there is none, or it is NaN or infinite.
    pub measured: Option<f64>,
    /// Outcome of the comparison with the expected value.
    pub outcome: Outcome,
    /// A path for which a fact about paths fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub example: Option<PathWord>,
}

/// A part of the estimator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Term {
    /// The light sample of a light with an area.
    LightSample,
    /// The light sample of a light without an area.
    PointLight,
    /// The emission of a light that the path hits.
    Hit,
    /// The MIS weight of a light sample.
    LightWeight,
    /// The MIS weight of a hit.
    HitWeight,
    /// Both MIS weights of one path.
    Weights,
    /// The set of paths that contribute.
    Path,
    /// Russian roulette.
    Roulette,
    /// The choice of a light.
    Selection,
    /// Conduct of the program apart from its estimator.
    Conduct,
}

/// A factor that is changed or observed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Factor {
    /// The result relative to the exact result.
    Size,
    /// The BSDF at the previous vertex.
    PreviousBsdf,
    /// The density of the previous bounce.
    PreviousDensity,
    /// The BSDF in the direction of this contribution.
    Bsdf,
    /// The BSDF in the other technique's direction.
    OtherBsdf,
    /// The BSDF in the direction to the viewer.
    ViewerBsdf,
    /// The BSDF's density in the direction of this contribution.
    Density,
    /// The BSDF's density in the other technique's direction.
    OtherDensity,
    /// The BSDF's density in the direction to the viewer.
    ViewerDensity,
    /// The cosine at the receiver with the shading normal.
    ShadingCosine,
    /// The cosine at the receiver with the geometric normal.
    GeometricCosine,
    /// The radiance, or intensity, of the light.
    Emission,
    /// The green channel of the light's radiance, while the red channel is looked at.
    OtherChannel,
    /// The cosine at the light.
    LightCosine,
    /// The distance to the light.
    Distance,
    /// The density per area of the light point of this contribution.
    AreaDensity,
    /// The density per area of the light point of the other technique.
    OtherAreaDensity,
    /// The number of lights.
    Lights,
    /// The result if something stands between the two points.
    Occluded,
    /// The same, just before the light.
    OccludedAtLight,
    /// The same, just above the receiver.
    OccludedAtReceiver,
    /// The result if something stands behind the light.
    ObjectBehindLight,
    /// The result if the light is below the receiver's horizon.
    BelowHorizon,
    /// The result at a delta BSDF.
    DeltaBsdf,
    /// The result if BSDF sampling then returns no direction.
    WithoutBsdfSample,
    /// The result for a distant or near, bright or dim light.
    Scale,
    /// The sum of both weights.
    Sum,
    /// The sum of both weights if lights have different powers.
    SumWithUnequalLights,
    /// The weight's increase with the density of its own technique.
    Rise,
    /// Light seen by the camera.
    SeenByCamera,
    /// Light after delta bounces only.
    AfterDeltaBounces,
    /// Light after a delta bounce that follows another bounce.
    AfterLaterDeltaBounce,
    /// Light after a bounce that follows a delta bounce.
    AfterBounceBehindDelta,
    /// Light after bounces none of which is a delta bounce.
    AfterBounces,
    /// Light after exactly as many bounces as allowed.
    AtLimit,
    /// Light after more bounces than allowed.
    BeyondLimit,
    /// Paths that never meet a light.
    WithoutLight,
    /// Grey throughput below 1.
    GreyThroughput,
    /// Throughput with a channel that is zero.
    ColoredThroughput,
    /// Throughput above 1.
    HighThroughput,
    /// The same call twice.
    Repeatable,
    /// Light reflected by the surface of a light.
    ReflectedByLight,
    /// Light on a path whose first light sample found nothing, since the light faces away.
    AfterMissedLightSample,
    /// Light on a path with many bounces, none of which ends it.
    LongPath,
    /// Rays of a path, relative to those with a single light.
    Rays,
    /// The result for very small and very large densities.
    ExtremeDensities,
    /// How much more often a path equals the next one than a distant one; 1 if all are equal.
    RandomNumbers,
}

/// The unit of a fact's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// The exponent of an answer in the result.
    Exponent,
    /// The result relative to the exact one; 0 where nothing should arrive.
    Ratio,
}

/// Where a fact was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// At this hit point of the path, from 1.
    Hit(u32),
    /// With this number of lights.
    Lights(u32),
    /// Over all paths.
    Paths,
}

/// Whether a fact holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// It holds.
    Holds,
    /// It does not: the estimator has a mistake.
    Fails,
    /// The form differs from the sheet's, while all means are right.
    Remark,
    /// It cannot be measured.
    DoesNotApply(Why),
}

/// Why a fact cannot be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Why {
    /// Nothing arrives, whatever is changed; another fact says so.
    NothingArrives,
    /// The weight is 0 or 1, or constant, where it was measured.
    NoSlope,
    /// The submission was ended before.
    NotMeasured,
}

/// The surfaces of a path and its end.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PathWord {
    /// The surfaces, from the camera on.
    pub surfaces: Vec<SurfaceKind>,
    /// What the path ends at.
    pub end: PathEnd,
    /// The maximum number of bounces.
    pub max_bounces: u32,
}

/// A kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SurfaceKind {
    /// Scatters with a low density.
    Diffuse,
    /// Scatters with a high density.
    Glossy,
    /// Reflects into one direction.
    Mirror,
    /// Transmits into one direction.
    Glass,
    /// Scatters, and reflects into one direction, which is the one sampled.
    Coated,
}

impl SurfaceKind {
    /// True if the sampled direction is one of a delta distribution.
    pub fn samples_delta(self) -> bool {
        matches!(self, Self::Mirror | Self::Glass | Self::Coated)
    }

    /// True if no light sample can find light by way of it.
    pub fn is_delta(self) -> bool {
        matches!(self, Self::Mirror | Self::Glass)
    }
}

/// What a path ends at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PathEnd {
    /// A light with an area.
    AreaLight,
    /// A light without an area.
    PointLight,
    /// Nothing.
    Nothing,
}

impl Factor {
    /// The unit of its values, given the term.
    pub fn unit(self) -> Unit {
        use Factor::*;
        match self {
            PreviousBsdf | PreviousDensity | Bsdf | OtherBsdf | ViewerBsdf | Density | OtherDensity
            | ViewerDensity | ShadingCosine | GeometricCosine | Emission | OtherChannel | LightCosine
            | Distance | AreaDensity | OtherAreaDensity | Lights => Unit::Exponent,
            _ => Unit::Ratio,
        }
    }
}

impl Fact {
    /// True if the estimator has a mistake here.
    pub fn fails(&self) -> bool {
        self.outcome == Outcome::Fails
    }

    /// Its name, such as `light-sample/distance/nee/2`.
    pub fn id(&self) -> String {
        let place = match self.place {
            Place::Hit(hit) => format!("/{hit}"),
            Place::Lights(count) => format!("/{count}-lights"),
            Place::Paths => String::new(),
        };
        format!("{}/{}/{}{place}", self.term, self.factor, self.technique)
    }
}

impl Audit {
    /// The facts that fail.
    pub fn failed(&self) -> impl Iterator<Item = &Fact> {
        self.facts.iter().filter(|fact| fact.fails())
    }

    /// The failed facts that are worth a statement: the first of each term. Others often follow from these.
    pub fn statements(&self) -> Vec<&Fact> {
        let mut stated: Vec<&Fact> = Vec::new();
        for fact in self.failed() {
            if stated.iter().all(|other| other.term != fact.term) {
                stated.push(fact);
            }
        }
        stated
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&kebab(&format!("{self:?}")))
    }
}

impl fmt::Display for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&kebab(&format!("{self:?}")))
    }
}

/// `SomeName` as `some-name`, which is also its form in JSON.
fn kebab(name: &str) -> String {
    let mut text = String::new();
    for (index, letter) in name.char_indices() {
        if letter.is_uppercase() && index > 0 {
            text.push('-');
        }
        text.extend(letter.to_lowercase());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_json_format() {
        for factor in [Factor::Size, Factor::OtherAreaDensity, Factor::SumWithUnequalLights] {
            assert_eq!(serde_json::to_value(factor).expect("it is a name"), factor.to_string());
        }
        for term in [Term::LightSample, Term::Weights] {
            assert_eq!(serde_json::to_value(term).expect("it is a name"), term.to_string());
        }
    }
}
