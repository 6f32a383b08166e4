//! Checks: what each kind asks, and what it found.

use arty::integrator::Technique;

use verdict::check::{
    CheckKind, CheckResult, Evidence, FailedFacts, LightShares, Noise, PathLengths, PixelGroup,
    RandomNumbers, RayCounts, Reason, TooManyRays, Verdict,
};

use super::command::{replay_command, replay_of_finding};
use super::fact::fact;
use super::number::{count, list, percent, trimmed};
use super::{fault, means, numerics, sampling, skipped, stability, weights};

/// Why a check ended as it did: one sentence without a full stop.
pub fn explanation(check: &CheckResult) -> String {
    match &check.verdict {
        Verdict::Skipped { why } => return skipped::skipped(why),
        Verdict::NotRun { why } => return skipped::not_run(*why),
        Verdict::Pass | Verdict::Fail | Verdict::Inconclusive => {}
    }
    let text = what_happened(check);
    if check.short_look && check.verdict == Verdict::Inconclusive {
        format!("{text}; stopped early because a required check failed")
    } else {
        text
    }
}

fn what_happened(check: &CheckResult) -> String {
    if let Some(fault) = &check.fault {
        return fault::fault(fault);
    }
    if is_decided_by_samples(check) {
        return numerics(&check.numerics);
    }
    match &check.evidence {
        Some(evidence) => of_evidence(evidence, check),
        None => of_reason(check.reason).to_owned(),
    }
}

/// What is known where nothing was measured.
fn of_reason(reason: Reason) -> &'static str {
    match reason {
        Reason::None => "nothing is wrong",
        Reason::Bias => "the mean is wrong",
        Reason::Weights => "the MIS weights are wrong",
        Reason::Noise => "too noisy to judge",
        Reason::Efficiency => "noisier than the technique allows",
        Reason::Randomness => "random numbers are shared, or do not come from the sampler",
        Reason::RayBudget => "more rays than the sheet allows",
        Reason::Numerics => "some samples are NaN, infinite or negative",
        Reason::Timeout => "the program did not finish in time",
        Reason::Crash => "the program ended unexpectedly",
        Reason::Violation => "the program's answer was malformed",
    }
}

/// True if samples that are not radiance decided, whatever the mean. Kinds without pictures say themselves where they met
/// such samples.
fn is_decided_by_samples(check: &CheckResult) -> bool {
    !check.numerics.is_clean() && (check.evidence.is_none() || check.mean_test().is_some())
}

fn of_evidence(evidence: &Evidence, check: &CheckResult) -> String {
    let verdict = &check.verdict;
    match evidence {
        Evidence::ClosedForm(test) | Evidence::MeanBias(test) | Evidence::VariedScene(test) => {
            means::mean(test, verdict)
        }
        Evidence::HiddenVariants(test) => means::variant(test, verdict),
        Evidence::Metamorphic(test) => means::change(test, verdict),
        Evidence::WhiteFurnace(test) => means::furnace(test, verdict),
        Evidence::Efficiency(noise) => efficiency(noise, check.id.technique, verdict),
        Evidence::Facts(facts) => failed_facts(facts),
        Evidence::LightPick(shares) => light_pick(shares, check.id.technique),
        Evidence::MisWeights(test) => weights::weights(test),
        Evidence::Randomness(numbers) => randomness(*numbers),
        Evidence::PathLength(paths) => path_length(paths),
        Evidence::RayBudget(rays) if check.id.technique == Technique::Bsdf => long_paths(rays),
        Evidence::RayBudget(rays) => ray_budget(rays),
        Evidence::Sampling(test) => sampling::sampling(test),
        Evidence::Stability(test) => stability::stability(test, verdict),
    }
}

fn failed_facts(facts: &FailedFacts) -> String {
    let Some(first) = facts.failed.first() else {
        return format!("all {} facts about the estimator hold", facts.measured);
    };
    let others = match facts.failed.len() - 1 {
        0 => String::new(),
        others => format!("; {} more", count(others, "fact")),
    };
    format!("{}{others}", fact(first))
}

fn efficiency(noise: &Noise, technique: Technique, verdict: &Verdict) -> String {
    let Some(own) = noise.ratios.first() else {
        return "the image has no noise at all: every sample is the same".to_owned();
    };
    let factor = trimmed(own.ratio, if own.ratio < 10.0 { 2 } else { 0 });
    let text = format!("{factor} times the variance of the solution with `{technique}`");
    if *verdict == Verdict::Pass {
        return text;
    }
    match noise.as_noisy_as {
        Some(Technique::Bsdf) => format!("{text}, as much as BSDF sampling: light samples do not reduce it"),
        Some(Technique::Nee) => {
            format!("{text}, as much as next event estimation: lights that are hit do not reduce it")
        }
        Some(Technique::Mis) => format!("{text}, as much as multiple importance sampling"),
        None => text,
    }
}

