//! **varied-scene**: the mean in a random variation of a known scene, new for each seed of a grade.
//!
//! It asks what mean-bias asks in that scene, where the answer cannot be known beforehand: reflectances, lights, camera
//! and orientation differ, and the environment is turned. As a required check it makes sure that points are earned by computing light transport: a
//! submission that knows the public pictures fails here, and any other passes here if it passes mean-bias. Sizes
//! and radiances stay close to those of the scene, so that absolute thresholds are no more harmful than there.

use arty::math::{Rgb, Vec3};
use arty::sampler::Sampler;
use arty::scene::{LightDescription, SceneDescription, Specular};
use glam::Quat;
use verdict::check::{CheckKind, Evidence, WhyNot};
use verdict::rubric::{CheckSpec, EmissionOnHit};

use super::metamorphic::Transform;
use super::{
    Check, CheckOutcome, GradeContext, JobError, Observation, SceneWithReference, against_oracle, means,
};

pub(super) struct VariedScene;

impl Check for VariedScene {
    fn kind(&self) -> CheckKind {
        CheckKind::VariedScene
    }

    fn applies(&self, _: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
        // The solution renders scenes as they are.
        if spec.emission_on_hit == EmissionOnHit::Off { Err(WhyNot::EmissionOff) } else { Ok(()) }
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let seed = context.seed_of(spec);
        let scene = varied(&context.scene(spec).description, &mut Sampler::new(seed, (0, 0), 0));
        let (judgement, anomalies) = against_oracle::judge(context, spec, &scene, seed, 1)?;
        let test = means::mean_test(&judgement, spec.tolerance);
        let outcome = means::conclude(&judgement, Evidence::VariedScene(test), judgement.samples);
        Ok(outcome.with(anomalies.numerics(None)))
    }

    fn observations(&self, _: &Evidence) -> Vec<Observation> {
        // Each seed has another scene, which cannot be compared.
        Vec::new()
    }
}

/// The scene with every reflectance and every light dimmed at random, seen at another angle, and turned as a whole.
fn varied(scene: &SceneDescription, random: &mut Sampler) -> SceneDescription {
    let mut between = |low: f32, high: f32| low + (high - low) * random.next_1d();
    let mut varied = scene.clone();
    let camera = &mut varied.camera;
    let side = camera.up.cross(camera.eye - camera.center).normalize();
    let look = Quat::from_axis_angle(camera.up.normalize(), between(-0.07, 0.07))
        * Quat::from_axis_angle(side, between(-0.07, 0.07));
    camera.center = camera.eye + look * (camera.center - camera.eye);
    camera.fov *= between(0.85, 1.0);
    let mut dim = |low: f32| Rgb::new(between(low, 1.0), between(low, 1.0), between(low, 1.0));
    for material in &mut varied.materials {
        material.diffuse *= dim(0.6);
        material.emission *= dim(0.5);
        match &mut material.specular {
            Specular::None => {}
            Specular::Phong { reflectance, .. } | Specular::Mirror { reflectance } => {
                *reflectance *= dim(0.6)
            }
            Specular::Glass { reflectance, transmittance, .. } => {
                *reflectance *= dim(0.6);
                *transmittance *= dim(0.6);
            }
        }
    }
    for light in &mut varied.lights {
        match light {
            LightDescription::Point { power, .. } | LightDescription::Spot { power, .. } => {
                *power *= dim(0.5)
            }
            LightDescription::Triangle { radiance, .. } => *radiance *= dim(0.5),
        }
    }
    if let Some(environment) = &mut varied.environment {
        let tint = dim(0.5);
        environment.texels.iter_mut().for_each(|texel| *texel *= tint);
        // About the vertical: what is below the horizon stays there.
        let turn = Quat::from_axis_angle(Vec3::Y, between(0.0, std::f32::consts::TAU));
        environment.rotation = (turn * environment.rotation).normalize();
    }
    let axis = Vec3::new(between(-1.0, 1.0), between(-1.0, 1.0), between(0.1, 1.0)).normalize();
    Transform { rotation: Quat::from_axis_angle(axis, between(0.0, 3.0)), scale: 1.0, offset: Vec3::ZERO }
        .apply(&varied)
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes;
    use super::*;
    use arty::scene::Scene;

    /// Radiance that the camera's rays could at most be sent back, and whether all of them hit something.
    fn brightest(description: &SceneDescription) -> (f32, bool) {
        let scene = Scene::new(description);
        let camera = scene.camera(8, 8);
        let hit = |pixel: u32| scene.intersect(&camera.ray(pixel % 8, pixel / 8, (0.5, 0.5))).is_some();
        let emission = description.materials.iter().map(|material| material.emission.luminance());
        (emission.fold(0.0, f32::max), (0..64).all(hit))
    }

    #[test]
    fn variations_differ_and_are_neither_brighter_nor_emptier() {
        for name in ["cornell_box_point", "light_behind_wall"] {
            let original = test_scenes::load(name).description;
            let (radiance, is_full) = brightest(&original);
            for seed in 0..40 {
                let draw = |seed| varied(&original, &mut Sampler::new(seed, (0, 0), 0));
                assert_eq!(draw(seed).hash(), draw(seed).hash());
                assert_ne!(draw(seed).hash(), draw(seed + 1).hash());
                let (varied_radiance, still_full) = brightest(&draw(seed));
                assert!(varied_radiance <= radiance, "{name}, seed {seed}");
                assert!(still_full || !is_full, "{name}, seed {seed}");
            }
        }
    }
}
