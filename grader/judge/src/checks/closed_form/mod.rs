//! **closed-form**: pictures whose every pixel has a formula. No reference has a say in them; only the noise that is
//! normal comes from one.

mod direct;
mod pixels;
mod planes;
mod polygon;

use arty::scene::{SceneDescription, Specular};

use verdict::check::{CheckKind, Evidence, WhyNot};
use verdict::error::Error;
use verdict::rubric::{CheckSpec, EmissionOnHit};

use super::means::{self, Picture};
use super::{Check, GradeContext, JobError, Observation, Outcome, SceneWithReference, mean_bias};
use pixels::{Pixels, RAYS};

/// Rays for each pixel that show whether there is a closed form.
const A_FEW: u32 = 2;

pub(super) struct ClosedForm;

impl Check for ClosedForm {
    fn kind(&self) -> CheckKind {
        CheckKind::ClosedForm
    }

    fn isolates_next_event_estimation(&self) -> bool {
        true
    }

    fn telling_bounces(&self, _: u32) -> u32 {
        // Direct light has a closed form in more scenes than all of it.
        1
    }

    fn applies(&self, scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
        answer(scene, spec.max_bounces, EmissionOnHit::On, A_FEW).map(drop)
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<Outcome, JobError> {
        let scene = context.scene(spec);
        let pixels = answer(scene, spec.max_bounces, spec.emission_on_hit, RAYS)
            .map_err(|why| Error::Input(format!("{}: no closed form ({why:?})", spec.id())))?;
        let mut expected = mean_bias::expected(spec, &scene.reference)?;
        expected.mean = pixels.mean;
        expected.error = pixels.error;
        let scenes = [&scene.description];
        means::run(context, spec, &Picture::of(context, spec, &scenes, &expected), Evidence::ClosedForm)
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        evidence.mean_test().map(Observation::of_mean).unwrap_or_default()
    }
}

/// What each pixel should be, or why nobody knows.
fn answer(
    judged: &SceneWithReference,
    max_bounces: u32,
    emission_on_hit: EmissionOnHit,
    rays: u32,
) -> Result<Pixels, WhyNot> {
    if !only_flat_diffuse(&judged.description) {
        return Err(WhyNot::NotFlatDiffuse);
    }
    if emission_on_hit == EmissionOnHit::On
        && let Some(planes) = planes::recognise(&judged.description)
    {
        return planes.picture(&judged.scene, max_bounces, rays);
    }
    if max_bounces != 1 {
        return Err(WhyNot::SeveralBounces);
    }
    direct::picture(judged, emission_on_hit, rays)
}

fn only_flat_diffuse(description: &SceneDescription) -> bool {
    let flat = |mesh: &arty::scene::Mesh| mesh.triangles.iter().all(|triangle| triangle.normals.is_none());
    let plain = |material: &arty::scene::Material| {
        material.specular == Specular::None && material.diffuse_map.is_none()
    };
    description.meshes.iter().all(flat) && description.materials.iter().all(plain)
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::judged;
    use super::*;

    /// The references are rendered, the closed forms are not: they agree to within the noise of the one and the
    /// quadrature of the other. Of 7 · 768 deviates one is beyond 6 in one of 90,000 sets of references.
    #[test]
    fn closed_forms_agree_with_references() {
        for (name, max_bounces) in [
            ("point_plane", 1),
            ("area_plane", 1),
            ("polygon_plane", 1),
            ("four_lights", 1),
            ("three_points", 1),
            ("point_grid", 1),
            ("parallel_planes", 8),
        ] {
            let judged = judged(name);
            let pixels = answer(&judged, max_bounces, EmissionOnHit::On, RAYS)
                .unwrap_or_else(|why| panic!("{name}: {why:?}"));
            let view = verdict::rubric::View { max_bounces, emission_on_hit: EmissionOnHit::On };
            let rendered = &judged.reference.views[&view];
            let brightest = rendered.mean.iter().flatten().fold(0.0, |most: f64, &mean| most.max(mean));
            for (pixel, exact) in pixels.mean.iter().enumerate() {
                for channel in 0..3 {
                    let (exact, seen) = (exact[channel], rendered.mean[pixel][channel]);
                    let noise =
                        rendered.variance_of_mean[pixel][channel].sqrt().hypot(pixels.error[pixel][channel]);
                    assert!(
                        // Where light only just comes over an edge, rounding decides: a ten thousandth of the picture.
                        (exact - seen).abs() <= 6.0 * noise + 2e-3 * exact + 1e-4 * brightest,
                        "{name}, pixel {pixel}: {seen} instead of {exact} (± {noise})"
                    );
                }
            }
        }
    }

    #[test]
    fn other_scenes_have_none_and_say_why() {
        for (name, max_bounces, expected) in [
            ("point_plane", 2, WhyNot::SeveralBounces),
            ("cornell_box", 1, WhyNot::PartlyHidden),
            ("cornell_box_glossy", 1, WhyNot::NotFlatDiffuse),
        ] {
            let why = answer(&judged(name), max_bounces, EmissionOnHit::On, A_FEW).err();
            assert_eq!(why, Some(expected), "{name}");
        }
    }
}
