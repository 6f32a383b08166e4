//! The identity of a check.

use std::fmt;
use std::str::FromStr;

use arty::integrator::Technique;
use serde::{Deserialize, Serialize};

use super::CheckKind;
use crate::rubric::EmissionOnHit;

/// Identifies a check within an assignment. Its text, such as `mean-bias/cornell_box/nee/8`, parses back to the same
/// identity whatever the name of the scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct CheckId {
    /// Kind of check.
    pub kind: CheckKind,
    /// Name of the scene; [`SCRIPTED`](crate::rubric::SCRIPTED) for checks that build their own.
    pub scene: String,
    /// Technique of the submission.
    pub technique: Technique,
    /// Maximum number of bounces.
    pub max_bounces: u32,
    /// Whether `Hit::emission` returns emission.
    pub emission_on_hit: EmissionOnHit,
}

/// Who may see a check and its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Visibility {
    /// Everybody.
    Public,
    /// Staff only: its points count, and students are told only how many such checks there are and how many passed.
    StaffOnly,
}

/// Folder below `scenes/` of the scenes that are not handed out.
const STAFF_SCENES: &str = "hidden/";

/// Last part of the text of a check with `emission_on_hit: off`.
const EMISSION_OFF: &str = "emission-off";

impl CheckId {
    /// Staff only for randomly generated scenes and for scenes that are not handed out.
    pub fn visibility(&self) -> Visibility {
        Visibility::of(self.kind, &self.scene)
    }
}

impl Visibility {
    /// Visibility of a kind of check in a scene.
    pub fn of(kind: CheckKind, scene: &str) -> Self {
        if kind == CheckKind::HiddenVariants { Self::StaffOnly } else { Self::of_scene(scene) }
    }

    /// Visibility of everything that happens in a scene.
    pub fn of_scene(scene: &str) -> Self {
        if scene.starts_with(STAFF_SCENES) { Self::StaffOnly } else { Self::Public }
    }
}

impl fmt::Display for CheckId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, scene, technique, max_bounces, emission_on_hit } = self;
        write!(f, "{kind}/{scene}/{technique}/{max_bounces}")?;
        match emission_on_hit {
            EmissionOnHit::On => Ok(()),
            EmissionOnHit::Off => write!(f, "/{EMISSION_OFF}"),
        }
    }
}

impl FromStr for CheckId {
    type Err = String;

    /// Parses the text from both ends: the remaining middle is the scene, which may contain slashes.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not the name of a check, such as mean-bias/cornell_box/nee/8");
        let (rest, emission_on_hit) =
            match text.strip_suffix(EMISSION_OFF).and_then(|rest| rest.strip_suffix('/')) {
                Some(rest) => (rest, EmissionOnHit::Off),
                None => (text, EmissionOnHit::On),
            };
        let (rest, bounces) = rest.rsplit_once('/').ok_or_else(wrong)?;
        let (rest, technique) = rest.rsplit_once('/').ok_or_else(wrong)?;
        let (kind, scene) = rest.split_once('/').ok_or_else(wrong)?;
        let technique = Technique::ALL.into_iter().find(|other| other.name() == technique);
        let kind = CheckKind::ALL.into_iter().find(|other| other.name() == kind);
        Ok(Self {
            kind: kind.ok_or_else(wrong)?,
            scene: if scene.is_empty() { return Err(wrong()) } else { scene.to_owned() },
            technique: technique.ok_or_else(wrong)?,
            max_bounces: bounces.parse().map_err(|_| wrong())?,
            emission_on_hit,
        })
    }
}

impl TryFrom<String> for CheckId {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<CheckId> for String {
    fn from(id: CheckId) -> Self {
        id.to_string()
    }
}

impl schemars::JsonSchema for CheckId {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "CheckId".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "type": "string",
            "description": "kind/scene/technique/max_bounces, followed by /emission-off if emission_on_hit is off",
            "pattern": "^[a-z-]+/.+/(bsdf|nee|mis)/[0-9]+(/emission-off)?$"
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_identity_parses_back_whatever_the_name_of_the_scene() {
        for scene in
            ["cornell_box", "hidden/cellar", "a/nee/8", "emission-off", "x/emission-off", "nee", "8/mis/1"]
        {
            for emission_on_hit in [EmissionOnHit::On, EmissionOnHit::Off] {
                for technique in Technique::ALL {
                    for kind in CheckKind::ALL {
                        let scene = scene.to_owned();
                        let id = CheckId { kind, scene, technique, max_bounces: 8, emission_on_hit };
                        assert_eq!(id.to_string().parse(), Ok(id));
                    }
                }
            }
        }
    }

    #[test]
    fn malformed_identities_are_refused() {
        for text in [
            "",
            "mean-bias",
            "mean-bias/a/nee",
            "mean-bias//nee/8",
            "mean/a/nee/8",
            "mean-bias/a/ne/8",
            "mean-bias/a/nee/x",
        ] {
            assert!(text.parse::<CheckId>().is_err(), "{text}");
        }
    }

    #[test]
    fn random_scenes_and_scenes_not_handed_out_are_staff_only() {
        let visibility = |text: &str| text.parse::<CheckId>().map(|id| id.visibility());
        assert_eq!(visibility("mean-bias/cornell_box/nee/8"), Ok(Visibility::Public));
        assert_eq!(visibility("mean-bias/hidden/cellar/nee/8"), Ok(Visibility::StaffOnly));
        assert_eq!(visibility("hidden-variants/scripted/mis/6"), Ok(Visibility::StaffOnly));
    }
}
