//! The audit: facts about every factor of an estimator, measured in scripted scenes.
//!
//! In a scripted scene (`chain`) every answer is known. One answer is changed at a time, and the change of the result
//! shows its exponent (`contributions`, `weights`); which paths contribute at all is known exactly, too (`words`).
//! What is random (`decisions`) is measured with stratified numbers; `conduct` is about everything else. Facts about means hold for every correct program;
//! facts about the form of weights become remarks where a correct program may differ.

mod chain;
mod conduct;
mod contributions;
mod decisions;
mod facts;
mod measure;
mod once;
mod weights;
mod words;

use std::time::{Duration, Instant};

use arty::integrator::Technique;
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use harness::job::JobError;
use verdict::audit::{Audit, Fact, Factor};
use verdict::check::Fault;
use verdict::error::Result;

use measure::Prober;

pub(crate) use once::AuditOnce;

/// Time limit of one job, which takes a few milliseconds.
const JOB_TIME: Duration = Duration::from_secs(5);

/// Number of hit points at which contributions and weights are measured.
pub(crate) const HITS: u32 = 3;

/// Number of the hit point at which weights must still sum to one.
const LATE_HIT: u32 = 6;

/// A group of facts that are measured together.
type Group = Box<dyn Fn(&mut Prober<'_>) -> std::result::Result<Vec<Fact>, JobError>>;

/// Measures all facts about a submission. It uses one core.
///
/// # Errors
/// If the grader itself fails. Faults of the submission are part of the result.
pub fn audit(program: &SubmissionProgram, seed: u64) -> Result<Audit> {
    AuditOnce::new(program, seed).all()
}

/// The facts about one technique.
#[derive(Clone, Debug, Default)]
pub(crate) struct TechniqueFacts {
    /// The facts, with the number of their group.
    pub(crate) facts: Vec<(usize, Fact)>,
    /// What kept facts from being measured; `None` if nothing did.
    pub(crate) fault: Option<Fault>,
    /// True if the fault ended the submission, so that other facts will not be measured either.
    ended: bool,
    /// Wall time in seconds.
    seconds: f64,
}

/// Measures the facts about one technique.
///
/// # Errors
/// If the grader itself fails. Faults of the submission are part of the result.
pub(crate) fn of_technique(
    program: &SubmissionProgram,
    technique: Technique,
    seed: u64,
) -> Result<TechniqueFacts> {
    let start = Instant::now();
    let mut result = TechniqueFacts::default();
    let mut process = HostProcess::start(program, 1)?.within(program.limits.job_time);
    for (number, (_, group)) in groups().into_iter().enumerate().filter(|(_, (of, _))| *of == technique) {
        let mut prober = Prober { process: &mut process, seed: seed as u32, time: JOB_TIME };
        match group(&mut prober) {
            Ok(facts) => result.facts.extend(facts.into_iter().map(|fact| (number, fact))),
            Err(JobError::Harness(error)) => return Err(error),
            Err(JobError::Submission(fault)) => {
                result.ended = matches!(fault, Fault::Timeout(_) | Fault::TooSlow(_) | Fault::Crash(_));
                result.fault.get_or_insert(fault);
                if result.ended {
                    break;
                }
            }
        }
    }
    result.seconds = start.elapsed().as_secs_f64();
    Ok(result)
}

/// Light from nowhere is part of every other result, so that it is read first.
fn sort(facts: &mut [Fact]) {
    facts.sort_by_key(|fact| fact.factor != Factor::WithoutLight);
}

/// All groups with their techniques, in the order in which their failed facts should be read.
fn groups() -> Vec<(Technique, Group)> {
    let (bsdf, nee, mis) = (Technique::Bsdf, Technique::Nee, Technique::Mis);
    let mut groups: Vec<(Technique, Group)> = Vec::new();
    for technique in [nee, mis] {
        groups.push((technique, Box::new(move |it| conduct::brightness(it, technique))));
        groups.push((technique, Box::new(move |it| conduct::rays(it, technique))));
    }
    // A path that ends at random changes all that follows.
    groups.push((bsdf, Box::new(move |it| decisions::roulette(it, bsdf))));
    for hit in 1..=HITS {
        groups.push((bsdf, Box::new(move |it| contributions::hit(it, bsdf, hit))));
    }
    for technique in [nee, mis] {
        for hit in 1..=HITS {
            // What `nee` does right is not the fault of the light sample in `mis`: its weights come first.
            if technique == mis {
                groups.push((mis, Box::new(move |it| weights::facts(it, hit))));
            }
            groups.push((technique, Box::new(move |it| contributions::light_sample(it, technique, hit))));
            groups.push((technique, Box::new(move |it| contributions::point_light(it, technique, hit))));
            if technique == nee {
                groups.push((nee, Box::new(move |it| contributions::hit_with_nee(it, hit))));
            } else {
                groups.push((technique, Box::new(move |it| contributions::hit(it, technique, hit))));
            }
        }
        groups.push((technique, Box::new(move |it| decisions::selection(it, technique))));
    }
    groups.push((mis, Box::new(move |it| weights::sum(it, LATE_HIT))));
    for technique in [bsdf, nee, mis] {
        groups.push((technique, Box::new(move |it| words::facts(it, technique))));
        groups.push((technique, Box::new(move |it| words::long_path(it, technique))));
        if technique != bsdf {
            groups.push((technique, Box::new(move |it| decisions::roulette(it, technique))));
        }
    }
    for technique in [nee, mis] {
        groups.push((technique, Box::new(move |it| conduct::facts(it, technique))));
    }
    groups
}
