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
    let start = Instant::now();
    let mut audit = Audit::default();
    let mut process = HostProcess::start(program, 1)?;
    for (_, group) in groups() {
        let mut prober = Prober { process: &mut process, seed: seed as u32, time: JOB_TIME };
        match group(&mut prober) {
            Ok(facts) => audit.facts.extend(facts),
            Err(JobError::Harness(error)) => return Err(error),
            Err(JobError::Submission(fault)) => {
                let ends = matches!(fault, Fault::Timeout(_) | Fault::TooSlow(_) | Fault::Crash(_));
                audit.fault.get_or_insert(fault);
                if ends {
                    break;
                }
            }
        }
    }
    sort(&mut audit.facts);
    audit.seconds = start.elapsed().as_secs_f64();
    Ok(audit)
}

/// Measures the facts about one technique.
///
/// # Errors
/// If the submission gives no valid answer, or the grader itself fails.
pub(crate) fn of_technique(
    process: &mut HostProcess,
    technique: Technique,
    seed: u64,
) -> std::result::Result<Vec<Fact>, JobError> {
    let mut facts = Vec::new();
    for (_, group) in groups().into_iter().filter(|(of, _)| *of == technique) {
        facts.extend(group(&mut Prober { process: &mut *process, seed: seed as u32, time: JOB_TIME })?);
    }
    sort(&mut facts);
    Ok(facts)
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
