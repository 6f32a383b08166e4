//! The interface of checks.

use std::ops::RangeInclusive;

use arty::integrator::Technique;
use harness::job::JobError;
use serde::{Deserialize, Serialize};
use verdict::check::{
    CheckKind, Evidence, MeanTest, Numerics, OnlyWay, Place, Reason, SampledMap, SceneChange, Verdict, WhyNot,
};
use verdict::rubric::{CheckSpec, EmissionOnHit};

use super::{GradeContext, SceneWithReference};

/// A kind of check: where it applies, how it is run, and what its measurements tell about causes.
pub trait Check: Sync {
    /// The kind, as named in rubrics.
    fn kind(&self) -> CheckKind;

    /// Techniques that the check supports.
    fn techniques(&self) -> &'static [Technique] {
        &Technique::ALL
    }

    /// Values of `max_bounces` that the check supports.
    fn bounces(&self) -> RangeInclusive<u32> {
        0..=u32::MAX
    }

    /// True if the check supports `emission_on_hit: off`, which isolates next event estimation.
    fn isolates_next_event_estimation(&self) -> bool {
        false
    }

    /// The value of `max_bounces` at which the check is most sensitive, in a scene whose default is
    /// `scene_default`.
    fn recommended_bounces(&self, scene_default: u32) -> u32 {
        scene_default.clamp(*self.bounces().start(), *self.bounces().end())
    }

    /// Checks whether it applies to a scene that has lights which its technique can find.
    ///
    /// # Errors
    /// The property of scene or specification that makes the check meaningless there.
    fn applies(&self, _scene: &SceneWithReference, _spec: &CheckSpec) -> Result<(), WhyNot> {
        Ok(())
    }

    /// Runs the check on the submission of the context.
    ///
    /// # Errors
    /// If the submission gives no valid answer, or the grader itself fails.
    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError>;

    /// The measurements as numbers that the diagnosis compares with those of known mistakes.
    fn observations(&self, evidence: &Evidence) -> Vec<Observation>;

    /// Checks whether a specification is valid, in whatever scene.
    ///
    /// # Errors
    /// The part of the specification that the check cannot use.
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

/// The outcome of running a check.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckOutcome {
    /// The verdict.
    pub verdict: Verdict,
    /// Code of the reason.
    pub reason: Reason,
    /// The measurements.
    pub evidence: Evidence,
    /// Samples that are not radiance.
    pub numerics: Numerics,
    /// Number of paths traced.
    pub samples: u64,
}

impl CheckOutcome {
    /// A pass for [`Reason::None`], a fail for any other reason.
    pub fn new(reason: Reason, evidence: Evidence, samples: u64) -> Self {
        let verdict = if reason == Reason::None { Verdict::Pass } else { Verdict::Fail };
        Self { verdict, reason, evidence, numerics: Numerics::default(), samples }
    }

    /// The same with samples that are not radiance. If there are any, the check fails for [`Reason::Numerics`].
    #[must_use]
    pub fn with(mut self, numerics: Numerics) -> Self {
        if !numerics.is_clean() {
            (self.verdict, self.reason) = (Verdict::Fail, Reason::Numerics);
        }
        Self { numerics, ..self }
    }
}

/// A measured number that helps to distinguish causes, with its standard error.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// The measured quantity.
    pub quantity: Quantity,
    /// Value.
    pub value: f64,
    /// Standard error.
    pub error: f64,
}

