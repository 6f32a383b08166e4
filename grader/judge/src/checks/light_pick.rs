//! **light-pick**: is each light picked as often as the division by its probability says?
//!
//! A red, a green and a blue point light over a diffuse floor: each channel shows one light, and its mean is ρ/π · I cos θ
//! / d², however lights are picked, if that probability is the one that is divided by. A pick like `random * (n − 0.01)`
//! is off by less than a percent, which would take millions of paths to see. So the hand-in's own random numbers are
//! stratified: then each light's share is exact, and a few thousand paths tell.

use std::f64::consts::PI;

use arty::integrator::Settings;
use arty::math::{Rgb, Vec3, direction_and_distance};
use arty::sampler::batch_seed;
use arty::scene::{
    CameraDescription, Defaults, LightDescription, Material, Mesh, MeshTriangle, SceneDescription, Specular,
};
use host::protocol::{ProbeJob, ScriptedScene};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::{Bench, Stop};
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::rubric::CheckSpec;

/// Paths in each stratified set, and such sets.
const PATHS: u64 = 4096;
const SETS: u64 = 8;

/// Relative differences up to this are rounding and the width of a stratum.
const TOLERATED: f64 = 1e-3;

/// Beyond that, the level at which a channel's mean has to be wrong.
const LEVEL: f64 = 1e-6;

const ALBEDO: f32 = 0.6;
const POWER: f32 = 50.0;

const CHANNELS: [&str; 3] = ["first", "second", "third"];

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let mut process = bench.start()?;
    let settings = Settings { technique: spec.technique, max_bounces: spec.max_bounces };
    let scene = scene();
    let mut means = Vec::new();
    for set in 0..SETS {
        let seed = batch_seed(bench.seed_of(spec), set);
        let scenes = vec![scene.clone()];
        let paths =
            process.probe(&ProbeJob { settings, scenes, samples: PATHS, seed, stratified: true })??;
        let mut mean = [0.0; 3];
        for path in paths.iter().flatten() {
            (0..3).for_each(|channel| mean[channel] += f64::from(path.radiance[channel]) / PATHS as f64);
        }
        means.push(mean);
    }
    result.samples = SETS * PATHS;
    let shares: Vec<Share> = (0..3).map(|channel| Share::of(&means, channel)).collect();
    let worst = shares.iter().enumerate().max_by(|a, b| a.1.ratio.abs().total_cmp(&b.1.ratio.abs()));
    result.effect = worst.map(|(_, share)| share.ratio);
    let finite =
        |(name, share): (&str, &Share)| share.ratio.is_finite().then(|| (name.to_owned(), share.ratio));
    result.details = CHANNELS.into_iter().zip(&shares).filter_map(finite).collect();
    let wrong = shares.iter().position(|share| !share.ratio.is_finite() || share.p_value < LEVEL);
    (result.verdict, result.reason, result.explanation) = match wrong {
        Some(channel) => (
            Verdict::Fail,
            Reason::Bias,
            format!(
                "of three lights the {} counts {:.4} times: it is not picked with the probability that is divided by",
                CHANNELS[channel],
                1.0 + shares[channel].ratio
            ),
        ),
        None => (Verdict::Pass, Reason::None, "each of three lights counts once".to_owned()),
    };
    Ok(())
}

/// How much one light counts.
struct Share {
    /// Relative to what it should, less 1.
    ratio: f64,
    /// How likely a correct pick looks like this. Numbers that are used in a way that strata do not even out vary from
    /// set to set, and then more is allowed.
    p_value: f64,
}

impl Share {
    fn of(means: &[[f64; 3]], channel: usize) -> Self {
        let expected = expected(channel);
        let ratios: Vec<f64> = means.iter().map(|mean| mean[channel] / expected - 1.0).collect();
        let count = ratios.len() as f64;
        let ratio = ratios.iter().sum::<f64>() / count;
        let spread = ratios.iter().map(|other| (other - ratio).powi(2)).sum::<f64>() / (count - 1.0);
        let error = (spread / count).sqrt();
        let excess = (ratio.abs() - TOLERATED).max(0.0);
        let p_value = match (excess > 0.0, error > 0.0) {
            (false, _) => 1.0,
            (true, false) => 0.0,
            (true, true) => StudentsT::new(0.0, 1.0, count - 1.0)
                .map_or(1.0, |distribution| 2.0 * distribution.sf(excess / error)),
        };
        Self { ratio, p_value }
    }
}

/// The floor's point that the path hits.
const SEEN: Vec3 = Vec3::new(0.1, 0.0, -0.2);

fn light(index: usize) -> Vec3 {
    let angle = std::f32::consts::TAU * index as f32 / 3.0;
    SEEN + Vec3::new(0.8 * angle.cos(), 1.5, 0.8 * angle.sin())
}

fn expected(channel: usize) -> f64 {
    let to_light = (light(channel) - SEEN).as_dvec3();
    let cos = to_light.normalize().y;
    f64::from(ALBEDO) / PI * f64::from(POWER) / (4.0 * PI) * cos / to_light.length_squared()
}

fn scene() -> ScriptedScene {
    let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z);
    let floor = Mesh {
        positions: vec![corner(-9.0, 9.0), corner(9.0, 9.0), corner(0.0, -9.0)],
        triangles: vec![MeshTriangle { positions: [0, 1, 2], normals: None, uvs: None, material: 0 }],
        ..Mesh::default()
    };
    let light = |index: usize| {
        let mut power = [0.0; 3];
        power[index] = POWER;
        LightDescription::Point { position: light(index), power: Rgb::from(power) }
    };
    let eye = Vec3::new(0.5, 2.0, 0.7);
    ScriptedScene {
        scene: SceneDescription {
            camera: CameraDescription { eye, center: SEEN, up: Vec3::Y, fov: 40.0 },
            meshes: vec![floor],
            materials: vec![Material {
                name: "floor".to_owned(),
                diffuse: Rgb::gray(ALBEDO),
                diffuse_map: None,
                specular: Specular::None,
                emission: Rgb::BLACK,
            }],
            textures: Vec::new(),
            lights: (0..3).map(light).collect(),
            defaults: Defaults::default(),
        },
        bsdfs: vec![None],
        lights: Vec::new(),
        origin: eye,
        direction: direction_and_distance(eye, SEEN).0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exact_share_that_is_off_is_wrong_and_a_noisy_one_is_not() {
        let share = |ratios: &[f64]| {
            let means: Vec<[f64; 3]> = ratios.iter().map(|ratio| [expected(0) * ratio; 3]).collect();
            Share::of(&means, 0)
        };
        assert_eq!(share(&[1.0005; 8]).p_value, 1.0);
        assert!(share(&[0.9966, 0.9967, 0.9966, 0.9967, 0.9966, 0.9967, 0.9966, 0.9967]).p_value < LEVEL);
        assert!(share(&[0.97, 1.02, 1.01, 0.99, 1.03, 0.98, 0.95, 1.01]).p_value > 0.01);
    }
}