/// Factors that differ by less, relatively, are the same.
const ALIKE: f64 = 0.01;

fn light_pick(shares: &LightShares, technique: Technique) -> String {
    let share = light_share(shares, technique);
    if technique == Technique::Bsdf {
        return share;
    }
    let Some(Some(excess)) = shares.wrong.map(|wrong| shares.excess.get(wrong as usize).copied().flatten())
    else {
        return share;
    };
    if !is_common(shares, 1.0 + excess) {
        format!("{share}: the selection probability you divide by is not the one you sample with")
    } else if is_alike(1.0 + excess, 1.0 / shares.excess.len() as f64) {
        format!("{share}: divide by the selection probability")
    } else if technique == Technique::Mis && excess < 0.0 {
        // The selection is right, or the lights would differ.
        format!("{share}: a path never hits a point light, so what weight must its light sample have?")
    } else {
        share
    }
}

/// What the lights contribute.
fn light_share(shares: &LightShares, technique: Technique) -> String {
    let Some(wrong) = shares.wrong else {
        if technique == Technique::Bsdf {
            return "no light is sampled, as it should be".to_owned();
        }
        return "each of the three lights contributes what it should".to_owned();
    };
    let number = wrong + 1;
    let Some(excess) = shares.excess.get(wrong as usize).copied().flatten() else {
        return format!("light {number} of 3 contributes NaN or infinity");
    };
    if technique == Technique::Bsdf {
        let share = percent(excess, 0);
        return format!(
            "point light {number} contributes {share} of what a light sample finds, although BSDF sampling never hits it: \
             light samples count with this technique, too"
        );
    }
    let share = percent(1.0 + excess, if excess.abs() < 0.05 { 2 } else { 0 });
    if is_common(shares, 1.0 + excess) {
        format!("each of the three lights contributes {share} of what it should")
    } else {
        format!("light {number} of 3 contributes {share} of what it should")
    }
}

/// True if all lights are wrong by this factor: then it is not their selection that is wrong.
fn is_common(shares: &LightShares, factor: f64) -> bool {
    shares.excess.iter().all(|other| other.is_some_and(|other| is_alike(1.0 + other, factor)))
}

fn is_alike(one: f64, other: f64) -> bool {
    (one - other).abs() < ALIKE * other.abs()
}

fn randomness(numbers: RandomNumbers) -> String {
    match numbers {
        RandomNumbers::Independent => "pixels, batches and seeds are independent and repeatable".to_owned(),
        RandomNumbers::SameImage([first, second]) => format!(
            "different seeds give the same image (batches {first} and {second}): the random numbers do not come from the \
             sampler"
        ),
        RandomNumbers::NotRepeatable => {
            "the same seed does not give the same image twice: either the random numbers do \
            not come from the sampler, or state is kept from one path to the next"
                .to_owned()
        }
        RandomNumbers::SharedByPixels { excess, pixels } => {
            let sums = match pixels {
                PixelGroup::Image => "the sum over the image has",
                PixelGroup::Row => "sums over rows have",
                PixelGroup::Column => "sums over columns have",
                PixelGroup::Tile => "sums over tiles of 4 × 4 pixels have",
            };
            let excess = trimmed(excess, 1);
            format!("pixels share random numbers: {sums} {excess} times the variance of independent pixels")
        }
    }
}

fn path_length(paths: &PathLengths) -> String {
    let asked = count(paths.max_bounces as usize, "bounce");
    match paths.limit {
        None => format!("paths reach up to {asked}"),
        Some(limit) => format!(
            "no path exceeds {}, although `max_bounces` allows {}: only `max_bounces` and Russian roulette may end a path",
            count(limit as usize, "bounce"),
            paths.max_bounces
        ),
    }
}

fn long_paths(rays: &RayCounts) -> String {
    let Some(TooManyRays { bounces, rays, allowed, .. }) = rays.excess else {
        return "most long paths end early".to_owned();
    };
    format!(
        "a path of up to {} traces {} on average; Russian roulette leaves less than {allowed} between dark walls",
        count(bounces as usize, "bounce"),
        count(rays as usize, "ray")
    )
}

