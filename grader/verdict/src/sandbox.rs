//! How good a sandbox is, in one word.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How well a submission is confined. Later ones are better.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema, clap::ValueEnum,
)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// A process of its own, and nothing more.
    None,
    /// Limits of memory and time only.
    Weak,
    /// One of these is missing: files locked away, system calls filtered, a user id other than root.
    Medium,
    /// All of it.
    Strong,
}

/// The layers of a sandbox that are in force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Layers {
    /// The version of Landlock's interface; 0 if files are not locked away.
    pub landlock: u32,
    /// System calls are filtered.
    pub seccomp: bool,
    /// Memory is limited.
    pub limits: bool,
    /// The process does not run as root.
    pub unprivileged: bool,
}

impl Level {
    /// The level that these layers come to.
    pub fn of(layers: Layers) -> Self {
        let Layers { landlock, seccomp, limits, unprivileged } = layers;
        match [landlock > 0, seccomp, unprivileged].into_iter().filter(|layer| !layer).count() {
            _ if !limits => Self::None,
            0 => Self::Strong,
            1 if landlock > 0 || seccomp => Self::Medium,
            _ => Self::Weak,
        }
    }

    /// Its name in reports.
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
    /// What holds both here and there.
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
    fn each_missing_layer_costs_a_level() {
        let all = Layers { landlock: 7, seccomp: true, limits: true, unprivileged: true };
        assert_eq!(Level::of(all), Level::Strong);
        for one in [
            Layers { landlock: 0, ..all },
            Layers { seccomp: false, ..all },
            Layers { unprivileged: false, ..all },
        ] {
            assert_eq!(Level::of(one), Level::Medium, "{one:?}");
            assert_eq!(all.and(one), one);
        }
        assert_eq!(Level::of(Layers { landlock: 0, seccomp: false, ..all }), Level::Weak);
        assert_eq!(Level::of(Layers { limits: false, ..all }), Level::None);
        assert_eq!(Level::of(Layers::default()), Level::None);
        assert!(Level::None < Level::Weak && Level::Medium < Level::Strong);
    }
}
