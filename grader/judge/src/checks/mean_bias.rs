//! **mean-bias**: does the submission converge to the reference image?

use verdict::check::{CheckKind, Evidence, WhyNot};
use verdict::error::Error;
use verdict::rubric::{CheckSpec, EmissionOnHit};

use super::means::{self, Picture};
use super::{Check, CheckOutcome, GradeContext, JobError, Observation, SceneWithReference, rare_light};
use crate::reference::Reference;
use crate::statistics::expected::Expected;

pub(super) struct MeanBias;

impl Check for MeanBias {
    fn kind(&self) -> CheckKind {
        CheckKind::MeanBias
    }

    fn isolates_next_event_estimation(&self) -> bool {
        true
    }

    fn applies(&self, scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
        rare_light::require(&scene.scene, spec)?;
        let nothing_lit = scene.scene.features().lit_surfaces == 0;
        if spec.emission_on_hit == EmissionOnHit::Off && nothing_lit {
            Err(WhyNot::NothingLit)
        } else {
            Ok(())
        }
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let scene = context.scene(spec);
        let expected = expected(spec, &scene.reference)?;
        let scenes = [&scene.description];
        means::run(context, spec, &Picture::of(context, spec, &scenes, &expected), Evidence::MeanBias)
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        evidence.mean_test().map(Observation::of_mean).unwrap_or_default()
    }
}

/// Expected mean and noise of a check's picture, from the reference of its scene.
///
/// # Errors
/// If the reference lacks that view or technique.
pub fn expected(spec: &CheckSpec, reference: &Reference) -> Result<Expected, Error> {
    let view = reference.views.get(&spec.view());
    view.and_then(|view| view.expected(spec.technique)).ok_or_else(|| {
        let CheckSpec { scene, technique, max_bounces, .. } = spec;
        let emission = if spec.emission_on_hit == EmissionOnHit::Off { ", emission_on_hit off" } else { "" };
        Error::Input(format!(
            "the reference of `{scene}` has no {technique} with max_bounces {max_bounces}{emission}: run `cargo lab \
             reference {scene}`"
        ))
    })
}
