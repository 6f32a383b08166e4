//! What a kind of check is.

use std::ops::RangeInclusive;

use arty::integrator::Technique;
use harness::job::JobError;
use serde::{Deserialize, Serialize};
use verdict::check::{
    CheckKind, Evidence, MeanTest, Numerics, OnlyWay, Place, Reason, SceneChange, Verdict, WhyNot,
};
use verdict::rubric::{CheckSpec, EmissionOnHit};

use super::{GradeContext, SceneWithReference};

/// A kind of check: where it means something, how it is run, what it tells about causes.
pub trait Check: Sync {
    /// The kind that rubrics name.
    fn kind(&self) -> CheckKind;

    /// Techniques that it can be about.
    fn techniques(&self) -> &'static [Technique] {
        &Technique::ALL
    }

    /// Numbers of bounces that it can be asked for.
    fn bounces(&self) -> RangeInclusive<u32> {
        0..=u32::MAX
    }

    /// True if it can be asked about next event estimation alone, with lights that emit nothing when they are hit.
    fn isolates_next_event_estimation(&self) -> bool {
        false
    }

    /// The number of bounces that says most in a scene whose pictures have `all`.
    fn telling_bounces(&self, all: u32) -> u32 {
        all.clamp(*self.bounces().start(), *self.bounces().end())
    }

    /// Whether it means anything in a scene, with lights that its technique can find.
    ///
    /// # Errors
    /// Why it does not.
    fn applies(&self, _scene: &SceneWithReference, _spec: &CheckSpec) -> Result<(), WhyNot> {
        Ok(())
    }

    /// Runs it on a submission.
    ///
    /// # Errors
    /// If the submission gives no answer, or something else is wrong.
    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<Outcome, JobError>;

    /// What its measurements say about causes, as numbers that can be compared.
    fn observations(&self, evidence: &Evidence) -> Vec<Observation>;

    /// Whether it can be asked for at all, in some scene.
    ///
    /// # Errors
    /// Why it cannot.
    fn accepts(&self, spec: &CheckSpec) -> Result<(), WhyNot> {
        if !self.techniques().contains(&spec.technique) {
            return Err(WhyNot::Technique);
        }
        let bounces = self.bounces();
        if !bounces.contains(&spec.max_bounces) {
            return Err(WhyNot::Bounces { min: *bounces.start(), max: *bounces.end() });
        }
        let isolates = self.isolates_next_event_estimation() && spec.technique == Technique::Nee;
        if spec.emission_on_hit == EmissionOnHit::Off && !isolates {
            Err(WhyNot::EmissionOff)
        } else {
            Ok(())
        }
    }
}

/// What a check has come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub verdict: Verdict,
    /// Why, as a code.
    pub reason: Reason,
    /// What was measured.
    pub evidence: Evidence,
    /// Samples that are not radiance.
    pub numerics: Numerics,
    /// Paths traced.
    pub samples: u64,
}

impl Outcome {
    /// A pass if there is no reason for anything else, or else a fail.
    pub fn new(reason: Reason, evidence: Evidence, samples: u64) -> Self {
        let verdict = if reason == Reason::None { Verdict::Pass } else { Verdict::Fail };
        Self { verdict, reason, evidence, numerics: Numerics::default(), samples }
    }

    /// The same with samples that are not radiance: a submission that returns any has failed.
    #[must_use]
    pub fn with(mut self, numerics: Numerics) -> Self {
        if !numerics.is_clean() {
            (self.verdict, self.reason) = (Verdict::Fail, Reason::Numerics);
        }
        Self { numerics, ..self }
    }
}

/// A measured number that tells causes apart, with its standard error.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// What was measured.
    pub quantity: Quantity,
    /// Its value.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// What an [`Observation`] measures.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// ln of the mean of a picture, relative to what it should be.
    Mean,
    /// ln of the energy of light after so many bounces, relative to what it should be.
    BounceEnergy(u32),
    /// ln of the variance, relative to a technique of the solution.
    Noise(Technique),
    /// ln of the contribution of one of three lights, relative to what it should be.
    LightShare(u32),
    /// Exponent of a factor in the odds of a weight: of light samples, or against BSDF samples.
    WeightExponent {
        /// True for light samples.
        of_light: bool,
        /// Number of the factor, as in [`WeightForm::Powers`](verdict::check::WeightForm::Powers).
        factor: u32,
    },
    /// A weight that is always the same: of light samples, or against BSDF samples.
    WeightConstant {
        /// True for light samples.
        of_light: bool,
    },
    /// log₁₀ of the largest |w_L + w_B − 1|.
    WeightDeviation {
        /// True at the first vertex of a path, false at later ones.
        first_vertex: bool,
    },
    /// Weight of light that only one technique can find.
    OnlyWayWeight(OnlyWay),
    /// 1 where something is wrong in one of the scenes that a check looks at.
    WrongAt(WrongPlace),
}