/// The quantity of an [`Observation`].
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// ln of the mean of a picture relative to the exact mean.
    Mean,
    /// ln of the energy of light after this many bounces relative to the exact energy.
    BounceEnergy(u32),
    /// ln of the variance relative to a technique of the solution.
    Noise(Technique),
    /// ln of the contribution of one of three lights relative to the exact contribution.
    LightShare(u32),
    /// Exponent of a factor in the odds of w_L, or of 1 − w_B.
    WeightExponent {
        /// True for w_L, false for 1 − w_B.
        of_light: bool,
        /// Index of the factor, as in [`WeightForm::Powers`](verdict::check::WeightForm::Powers).
        factor: u32,
    },
    /// Value of a constant weight w_L, or of 1 − w_B.
    WeightConstant {
        /// True for w_L, false for 1 − w_B.
        of_light: bool,
    },
    /// log₁₀ of the maximum of |w_L + w_B − 1|.
    WeightDeviation {
        /// True at the first vertex of a path, false at later ones.
        first_vertex: bool,
    },
    /// Weight of light that only one technique can find.
    OnlyWayWeight(OnlyWay),
    /// 1 if one of several scenes or runs of a check fails.
    WrongAt(WrongPlace),
}

impl Quantity {
    /// True if a correct submission has the value 0.
    pub fn is_zero_if_right(&self) -> bool {
        matches!(self, Self::Mean | Self::BounceEnergy(_))
    }

    /// True if a missing value carries no information: it may have been too noisy to measure.
    pub fn may_be_missing(&self) -> bool {
        matches!(self, Self::Mean | Self::BounceEnergy(_) | Self::Noise(_) | Self::LightShare(_))
    }

    /// Standard deviation of the value between programs with the same mistake.
    pub fn scale(&self, value: f64) -> f64 {
        match self {
            Self::Noise(_) => 0.3,
            Self::WeightExponent { .. } | Self::OnlyWayWeight(_) => 0.1,
            Self::WeightDeviation { .. } => 0.5,
            Self::WeightConstant { .. } => 0.02,
            Self::LightShare(_) => 0.002 + 0.1 * value.abs(),
            // 2 % plus a tenth of the error itself. Energies of later bounces are less accurate, since less light is
            // left.
            Self::BounceEnergy(bounces) => 0.02 + 0.02 * f64::from(bounces.pow(2)) + 0.1 * value.abs(),
            Self::Mean | Self::WrongAt(_) => 0.02 + 0.1 * value.abs(),
        }
    }
}

/// One of the scenes or runs of a check with several.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WrongPlace {
    /// A transformed scene.
    Change(SceneChange),
    /// The room scaled by 2^n.
    Scaled(i32),
    /// The room with all emission scaled by 2^n; 0 for the unchanged room.
    Brightened(i32),
    /// A scene of `scenes/extreme/`.
    ExtremeScene(String),
    /// Scripted densities.
    Densities,
    /// A map whose directions are sampled.
    Map(SampledMap),
    /// Different seeds give the same image.
    SameImage,
    /// Rendering the same seed again gives another image.
    NotRepeatable,
    /// Pixels of one image share random numbers.
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

/// Lower limit of ratios before the logarithm is taken.
const DARKEST: f64 = 0.02;

/// Half the width of a 99 % interval, in standard errors.
const MARGIN_IN_ERRORS: f64 = 2.6;

impl Observation {
    /// An observation without a standard error.
    pub fn exact(quantity: Quantity, value: f64) -> Self {
        Self { quantity, value, error: 0.0 }
    }

    /// An observation of ln of a ratio, clamped to a finite range; `margin` is half the width of its 99 % interval.
    pub fn ratio(quantity: Quantity, ratio: f64, margin: f64) -> Self {
        let limited = ratio.clamp(DARKEST, 1e4);
        Self { quantity, value: limited.ln(), error: margin / MARGIN_IN_ERRORS / limited }
    }

    /// The observation that the check fails at a place.
    pub fn wrong_at(place: WrongPlace) -> Self {
        Self::exact(Quantity::WrongAt(place), 1.0)
    }

    /// The observation of the whole picture's mean; empty if the test has none.
    pub fn of_mean(test: &MeanTest) -> Vec<Self> {
        let ratio =
            |whole: verdict::check::Effect| Self::ratio(Quantity::Mean, 1.0 + whole.relative, whole.margin);
        test.whole.map(ratio).into_iter().collect()
    }
}
