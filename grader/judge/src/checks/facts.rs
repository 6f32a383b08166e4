//! **facts**: does the estimator depend on every factor as it should?
//!
//! The facts of the [audit](crate::audit) about one technique: the exponent of each factor, the paths that contribute,
//! Russian roulette and the selection of lights, in scripted scenes. Pictures hardly show some of the mistakes that it
//! finds, such as light samples that are lost where BSDF sampling returns no direction. With `emission_on_hit: off`, only
//! facts about light samples count.
//!
//! A fact fails by chance once in 10,000 times if it varies with random decisions. It counts if it fails with two seeds.

use std::ops::RangeInclusive;

use arty::integrator::Technique;
use verdict::audit::{Fact, Place, Term};
use verdict::check::{CheckKind, Evidence, FailedFacts, Reason};
use verdict::rubric::{CheckSpec, EmissionOnHit};

use super::{Check, CheckOutcome, GradeContext, JobError, Observation};
use crate::audit::{self, TechniqueFacts};

pub(super) struct Facts;

impl Check for Facts {
    fn kind(&self) -> CheckKind {
        CheckKind::Facts
    }

    fn techniques(&self) -> &'static [Technique] {
        &[Technique::Nee, Technique::Mis]
    }

    /// Facts are measured at this number of hit points.
    fn bounces(&self) -> RangeInclusive<u32> {
        audit::HITS..=audit::HITS
    }

    fn isolates_next_event_estimation(&self) -> bool {
        true
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let decisive = |measured: TechniqueFacts| match measured.fault {
            Some(fault) => Err(JobError::Submission(fault)),
            None => Ok(measured.facts.into_iter().map(|(_, fact)| fact).filter(|fact| decides(fact, spec))),
        };
        let first: Vec<Fact> = decisive(context.audit.of(spec.technique)?)?.collect();
        let measured = first.len() as u32;
        let mut facts: Vec<Fact> = first.into_iter().filter(Fact::fails).collect();
        if !facts.is_empty() {
            let seed = context.seed_of(spec);
            let again: Vec<Fact> =
                decisive(audit::of_technique(context.program, spec.technique, seed)?)?.collect();
            facts.retain(|fact| again.iter().any(|other| other.fails() && other.id() == fact.id()));
        }
        let reason = if facts.is_empty() { Reason::None } else { Reason::Bias };
        Ok(CheckOutcome::new(reason, Evidence::Facts(FailedFacts { failed: facts, measured }), 0))
    }

    fn observations(&self, _: &Evidence) -> Vec<Observation> {
        Vec::new()
    }
}

/// True if a fact is a matter of this check. Conduct is that of others, such as `stability`.
fn decides(fact: &Fact, spec: &CheckSpec) -> bool {
    let is_of_light_sample =
        matches!(fact.term, Term::LightSample | Term::PointLight) && matches!(fact.place, Place::Hit(_));
    fact.term != Term::Conduct
        && (spec.emission_on_hit == EmissionOnHit::On || is_of_light_sample || fact.term == Term::Selection)
}
