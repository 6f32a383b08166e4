//! Facts that are measured once, whoever asks for them: checks, or the report.

use std::sync::{Mutex, PoisonError};

use arty::integrator::Technique;
use harness::build::SubmissionProgram;
use verdict::audit::Audit;
use verdict::error::Result;

use super::{TechniqueFacts, of_technique, sort};

/// The facts about a submission, each technique's measured when they are first asked for.
pub(crate) struct AuditOnce<'a> {
    program: &'a SubmissionProgram,
    seed: u64,
    /// The order is that of [`Technique::ALL`].
    measured: [Mutex<Option<TechniqueFacts>>; Technique::ALL.len()],
}

impl<'a> AuditOnce<'a> {
    /// Nothing is measured yet.
    pub(crate) fn new(program: &'a SubmissionProgram, seed: u64) -> Self {
        Self { program, seed, measured: Default::default() }
    }

    /// The facts about one technique.
    ///
    /// # Errors
    /// If the grader itself fails. Faults of the submission are part of the result.
    pub(crate) fn of(&self, technique: Technique) -> Result<TechniqueFacts> {
        let index = Technique::ALL.iter().position(|&other| other == technique).expect("these are all");
        let mut measured = self.measured[index].lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(facts) = &*measured {
            return Ok(facts.clone());
        }
        let facts = of_technique(self.program, technique, self.seed)?;
        Ok(measured.insert(facts).clone())
    }

    /// All facts. Once the submission has ended at a technique, others are no longer tried.
    ///
    /// # Errors
    /// If the grader itself fails.
    pub(crate) fn all(&self) -> Result<Audit> {
        let known = |slot: &Mutex<Option<TechniqueFacts>>| {
            slot.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(|facts| facts.ended)
        };
        let mut ended = self.measured.iter().any(|slot| known(slot) == Some(true));
        let (mut audit, mut facts) = (Audit::default(), Vec::new());
        for (technique, slot) in Technique::ALL.into_iter().zip(&self.measured) {
            if ended && known(slot).is_none() {
                continue;
            }
            let of = self.of(technique)?;
            ended |= of.ended;
            facts.extend(of.facts);
            audit.seconds += of.seconds;
            audit.fault = audit.fault.or(of.fault);
        }
        facts.sort_by_key(|(group, _)| *group);
        audit.facts = facts.into_iter().map(|(_, fact)| fact).collect();
        sort(&mut audit.facts);
        Ok(audit)
    }
}
