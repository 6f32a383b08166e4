//! The ends of single precision.

use verdict::check::{Deviation, NumericalCause, Place, StabilityFinding, StabilityTest, Verdict};

use super::fault::{counts, place};
use super::means::tile;
use super::number::{count, percent, radiance, significant, superscript, trimmed};

/// What decided.
pub(super) fn stability(test: &StabilityTest, verdict: &Verdict) -> String {
    let graded = || test.findings.iter().filter(|finding| finding.is_graded);
    match graded().next() {
        Some(first) if *verdict != Verdict::Pass => match graded().count() - 1 {
            0 => sentence(first),
            1 => format!("{}; 1 more finding is among the remarks", sentence(first)),
            more => format!("{}; {more} more findings are among the remarks", sentence(first)),
        },
        _ => {
            let range =
                "correct for scales and radiances from 1/1024 to 1024 and densities from 1e-12 to 1e12";
            match test.findings.len() {
                0 => format!("{range}, and beyond"),
                more => format!("{range}; {} outside this range", count(more, "remark")),
            }
        }
    }
}

/// Everything that [`stability`] does not say, with the data of each.
pub(super) fn remarks(test: &StabilityTest) -> impl Iterator<Item = (String, &StabilityFinding)> {
    let decided = test.findings.iter().position(|finding| finding.is_graded);
    let others = test.findings.iter().enumerate().filter(move |(index, _)| Some(*index) != decided);
    others.map(|(_, finding)| (sentence(finding), finding))
}

/// What decided, without the place of a sample and without a cause; none if nothing graded is wrong.
pub(super) fn observation(test: &StabilityTest) -> Option<String> {
    let finding = test.findings.iter().find(|finding| finding.is_graded)?;
    Some(format!("{}, {}", scene_of(&finding.place), what(&finding.deviation)))
}

fn sentence(finding: &StabilityFinding) -> String {
    let StabilityFinding { place: at, deviation, likely_cause, first, .. } = finding;
    let first = match (first, deviation) {
        (Some(first), Deviation::Region { expected, .. }) => format!(
            "; the first is {}, {} instead of {}",
            place(first),
            significant(first.value[1].0),
            significant(expected.0)
        ),
        (Some(first), _) => {
            let value = radiance(first.value.map(|value| value.0));
            format!("; the first is {}, with the value {value}", place(first))
        }
        (None, _) => String::new(),
    };
    let cause = cause(likely_cause);
    let cause = if cause.is_empty() { cause } else { format!("; likely cause: {cause}") };
    format!("{}, {}{first}{cause}", scene_of(at), what(deviation))
}

fn scene_of(place: &Place) -> String {
    match place {
        Place::Unchanged => "in the unchanged scene".to_owned(),
        Place::Scaled(n) => format!("in a scene 2{} times as large", superscript(*n)),
        Place::Brightened(n) => format!("with lights 2{} times as bright", superscript(*n)),
        Place::ExtremeScene(scene) => format!("in {scene}"),
        Place::Densities { light, bsdf } => format!(
            "with a density per solid angle of {} for the light sample and {} for the BSDF sample",
            significant(light.0),
            significant(bsdf.0)
        ),
    }
}

fn what(deviation: &Deviation) -> String {
    let of_pairs = |[failed, all]: [u32; 2]| format!(" ({failed} of {all} pairs of densities)");
    match deviation {
        Deviation::Anomalies { non_finite, negative } => counts(*non_finite, *negative),
        Deviation::Region { pixels, relative, .. } => {
            let place = pixels.map_or_else(String::new, |pixels| format!(" in {}", tile(pixels)));
            let relative = relative.0;
            if !relative.is_finite() {
                return format!("the mean is not that of the unchanged scene{place}");
            }
            let side = if relative < 0.0 { "dark" } else { "bright" };
            let size = percent(relative.abs(), 1);
            format!("the mean is {size} too {side}{place}, compared with the unchanged scene")
        }
        Deviation::Mean { found, expected, because } => {
            let (found, expected) = (significant(found.0), significant(expected.0));
            format!("the mean is {found} instead of {expected} ({because})")
        }
        Deviation::Panic { message } => format!("the program panics: {message}"),
        Deviation::NoRadiance { of_light_sample, value, pairs } => {
            let which = if *of_light_sample { "light" } else { "BSDF" };
            format!("the {which} sample returns {}{}", significant(value.0), of_pairs(*pairs))
        }
        Deviation::WeightSum { sum, pairs } => {
            format!("the two weights sum to {} instead of 1{}", trimmed(sum.0, 4), of_pairs(*pairs))
        }
        Deviation::InfiniteDensityContributes { pairs } => {
            format!("a sample of infinite density contributes, although 1/∞ is 0{}", of_pairs(*pairs))
        }
    }
}

fn cause(cause: &NumericalCause) -> String {
    let text = match cause {
        NumericalCause::NoLights => {
            "the scene has no lights, so there is none to select: return black before you select one"
        }
        // The message says it.
        NumericalCause::Panic => "",
        NumericalCause::InvalidOperation => {
            "0/0, ∞/∞, or the square root or arc cosine of a number out of range"
        }
        NumericalCause::DivisionByZeroOrOverflow => "a division by zero, or an overflow (beyond 3.4e38)",
        NumericalCause::SignOfCosine => "a cosine whose sign is ignored",
        NumericalCause::PowerOfLength { size } => {
            return format!(
                "the square or cube of a length over- or underflows in a scene {size:.0e} units large"
            );
        }
        NumericalCause::FixedEpsilon { size, is_large } => {
            let fate = if *is_large { "large" } else { "small" };
            return format!(
                "a fixed epsilon or minimum distance, which is {fate} in a scene {size:.0e} units large"
            );
        }
        NumericalCause::ClampedRadiance { limit, samples } => {
            let samples = count(usize::try_from(*samples).unwrap_or(usize::MAX), "sample");
            return format!(
                "radiance is clamped to {}: {samples} have exactly this value",
                significant(limit.0)
            );
        }
        NumericalCause::LimitedRadiance => {
            "radiance is clamped or compressed, or an overflow is turned into 0"
        }
        NumericalCause::DroppedContributions => "small contributions are dropped, or underflow",
        NumericalCause::ConstantInRadiance => "a constant is added to radiance, or compared with it",
        NumericalCause::HiddenNanOrOffset => "NaN hidden as 0, or a ray that starts or ends too close",
        NumericalCause::Limit => "a limit on radiance, densities or distances",
        NumericalCause::LeakOrDoubleCount => "a ray passes through an occluder, or light is counted twice",
        NumericalCause::BothDensitiesZero => "0/0, as in p / (p + q) with both zero",
        NumericalCause::InfiniteDensity => "∞/∞, as in p / (p + q) with p infinite",
        NumericalCause::OtherDensityZero => "0/0 or 1/0, because the density of the other technique is zero",
        NumericalCause::DensityOverflow => "∞/∞ after a square or sum of densities overflowed",
        NumericalCause::DensityUnderflow => "0/0 after a square of densities underflowed",
        NumericalCause::DensityRange => "a quotient or product of densities over- or underflows",
        NumericalCause::OverflowPatchedToOne => {
            "where a square or sum of densities is infinite, both weights are set to 1"
        }
        NumericalCause::DensityNanHidden => {
            "the square of a density over- or underflows, and NaN is hidden as 0"
        }
        NumericalCause::ClampedDensities => "densities are clamped, or the two techniques weight differently",
        NumericalCause::InfinityOverInfinity => "∞/∞ turned into 1",
    };
    text.to_owned()
}
