//! One check of a task, as a rubric names it.

use arty::integrator::Technique;
use serde::{Deserialize, Serialize};

/// One check of a task.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckSpec {
    /// Which kind of check.
    pub check: CheckKind,
    /// In which scene; [`SCRIPTED`] for the kinds that make their own.
    #[serde(default = "scripted")]
    pub scene: String,
    /// With which technique of the hand-in.
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// `off` if lights that a path hits emit nothing, so that only next event estimation finds light.
    #[serde(default)]
    pub hits: Hits,
    /// How many shares of the task's points it carries.
    #[serde(default = "one")]
    pub weight: f64,
    /// True if the task earns nothing without it: an untouched starting file must fail such a check.
    #[serde(default)]
    pub evidence: bool,
    /// The relative error of the whole image's mean that a pass excludes.
    #[serde(default = "two_percent")]
    pub tolerance: f64,
}

/// The name that stands for the scene of checks that make their own.
pub const SCRIPTED: &str = "scripted";

/// Whether lights that a path hits emit anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Hits {
    /// They do not: what is left is next event estimation alone.
    Off,
    /// They do, as ever.
    #[default]
    On,
}

/// Which light a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct View {
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// Whether lights that are hit count.
    pub hits: Hits,
}

/// The kinds of checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CheckKind {
    /// Means against formulas for each pixel.
    ClosedForm,
    /// Noise against that of other techniques.
    Efficiency,
    /// Means in scenes that are drawn at random, against the solution.
    HiddenVariants,
    /// Whether lights are picked as often as is divided by.
    LightPick,
    /// Means against a reference image.
    MeanBias,
    /// Means in scenes that are changed in ways that must not show.
    Metamorphic,
    /// The weights of multiple importance sampling, one by one; `max_bounces` is the longest path that is looked at.
    MisWeights,
    /// Whether pixels, batches and seeds are independent.
    Randomness,
    /// How many rays a path takes; `max_bounces` is the longest path that is looked at.
    RayBudget,
    /// Scenes and densities at the ends of what numbers can be.
    Stability,
    /// Means against the closed form of a uniformly emitting enclosure.
    WhiteFurnace,
}

impl CheckKind {
    /// All of them, by name.
    pub const ALL: [Self; 11] = [
        Self::ClosedForm,
        Self::Efficiency,
        Self::HiddenVariants,
        Self::LightPick,
        Self::MeanBias,
        Self::Metamorphic,
        Self::MisWeights,
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
            Self::Randomness => "randomness",
            Self::RayBudget => "ray-budget",
            Self::Stability => "stability",
            Self::WhiteFurnace => "white-furnace",
        }
    }

    /// True if it asks whether what is right in known scenes is right in others, too: it says nothing new of a hand-in
    /// that is wrong in those.
    pub fn goes_further(self) -> bool {
        matches!(self, Self::HiddenVariants | Self::Metamorphic | Self::Stability)
    }

    /// True if it is looked at in a scene of the collection.
    pub fn needs_scene(self) -> bool {
        !matches!(
            self,
            Self::HiddenVariants | Self::LightPick | Self::MisWeights | Self::RayBudget | Self::Stability
        )
    }
}

impl CheckSpec {
    /// A check with everything else as it is if a rubric says nothing, in no scene yet.
    pub fn new(check: CheckKind, technique: Technique, max_bounces: u32) -> Self {
        Self {
            check,
            scene: scripted(),
            technique,
            max_bounces,
            hits: Hits::On,
            weight: one(),
            evidence: false,
            tolerance: two_percent(),
        }
    }

    /// What tells this check from all others: `mean-bias/cornell_box/nee/8`.
    pub fn id(&self) -> String {
        let hits = if self.hits == Hits::Off { "/hits-off" } else { "" };
        format!("{}/{}/{}/{}{hits}", self.check.name(), self.scene, self.technique, self.max_bounces)
    }

    /// Which light its pictures show.
    pub fn view(&self) -> View {
        View { max_bounces: self.max_bounces, hits: self.hits }
    }

    /// The techniques of which a reference has to know the noise.
    pub fn techniques(&self) -> Vec<Technique> {
        match self.check {
            CheckKind::Efficiency => [&[self.technique], rivals(self.technique)].concat(),
            CheckKind::Randomness => Vec::new(),
            _ => vec![self.technique],
        }
    }

    /// Says what is wrong with it, if anything is.
    pub(super) fn validate(&self) -> Result<(), String> {
        if !(self.weight.is_finite() && self.weight > 0.0) {
            return Err("`weight` must be a positive number".to_owned());
        }
        if self.check.needs_scene() == (self.scene == SCRIPTED) {
            let what = if self.check.needs_scene() { "needs a `scene`" } else { "takes no `scene`" };
            return Err(what.to_owned());
        }
        let by_means = matches!(self.check, CheckKind::MeanBias | CheckKind::ClosedForm);
        if self.hits == Hits::Off && !(by_means && self.technique == Technique::Nee) {
            return Err("`hits: off` goes with mean-bias and closed-form, and with nee only".to_owned());
        }
        let few_bounces = (1..=3).contains(&self.max_bounces);
        if self.check == CheckKind::MisWeights && (self.technique != Technique::Mis || !few_bounces) {
            return Err("mis-weights goes with the technique mis and 1 to 3 bounces only".to_owned());
        }
        if self.check == CheckKind::RayBudget && (self.technique == Technique::Bsdf || !few_bounces) {
            return Err("ray-budget goes with the techniques nee and mis and 1 to 3 bounces only".to_owned());
        }
        if self.check == CheckKind::LightPick && (self.technique == Technique::Bsdf || self.max_bounces != 1)
        {
            return Err("light-pick goes with the techniques nee and mis and 1 bounce only".to_owned());
        }
        if self.check == CheckKind::Stability && self.technique == Technique::Bsdf {
            return Err("stability goes with the techniques nee and mis only".to_owned());
        }
        if self.check == CheckKind::Efficiency && self.technique == Technique::Bsdf {
            return Err("efficiency goes with the techniques nee and mis only".to_owned());
        }
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err("`tolerance` must be between 0 and 1".to_owned());
        }
        Ok(())
    }
}

/// The techniques that a technique has to be less noisy than.
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
