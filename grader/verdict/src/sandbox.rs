//! Layers and level of a sandbox.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How well a submission is confined, from weakest to strongest.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema, clap::ValueEnum,
)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// A separate process only.
    None,
    /// Limits of memory and time.
    Weak,
    /// All but one of Landlock, seccomp and a user id other than root.
    Medium,
    /// All layers.
    Strong,
}

/// The active layers of a sandbox.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Layers {
    /// ABI version of Landlock; 0 if Landlock is inactive.
    pub landlock: u32,
    /// True if seccomp filters system calls.
    pub seccomp: bool,
    /// True if memory is limited.
    pub limits: bool,
    /// True if the process does not run as root.
    pub unprivileged: bool,
}

impl Level {
    /// Level of a set of layers.
    pub fn of(layers: Layers) -> Self {
        let Layers { landlock, seccomp, limits, unprivileged } = layers;
        match [landlock > 0, seccomp, unprivileged].into_iter().filter(|layer| !layer).count() {
            _ if !limits => Self::None,
            0 => Self::Strong,
            1 if landlock > 0 || seccomp => Self::Medium,
            _ => Self::Weak,
        }
    }

    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Weak => "weak",
            Self::Medium => "medium",
            Self::Strong => "strong",
        }
    }
}

impl std::fmt::Display for Level {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl Layers {
    /// Names of the layers that are not active.
    pub fn missing(self) -> Vec<&'static str> {
        let Self { landlock, seccomp, limits, unprivileged } = self;
        let layers = [
            (landlock > 0, "Landlock"),
            (seccomp, "seccomp"),
            (limits, "limits of memory"),
            (unprivileged, "a user id other than root"),
        ];
        layers.into_iter().filter(|(active, _)| !active).map(|(_, name)| name).collect()
    }

    /// Layers that are active in both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            landlock: self.landlock.min(other.landlock),
            seccomp: self.seccomp && other.seccomp,
            limits: self.limits && other.limits,
            unprivileged: self.unprivileged && other.unprivileged,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_missing_layer_lowers_the_level() {
        let all = Layers { landlock: 7, seccomp: true, limits: true, unprivileged: true };
        assert_eq!(Level::of(all), Level::Strong);
        for one in [
            Layers { landlock: 0, ..all },
            Layers { seccomp: false, ..all },
            Layers { unprivileged: false, ..all },
        ] {
            assert_eq!(Level::of(one), Level::Medium, "{one:?}");
            assert_eq!((all.and(one), one.missing().len()), (one, 1));
        }
        assert_eq!(Level::of(Layers { landlock: 0, seccomp: false, ..all }), Level::Weak);
        assert_eq!(Level::of(Layers { limits: false, ..all }), Level::None);
        assert_eq!(Level::of(Layers::default()), Level::None);
        assert!(Level::None < Level::Weak && Level::Medium < Level::Strong);
    }
}
