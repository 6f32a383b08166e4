//! Random scenes over wide ranges: radiance is finite, non-negative, and independent of the scale of the scene.

#[path = "../src/algorithms/render_pt.rs"]
pub mod render_pt;

use arty::math::{Rgb, Vec3};
use arty::prelude::{Integrator, Settings, Technique};
use arty::render::sample_pixel;
use arty::sampler::Streams;
use arty::scene::{
    CameraDescription, Defaults, LightDescription, Material, Mesh, MeshTriangle, Scene, SceneDescription,
    Specular,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, RngSeed};
use render_pt::PathTracer;

/// A number between two powers of ten, uniform in its logarithm.
fn magnitude(powers: std::ops::Range<f32>) -> impl Strategy<Value = f32> {
    powers.prop_map(|power| 10f32.powf(power))
}

fn point() -> impl Strategy<Value = Vec3> {
    [-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0].prop_map(Vec3::from_array)
}

/// Triangles with sizes from a thousandth to five, including needles.
fn triangle() -> impl Strategy<Value = [Vec3; 3]> {
    (point(), point(), point(), magnitude(-3.0..0.7), magnitude(-4.0..0.0))
        .prop_map(|(corner, a, b, size, slim)| [corner, corner + size * a, corner + size * (a + slim * b)])
}

fn material() -> impl Strategy<Value = Material> {
    let specular = prop_oneof![
        3 => Just(Specular::None),
        2 => magnitude(0.0..6.0).prop_map(|exponent| Specular::Phong { reflectance: Rgb::gray(0.5), exponent }),
        1 => Just(Specular::Mirror { reflectance: Rgb::gray(0.5) }),
        1 => magnitude(-4.0..0.3).prop_map(|excess| Specular::Glass {
            index: 1.0 + excess,
            reflectance: Rgb::WHITE,
            transmittance: Rgb::WHITE,
        }),
    ];
    let emission = prop_oneof![2 => Just(0.0), 1 => magnitude(-15.0..15.0)];
    (specular, 0.0f32..0.5, emission).prop_map(|(specular, diffuse, emission)| Material {
        name: "random".to_owned(),
        diffuse: Rgb::gray(diffuse),
        diffuse_map: None,
        specular,
        emission: Rgb::gray(emission),
    })
}

fn scene() -> impl Strategy<Value = SceneDescription> {
    let point_light = (point(), magnitude(-15.0..15.0))
        .prop_map(|(position, power)| LightDescription::Point { position, power: Rgb::gray(power) });
    (vec((triangle(), material()), 1..24), vec(point_light, 0..3), point(), point()).prop_map(
        |(parts, lights, eye, center)| {
            let mesh = |((corners, _), index): (&([Vec3; 3], Material), u32)| Mesh {
                positions: corners.to_vec(),
                triangles: vec![MeshTriangle {
                    positions: [0, 1, 2],
                    normals: None,
                    uvs: None,
                    material: index,
                }],
                ..Mesh::default()
            };
            SceneDescription {
                camera: CameraDescription { eye, center: center + 2.0 * Vec3::X, up: Vec3::Y, fov: 60.0 },
                meshes: parts.iter().zip(0..).map(mesh).collect(),
                materials: parts.into_iter().map(|(_, material)| material).collect(),
                textures: Vec::new(),
                lights,
                defaults: Defaults::default(),
                environment: None,
            }
        },
    )
}

/// The same scene, scaled by a power of two.
fn scaled(scene: &SceneDescription, scale: f32) -> SceneDescription {
    let mut scaled = scene.clone();
    scaled.camera.eye *= scale;
    scaled.camera.center *= scale;
    scaled.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions).for_each(|position| *position *= scale);
    for light in &mut scaled.lights {
        if let LightDescription::Point { position, power } = light {
            *position *= scale;
            *power *= scale * scale;
        }
    }
    scaled
}

/// Samples of a small image.
fn samples(description: &SceneDescription, technique: Technique) -> Vec<Rgb> {
    let scene = Scene::new(description);
    let tracer = PathTracer::new(Settings { technique, max_bounces: 6 });
    let camera = scene.camera(8, 8);
    let sample = |number: u64| {
        let pixel = (number as u32 % 8, number as u32 / 8 % 8);
        sample_pixel(&tracer as &dyn Integrator, &scene, &camera, Streams::independent(1), pixel, number / 64)
    };
    (0..256).map(sample).collect()
}

proptest! {
    #![proptest_config(Config {
        cases: 1500,
        rng_seed: RngSeed::Fixed(5),
        rng_algorithm: RngAlgorithm::ChaCha,
        failure_persistence: None,
        max_shrink_iters: 500,
        ..Config::default()
    })]

    #[test]
    fn radiance_is_a_number_that_is_not_negative_and_knows_no_size(scene in scene(), power in -12..12i32) {
        for technique in Technique::ALL {
            let here = samples(&scene, technique);
            for (number, value) in here.iter().enumerate() {
                prop_assert!(value.is_finite() && value.min_channel() >= 0.0, "{technique}, {number}: {value:?}");
            }
            let there = samples(&scaled(&scene, (power as f32).exp2()), technique);
            for (number, (here, there)) in here.iter().zip(&there).enumerate() {
                prop_assert_eq!(here, there, "{}, {}, 2^{}", technique, number, power);
            }
        }
    }
}
