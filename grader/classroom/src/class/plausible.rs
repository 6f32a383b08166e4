//! Whether a class is likely to be the one that is meant, before anything is graded.

use super::Class;
use crate::policy::{Manifest, Policy};
use verdict::error::{Error, Result};

/// Signs of a wrong folder or roster that a person has looked at.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accepted {
    /// More than half of the roster may be missing.
    pub missing: bool,
    /// Submissions may be of people whom no table names.
    pub unknown: bool,
}

/// Maximum number of names in a message.
const NAMED: usize = 5;

impl Class {
    /// Checks that the roster fits the submissions and the extensions. Without a roster, there is nothing to compare.
    ///
    /// # Errors
    /// [`Error::Input`] if an extension is of nobody, or two are of the same student; [`Error::Harness`] if a submission
    /// is of nobody whom the tables name, or most of the roster is missing: their points would be wrong.
    pub fn check(
        &self,
        policy: Option<&Policy>,
        manifest: Option<&Manifest>,
        accepted: Accepted,
    ) -> Result<()> {
        if !self.members.iter().any(|member| member.on_roster) {
            return Ok(());
        }
        for name in policy.into_iter().flat_map(Policy::extended) {
            match self.members.iter().filter(|member| member.is_called(name)).count() {
                1 => {}
                0 => {
                    return Err(Error::Input(format!(
                        "the extension of `{name}` is of nobody in the class: write the login as in the roster"
                    )));
                }
                count => {
                    return Err(Error::Input(format!(
                        "the extension of `{name}` can be of {count} students: write the login of one"
                    )));
                }
            }
        }
        for member in &self.members {
            let own = policy.into_iter().flat_map(Policy::extended).filter(|name| member.is_called(name));
            if let [one, other, ..] = own.collect::<Vec<_>>().as_slice() {
                let key = &member.key;
                return Err(Error::Input(format!(
                    "the extensions of `{one}` and `{other}` are both of {key}"
                )));
            }
        }
        let is_named = |name: &str| manifest.is_some_and(|manifest| !manifest.of(&[name]).is_empty());
        let unknown = self.members.iter().filter(|member| member.student.is_none());
        let unknown: Vec<&str> = unknown
            .filter(|member| !member.names().into_iter().any(is_named))
            .map(|member| member.label.as_str())
            .collect();
        if !unknown.is_empty() && !accepted.unknown {
            return Err(Error::Harness(format!(
                "no roster, worksheet or manifest names the student of {}: add who it is (a column `team` for a team), \
                 or grade it as a row of its own with --allow-unknown",
                listed(&unknown)
            )));
        }
        let on_roster: Vec<_> = self.members.iter().filter(|member| member.on_roster).collect();
        let missing: Vec<&str> = on_roster
            .iter()
            .filter(|member| member.paths.is_empty() && member.receipts.is_empty())
            .map(|member| member.key.as_str())
            .collect();
        if 2 * missing.len() > on_roster.len() && !accepted.missing {
            return Err(Error::Harness(format!(
                "{} of {} students on the roster have no submission in {}: check that folder and roster are of the same \
                 class; if they are, grade it with --allow-missing",
                missing.len(),
                on_roster.len(),
                self.folder.display()
            )));
        }
        Ok(())
    }
}

/// The first names of a list, and how many there are besides.
fn listed(names: &[&str]) -> String {
    let first = names.iter().take(NAMED).copied().collect::<Vec<_>>().join(", ");
    let rest = names.len().saturating_sub(NAMED);
    if rest == 0 { first } else { format!("{first} and {rest} more") }
}
