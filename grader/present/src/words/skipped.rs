//! Why checks are skipped or not run.

use verdict::check::{NotRun, SkipReason, WhyNot};

use super::number::{count, percent, significant};

/// Why a check was skipped.
pub fn skipped(why: &SkipReason) -> String {
    match why {
        SkipReason::PointsLostTo(Some(check)) => format!("skipped because {check} failed"),
        SkipReason::PointsLostTo(None) => "skipped because a required check failed".to_owned(),
    }
}

/// Why a check could not be run.
pub fn not_run(why: NotRun) -> String {
    match why {
        NotRun::OutOfTime => "not run because earlier checks did not finish in time".to_owned(),
    }
}

/// Why a check means nothing in a scene, whatever the submission.
pub fn why_not(why: &WhyNot) -> String {
    let text = match why {
        WhyNot::NoLights => "there are no lights: every technique renders black",
        WhyNot::BsdfFindsNothing => "no light has an area: BSDF sampling renders black",
        WhyNot::BsdfFindsLittle { share, needed } => {
            return format!(
                "only {} of the bounces hit a light, too few to judge a mean of BSDF sampling: {} are needed",
                percent(*share, 1),
                percent(*needed, 0)
            );
        }
        WhyNot::NothingToWeigh => "no light has an area: there is nothing to weight",
        WhyNot::OneTechnique => "no light has an area: there is only one technique",
        WhyNot::NothingLit => {
            "every surface is black, a mirror or glass: next event estimation contributes nothing"
        }
        WhyNot::OneLight => "there is only one light to select",
        WhyNot::NotEnclosed => "the camera is not enclosed, so energy is lost",
        WhyNot::NotUniform => "the enclosure does not emit uniformly, so there is no closed form",
        WhyNot::NotFlatDiffuse => "closed forms need flat, diffuse surfaces without textures",
        WhyNot::SeveralBounces => "closed forms are known for one bounce only",
        WhyNot::ManyLights(lights) => {
            return format!("there are {}, too many to add up their closed forms", count(*lights, "light"));
        }
        WhyNot::SpotLight => "there is no closed form for spot lights",
        WhyNot::PartlyHidden => "an area light or the environment is partly occluded",
        WhyNot::UnknownNoise => "the reference does not contain the variance of the other techniques",
        WhyNot::AlikeNoise { at_most, needed } => {
            return format!(
                "the other techniques have at most {at_most:.1} times the variance of this one; a factor of {} is needed to tell them apart",
                significant(*needed)
            );
        }
        WhyNot::Technique => "this check does not apply to the technique",
        WhyNot::Bounces { min, max } if min == max => {
            return format!("this check needs exactly {}", count(*min as usize, "bounce"));
        }
        WhyNot::Bounces { min, max } => return format!("this check needs {min} to {max} bounces"),
        WhyNot::EmissionOff => "this check cannot be combined with `emission_on_hit: off` here",
        WhyNot::SceneNotHere => "the scene is not part of this checkout: only staff have it",
        WhyNot::NoSolution => "the solution is not part of this checkout: only staff have it",
    };
    text.to_owned()
}
