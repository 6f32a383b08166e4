//! **closed-form**: scenes in which each pixel has a closed form. The expected means do not depend on the reference;
//! only the expected variance does.

mod direct;
mod pixels;
mod planes;
mod polygon;
mod sky;

use arty::scene::{SceneDescription, Specular};

use verdict::check::{CheckKind, Evidence, WhyNot};
use verdict::error::Error;
use verdict::rubric::{CheckSpec, EmissionOnHit};

use super::means::{self, Picture};
use super::{
    Check, CheckOutcome, GradeContext, JobError, Observation, SceneWithReference, mean_bias, rare_light,
};
pub(super) use pixels::Pixels;
use pixels::RAYS;

/// Rays per pixel for testing whether a scene has a closed form.
const TEST_RAYS: u32 = 2;

pub(super) struct ClosedForm;

impl Check for ClosedForm {
    fn kind(&self) -> CheckKind {
        CheckKind::ClosedForm
    }

    fn isolates_next_event_estimation(&self) -> bool {
        true
    }

    fn recommended_bounces(&self, _: u32) -> u32 {
        // More scenes have a closed form for direct light than for global illumination.
        1
    }

    fn applies(&self, scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
        rare_light::require(&scene.scene, spec)?;
        pixel_means(scene, spec.max_bounces, EmissionOnHit::On, TEST_RAYS).map(drop)
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let scene = context.scene(spec);
        let pixels = pixel_means(scene, spec.max_bounces, spec.emission_on_hit, RAYS)
            .map_err(|why| Error::Input(format!("{}: the scene has no closed form ({why:?})", spec.id())))?;
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

/// Exact mean of each pixel.
///
/// # Errors
/// Why the scene has no closed form.
fn pixel_means(
    scene: &SceneWithReference,
    max_bounces: u32,
    emission_on_hit: EmissionOnHit,
    rays: u32,
) -> Result<Pixels, WhyNot> {
    if !only_flat_diffuse(&scene.description) {
        return Err(WhyNot::NotFlatDiffuse);
    }
    if emission_on_hit == EmissionOnHit::On
        && let Some(planes) = planes::recognise(&scene.description)
    {
        return planes.picture(&scene.scene, max_bounces, rays);
    }
    if max_bounces != 1 {
        return Err(WhyNot::SeveralBounces);
    }
    direct::picture(scene, emission_on_hit, rays)
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
    use arty::math::Rgb;
    use arty::scene::{EnvironmentDescription, Scene};
    use glam::Quat;

    use super::super::test_scenes;
    use super::*;

    /// References are rendered, closed forms are not: they agree up to the noise of the former and the quadrature
    /// error of the latter. One of 7 · 768 deviates exceeds 6 in one of 90,000 sets of references.
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
            let scene = test_scenes::load(name);
            let pixels = pixel_means(&scene, max_bounces, EmissionOnHit::On, RAYS)
                .unwrap_or_else(|why| panic!("{name}: {why:?}"));
            let view = verdict::rubric::View { max_bounces, emission_on_hit: EmissionOnHit::On };
            let rendered = &scene.reference.views[&view];
            let brightest = rendered.mean.iter().flatten().fold(0.0, |max: f64, &mean| max.max(mean));
            for (pixel, exact) in pixels.mean.iter().enumerate() {
                for channel in 0..3 {
                    let (exact, seen) = (exact[channel], rendered.mean[pixel][channel]);
                    let noise =
                        rendered.variance_of_mean[pixel][channel].sqrt().hypot(pixels.error[pixel][channel]);
                    assert!(
                        // At shadow boundaries rounding decides: tolerate 1e-4 of the brightest pixel.
                        (exact - seen).abs() <= 6.0 * noise + 2e-3 * exact + 1e-4 * brightest,
                        "{name}, pixel {pixel}: {seen} instead of {exact} (± {noise})"
                    );
                }
            }
        }
    }

    /// The scene in an environment of radiance 2 from all directions.
    fn in_constant_environment(name: &str) -> SceneWithReference {
        let mut scene = test_scenes::load(name);
        scene.description.lights.clear();
        scene.description.environment = Some(EnvironmentDescription {
            width: 1,
            height: 1,
            texels: vec![Rgb::gray(2.0)],
            rotation: Quat::IDENTITY,
        });
        scene.scene = Scene::new(&scene.description);
        scene
    }

    #[test]
    fn a_plane_in_a_constant_environment_shows_its_albedo() {
        let scene = in_constant_environment("point_plane");
        let pixels =
            pixel_means(&scene, 1, EmissionOnHit::On, TEST_RAYS).expect("nothing is above the plane");
        assert!(
            pixels.mean.iter().flatten().all(|mean| (mean - 0.5 * 2.0).abs() < 1e-4),
            "{:?}",
            pixels.mean[0]
        );
    }

    #[test]
    fn a_room_hides_its_environment() {
        let scene = in_constant_environment("cornell_box_point");
        let why = pixel_means(&scene, 1, EmissionOnHit::On, TEST_RAYS).err();
        assert_eq!(why, Some(WhyNot::PartlyHidden));
    }

    #[test]
    fn other_scenes_are_refused_with_the_reason() {
        for (name, max_bounces, expected) in [
            ("point_plane", 2, WhyNot::SeveralBounces),
            ("cornell_box", 1, WhyNot::PartlyHidden),
            ("cornell_box_glossy", 1, WhyNot::NotFlatDiffuse),
        ] {
            let why = pixel_means(&test_scenes::load(name), max_bounces, EmissionOnHit::On, TEST_RAYS).err();
            assert_eq!(why, Some(expected), "{name}");
        }
    }
}
