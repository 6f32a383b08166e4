//! **stability**: does the hand-in hold where numbers are small, large, or at an end?
//!
//! Three things are looked at. [`laws`]: a scene that is made larger or brighter must give the same picture, or the same
//! picture times a factor; with the same random numbers, and factors that are powers of two, a correct path tracer gives
//! it to the last bit, so that little noise is in the way. [`pictures`]: scenes with a known answer that are awkward for
//! floating-point numbers. [`densities`]: weights for densities at the ends of what single precision holds.
//!
//! Points depend on what lies in a generous range, scales and brightnesses of a thousandth to a thousand and densities of
//! 1e-12 to 1e12; what lies beyond is remarked on.

mod densities;
mod laws;
mod pictures;

use arty::integrator::{Settings, Technique};

use super::{Bench, Stop};
use harness::host_process::{Fault, HostProcess};
use verdict::error;
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::rubric::CheckSpec;

/// Something that a part of the check has found.
struct Finding {
    /// What is wrong, where, why probably, and how to see it again.
    text: String,
    /// True if points depend on it.
    judged: bool,
    /// Samples that were NaN or infinite, and negative.
    anomalies: [u64; 2],
}

impl Finding {
    /// Where it was found, the same for all hand-ins.
    fn key(&self) -> String {
        match self.text.split_once(": ") {
            Some((place, _)) if !place.starts_with(densities::BEGINNING) => place.to_owned(),
            _ => densities::BEGINNING.to_owned(),
        }
    }
}

/// What a part has found, and how many paths that took; or what the hand-in did instead of answering.
type Found = error::Result<Result<(Vec<Finding>, u64), Fault>>;

/// What all parts need.
struct Asked<'a> {
    bench: &'a Bench<'a>,
    settings: Settings,
    seed: u64,
}

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces };
    let asked = Asked { bench, settings, seed: bench.seed_of(spec) };
    let mut process = bench.start()?;
    type Part = fn(&Asked<'_>, &mut HostProcess) -> Found;
    let mut parts: Vec<Part> = vec![laws::find, pictures::find];
    if spec.technique == Technique::Mis {
        parts.push(densities::find);
    }
    let mut findings = Vec::new();
    for part in parts {
        let (found, paths) = part(&asked, &mut process)??;
        findings.extend(found);
        result.samples += paths;
    }
    conclude(result, findings);
    Ok(())
}

fn conclude(result: &mut CheckResult, findings: Vec<Finding>) {
    let (judged, remarks): (Vec<Finding>, Vec<Finding>) =
        findings.into_iter().partition(|finding| finding.judged);
    for finding in &judged {
        result.non_finite += finding.anomalies[0];
        result.negative += finding.anomalies[1];
    }
    result.details = judged.iter().map(|finding| (finding.key(), 1.0)).collect();
    (result.verdict, result.reason, result.explanation) = match judged.first() {
        Some(first) => {
            let reason = if judged.iter().any(|finding| finding.anomalies != [0; 2]) {
                Reason::Numerics
            } else {
                Reason::Bias
            };
            let more = match judged.len() {
                1 => String::new(),
                count => format!(" (and {} more: see the remarks)", count - 1),
            };
            (Verdict::Fail, reason, format!("{}{more}", first.text))
        }
        None => {
            let more = match remarks.len() {
                0 => "and so is all beyond that was looked at".to_owned(),
                1 => "one remark on what lies beyond".to_owned(),
                count => format!("{count} remarks on what lies beyond"),
            };
            let range = "scales and brightnesses from 1/1024 to 1024, densities from 1e-12 to 1e12";
            (Verdict::Pass, Reason::None, format!("right for {range}; {more}"))
        }
    };
    result.remarks = judged.into_iter().skip(1).chain(remarks).map(|finding| finding.text).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_cost_nothing_and_findings_do() {
        let json = r#"{"id": "", "check": "stability", "scene": "", "task": "", "technique": "mis", "max_bounces": 3,
            "evidence": false, "verdict": "error", "reason": "harness", "explanation": "", "effect": null, "interval": null,
            "detectable": null, "samples": 0, "seconds": 0, "non_finite": 0, "negative": 0, "repeat": ""}"#;
        let mut result: CheckResult = serde_json::from_str(json).expect("it is a result");
        let finding = |judged, anomalies| Finding { text: "x".to_owned(), judged, anomalies };
        conclude(&mut result, vec![finding(false, [3, 0])]);
        assert_eq!((result.verdict, result.non_finite, result.remarks.len()), (Verdict::Pass, 0, 1));
        conclude(&mut result, vec![finding(false, [0, 0]), finding(true, [0, 0])]);
        assert_eq!((result.verdict, result.reason), (Verdict::Fail, Reason::Bias));
        conclude(&mut result, vec![finding(true, [1, 2])]);
        assert_eq!((result.reason, result.non_finite, result.negative), (Reason::Numerics, 1, 2));
    }
}