fn ray_budget(rays: &RayCounts) -> String {
    let Some(TooManyRays { bounces, shadow_rays, rays: all, allowed }) = rays.excess else {
        return match &rays.panic_without_lights {
            None => "at most one shadow ray per bounce".to_owned(),
            Some(message) => format!(
                "the program panics in a scene without lights: {message}; there is no light to select, so return black before \
                 you select one. With lights, it traces at most one shadow ray per bounce"
            ),
        };
    };
    let room = format!("in a room with {}", count(rays.lights as usize, "light"));
    let bounces_of = count(bounces as usize, "bounce");
    if shadow_rays > bounces {
        let shadow_rays = count(shadow_rays as usize, "shadow ray");
        return format!("{shadow_rays} on a path of {bounces_of}, {room}: the sheet asks for one per bounce");
    }
    let (all, allowed) = (count(all as usize, "ray"), count(allowed as usize, "ray"));
    format!(
        "{all} on a path of {bounces_of}, {room}: {allowed} are enough, even if shadow rays and BSDF samples are traced \
         separately"
    )
}

/// The same without the place of a sample and without what probably caused it, to stand beside other observations.
pub(super) fn observation(check: &CheckResult) -> String {
    match &check.evidence {
        _ if check.fault.is_some() || !check.was_run() => explanation(check),
        Some(Evidence::LightPick(shares)) => light_share(shares, check.id.technique),
        Some(Evidence::Stability(test)) => stability::observation(test).unwrap_or_else(|| explanation(check)),
        _ if is_decided_by_samples(check) => {
            fault::counts(check.numerics.non_finite, check.numerics.negative)
        }
        _ => explanation(check),
    }
}

/// What costs no points, but is worth knowing.
pub fn remarks(check: &CheckResult) -> Vec<String> {
    match &check.evidence {
        Some(Evidence::Stability(test)) => stability::remarks(test).map(|(remark, _)| remark).collect(),
        Some(Evidence::Efficiency(noise)) if noise.is_noisier && check.verdict == Verdict::Pass => {
            let Some(own) = noise.ratios.first() else { return Vec::new() };
            vec![format!(
                "correct, but with {} times the variance of the solution at the same number of samples",
                trimmed(own.ratio, 1)
            )]
        }
        Some(Evidence::RayBudget(rays)) => {
            let mut remarks = Vec::new();
            if rays.shadow_rays_at_mirrors {
                remarks.push(
                    "shadow rays are traced at perfect mirrors, which reflect no light sample".to_owned(),
                );
            }
            if rays.shadow_rays_without_lights {
                remarks.push("shadow rays are traced in a scene without lights".to_owned());
            }
            remarks
        }
        _ => Vec::new(),
    }
}

/// The same, each with the command that follows the path that shows it, where there is one.
pub fn remarks_with_replay(check: &CheckResult, submission: &str) -> Vec<String> {
    let Some(Evidence::Stability(test)) = &check.evidence else { return remarks(check) };
    let with_replay = |(remark, finding)| match replay_of_finding(finding) {
        Some(target) => format!("{remark}; replay: {}", replay_command(target, submission)),
        None => remark,
    };
    stability::remarks(test).map(with_replay).collect()
}

/// Variance relative to that of the solution's techniques: "bsdf 0.12, nee 1.03"; empty where it was not measured.
pub(crate) fn variances(noise: &Noise) -> String {
    let parts: Vec<String> =
        noise.ratios.iter().map(|of| format!("{} {}", of.technique, trimmed(of.ratio, 2))).collect();
    list(&parts)
}

/// What a check does; continues "This check".
pub fn about(kind: CheckKind) -> &'static str {
    match kind {
        CheckKind::ClosedForm => "compares each pixel with a closed form, without a reference image",
        CheckKind::Efficiency => {
            "compares the variance with the solution's: the mean alone does not show whether a technique is used"
        }
        CheckKind::Facts => "measures how the estimator depends on each factor, in scripted scenes",
        CheckKind::HiddenVariants => {
            "compares means with the solution's in scenes generated at random from the seed"
        }
        CheckKind::LightPick => {
            "compares how often each light is selected with the probability you divide by"
        }
        CheckKind::MeanBias => "compares means of image regions with the reference: it tests bias, not noise",
        CheckKind::Metamorphic => {
            "changes the scene in ways whose effect on the image is known, such as rotating it"
        }
        CheckKind::MisWeights => {
            "measures individual MIS weights in scenes where only one technique can find the light"
        }
        CheckKind::Randomness => {
            "compares renderings with each other: random numbers must come from the sampler, and each may be used only once"
        }
        CheckKind::PathLength => "counts the bounces of paths in a closed room of mirrors",
        CheckKind::RayBudget => "counts the rays traced for each path",
        CheckKind::Sampling => {
            "compares sampled directions of an environment with their density, and that with the sheet's, in maps made for it"
        }
        CheckKind::Stability => "tests very small and very large scenes, radiances and densities",
        CheckKind::VariedScene => {
            "compares means with the solution's in a variation of the scene that depends on the seed"
        }
        CheckKind::WhiteFurnace => {
            "renders a closed surface that emits uniformly, where the energy of each bounce is known"
        }
    }
}
