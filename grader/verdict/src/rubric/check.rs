//! One check of a task, as specified in a rubric.

use arty::integrator::Technique;
use serde::{Deserialize, Deserializer, Serialize};

use crate::check::{CheckId, CheckKind, Visibility};

/// One check of a task.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckSpec {
    /// Kind of check.
    pub check: CheckKind,
    /// Name of the scene; [`SCRIPTED`] for kinds that build their own.
    #[serde(default = "scripted")]
    pub scene: String,
    /// Technique of the submission.
    #[schemars(with = "crate::schema::TechniqueName")]
    pub technique: Technique,
    /// Maximum number of bounces.
    #[schemars(extend("maximum" = u32::MAX))]
    pub max_bounces: u32,
    /// `off` if emission on hit is black, so that only next event estimation finds light.
    #[serde(default)]
    pub emission_on_hit: EmissionOnHit,
    /// Weight of the check in the points of its task. A required check may weigh nothing: it then decides whether there
    /// are points, not how many.
    #[serde(default = "one")]
    #[schemars(range(min = 0))]
    pub weight: f64,
    /// True if it must pass for any points in the task. The untouched starting file must fail such a check.
    #[serde(default)]
    pub required: bool,
    /// Relative error of the whole image's mean that a pass excludes.
    #[serde(default = "two_percent")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub tolerance: f64,
    /// Name of the step of the task that begins with this check; `None` if the check belongs to the step of the one
    /// before it. Steps change no points.
    #[serde(default)]
    pub step: Option<String>,
    #[serde(default, rename = "evidence", deserialize_with = "renamed_to_required")]
    #[schemars(skip)]
    _evidence: (),
    #[serde(default, rename = "hits", deserialize_with = "renamed_to_emission_on_hit")]
    #[schemars(skip)]
    _hits: (),
}

fn renamed_to_required<'de, D: Deserializer<'de>>(_: D) -> Result<(), D::Error> {
    Err(serde::de::Error::custom("`evidence` is now called `required`"))
}

fn renamed_to_emission_on_hit<'de, D: Deserializer<'de>>(_: D) -> Result<(), D::Error> {
    Err(serde::de::Error::custom("`hits` is now called `emission_on_hit`"))
}

/// Scene name of checks that build their own scenes.
pub const SCRIPTED: &str = "scripted";

/// Whether `Hit::emission` returns emission.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    schemars::JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum EmissionOnHit {
    /// It is black: only next event estimation finds light.
    Off,
    /// It is that of the light.
    #[default]
    On,
}

/// Which light paths an image contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct View {
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Whether `Hit::emission` returns emission.
    pub emission_on_hit: EmissionOnHit,
}

impl CheckSpec {
    /// A check with default values, without a scene.
    pub fn new(check: CheckKind, technique: Technique, max_bounces: u32) -> Self {
        Self {
            check,
            scene: scripted(),
            technique,
            max_bounces,
            emission_on_hit: EmissionOnHit::On,
            weight: one(),
            required: false,
            tolerance: two_percent(),
            step: None,
            _evidence: (),
            _hits: (),
        }
    }

    /// Identity of the check.
    pub fn id(&self) -> CheckId {
        CheckId {
            kind: self.check,
            scene: self.scene.clone(),
            technique: self.technique,
            max_bounces: self.max_bounces,
            emission_on_hit: self.emission_on_hit,
        }
    }

    /// Who may see the check.
    pub fn visibility(&self) -> Visibility {
        Visibility::of(self.check, &self.scene)
    }

    /// Light paths that its images contain.
    pub fn view(&self) -> View {
        View { max_bounces: self.max_bounces, emission_on_hit: self.emission_on_hit }
    }

    /// Techniques whose noise the reference must record.
    pub fn techniques(&self) -> Vec<Technique> {
        match self.check {
            // Other techniques are compared with their noise where emission is on.
            CheckKind::Efficiency if self.emission_on_hit == EmissionOnHit::Off => vec![self.technique],
            CheckKind::Efficiency => [&[self.technique], rivals(self.technique)].concat(),
            CheckKind::Randomness | CheckKind::VariedScene => Vec::new(),
            _ => vec![self.technique],
        }
    }

    /// Checks the values that do not depend on the kind of check.
    ///
    /// # Errors
    /// The first wrong value.
    pub(super) fn validate(&self) -> Result<(), String> {
        let is_allowed = self.weight > 0.0 || (self.weight == 0.0 && self.required);
        if !(self.weight.is_finite() && is_allowed) {
            return Err("`weight` must be a positive number, or 0 for a required check".to_owned());
        }
        if self.check.needs_scene() == (self.scene == SCRIPTED) {
            let what = if self.check.needs_scene() { "needs a `scene`" } else { "takes no `scene`" };
            return Err(what.to_owned());
        }
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err("`tolerance` must be between 0 and 1".to_owned());
        }
        Ok(())
    }
}

/// Techniques that a technique must be less noisy than.
pub fn rivals(technique: Technique) -> &'static [Technique] {
    match technique {
        Technique::Bsdf => &[],
        Technique::Nee => &[Technique::Bsdf],
        Technique::Mis => &[Technique::Bsdf, Technique::Nee],
    }
}

fn scripted() -> String {
    SCRIPTED.to_owned()
}

fn one() -> f64 {
    1.0
}

fn two_percent() -> f64 {
    0.02
}