impl Quantity {
    /// True for logarithms of ratios that are 1 if all is right.
    pub fn is_zero_if_right(&self) -> bool {
        matches!(self, Self::Mean | Self::BounceEnergy(_))
    }

    /// True if it says nothing that it was not measured: it may have been too noisy.
    pub fn may_be_missing(&self) -> bool {
        matches!(self, Self::Mean | Self::BounceEnergy(_) | Self::Noise(_) | Self::LightShare(_))
    }

    /// How much a value may differ between two programs with the same mistake, as one standard deviation.
    pub fn scale(&self, value: f64) -> f64 {
        match self {
            Self::Noise(_) => 0.3,
            Self::WeightExponent { .. } | Self::OnlyWayWeight(_) => 0.1,
            Self::WeightDeviation { .. } => 0.5,
            Self::WeightConstant { .. } => 0.02,
            Self::LightShare(_) => 0.002 + 0.1 * value.abs(),
            // Light that is 2 % off, and a tenth of the mistake itself. The more often light has bounced, the less of it
            // there is to measure from.
            Self::BounceEnergy(bounces) => 0.02 + 0.02 * f64::from(bounces.pow(2)) + 0.1 * value.abs(),
            Self::Mean | Self::WrongAt(_) => 0.02 + 0.1 * value.abs(),
        }
    }
}

/// One of several scenes or runs that a check looks at.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WrongPlace {
    /// A changed scene.
    Change(SceneChange),
    /// The room 2^n times as large.
    Scaled(i32),
    /// The room with lights 2^n times as bright; 0 for the room as it is.
    Brightened(i32),
    /// A scene of `scenes/extreme/`.
    ExtremeScene(String),
    /// Scripted densities.
    Densities,
    /// Different seeds that give the same image.
    SameImage,
    /// The same seed, rendered again.
    NotRepeatable,
    /// Pixels of one image.
    SharedByPixels,
}

impl From<&Place> for WrongPlace {
    fn from(place: &Place) -> Self {
        match place {
            Place::Unchanged => Self::Brightened(0),
            Place::Scaled(n) => Self::Scaled(*n),
            Place::Brightened(n) => Self::Brightened(*n),
            Place::ExtremeScene(name) => Self::ExtremeScene(name.clone()),
            Place::Densities { .. } => Self::Densities,
        }
    }
}

/// Darkest that a mean counts as, relative to what it should be: black has no logarithm.
const DARKEST: f64 = 0.02;

/// 99 % intervals reach about this many standard errors to either side.
const MARGIN_IN_ERRORS: f64 = 2.6;

impl Observation {
    /// A number without an error.
    pub fn exact(quantity: Quantity, value: f64) -> Self {
        Self { quantity, value, error: 0.0 }
    }

    /// ln of a ratio, limited where it is nearly black; `margin` is half a 99 % interval.
    pub fn ratio(quantity: Quantity, ratio: f64, margin: f64) -> Self {
        let limited = ratio.clamp(DARKEST, 1e4);
        Self { quantity, value: limited.ln(), error: margin / MARGIN_IN_ERRORS / limited }
    }

    /// That something is wrong at a place.
    pub fn wrong_at(place: WrongPlace) -> Self {
        Self::exact(Quantity::WrongAt(place), 1.0)
    }

    /// The mean of the whole picture, where it is known.
    pub fn of_mean(test: &MeanTest) -> Vec<Self> {
        let ratio =
            |whole: verdict::check::Effect| Self::ratio(Quantity::Mean, 1.0 + whole.relative, whole.margin);
        test.whole.map(ratio).into_iter().collect()
    }
}
