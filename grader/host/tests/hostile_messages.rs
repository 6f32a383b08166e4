//! Damaged messages: each is read or refused without a panic, and no length reserves more memory than there are bytes.

use std::borrow::Cow;

use arty::integrator::{Settings, Technique};
use arty::math::Vec3;
use arty::scene::{CameraDescription, Defaults, Mesh, MeshTriangle, SceneDescription};
use host::protocol::{
    AnomalousSample, Call, ProbedPath, RenderJob, Rendered, Replayed, Request, Response, Switches,
    read_message, write_message,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, RngSeed};

/// Maximum length of a message in these tests, in bytes.
const LIMIT: u32 = 1 << 16;

fn responses() -> Vec<Vec<u8>> {
    let rendered = Rendered {
        batches: vec![vec![[1.0, f32::NAN, 2.0]; 4]; 3],
        non_finite: 1,
        negative: 0,
        first_anomalies: vec![AnomalousSample { seed: 1, x: 2, y: 3, sample: 4, value: [f32::INFINITY; 3] }],
        rays: 7,
        cpu_seconds: 0.5,
    };
    let path = ProbedPath { radiance: [0.0; 3], rays: 1, shadow_rays: 2, light_samples: 3 };
    let value = || ("wi".to_owned(), vec![0.0, 1.0, f32::NAN]);
    let call = Call { function: "Bsdf::eval".to_owned(), given: vec![value()], got: vec![value(), value()] };
    let replayed = Replayed { radiance: [f32::NAN; 3], calls: vec![call; 3], left_out: 0 };
    [
        Response::SceneReady,
        Response::Rendered(rendered),
        Response::Probed(vec![vec![path; 3]; 2]),
        Response::Replayed(replayed),
        Response::Panicked { message: "index out of bounds".to_owned() },
    ]
    .iter()
    .map(bytes_of)
    .collect()
}

fn requests() -> Vec<Vec<u8>> {
    let triangle = MeshTriangle { positions: [0, 1, 2], normals: None, uvs: None, material: 0 };
    let scene = SceneDescription {
        camera: CameraDescription { eye: Vec3::ZERO, center: Vec3::X, up: Vec3::Z, fov: 40.0 },
        meshes: vec![Mesh { positions: vec![Vec3::ONE; 3], triangles: vec![triangle], ..Mesh::default() }],
        materials: Vec::new(),
        textures: Vec::new(),
        lights: Vec::new(),
        defaults: Defaults::default(),
        environment: None,
    };
    let job = RenderJob {
        scene: 0,
        settings: Settings { technique: Technique::Mis, max_bounces: 8 },
        width: 16,
        height: 16,
        seeds: vec![1, 2, 3],
        first_sample: 0,
        samples: 4,
    };
    vec![
        bytes_of(&Request::Scene(Cow::Owned(scene), Switches::default())),
        bytes_of(&Request::Render(Cow::Owned(job))),
    ]
}

fn bytes_of(message: &impl serde::Serialize) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_message(&mut bytes, message).expect("a vector takes everything");
    bytes
}

fn config() -> Config {
    Config {
        cases: 5000,
        rng_seed: RngSeed::Fixed(5),
        rng_algorithm: RngAlgorithm::ChaCha,
        failure_persistence: None,
        ..Config::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_damaged_message_is_read_or_refused(
        message in any::<Index>(),
        bytes in vec((any::<Index>(), any::<u8>()), 1..6),
        end in prop::option::of(any::<Index>()),
    ) {
        let mut all = responses();
        all.extend(requests());
        let mut damaged = all[message.index(all.len())].clone();
        for (at, byte) in bytes {
            let at = at.index(damaged.len());
            damaged[at] = byte;
        }
        if let Some(end) = end {
            damaged.truncate(end.index(damaged.len()));
        }
        // The message may be valid or not; only the end of the stream follows it.
        let mut reader = damaged.as_slice();
        while let Ok(Some(response)) = read_message::<Response>(&mut reader, LIMIT) {
            if let Response::Rendered(rendered) = response {
                prop_assert!(rendered.batches.len() <= damaged.len());
            }
        }
        let mut reader = damaged.as_slice();
        while let Ok(Some(_)) = read_message::<Request<'_>>(&mut reader, LIMIT) {}
    }
}

#[test]
fn undamaged_messages_are_read() {
    for bytes in responses() {
        assert!(matches!(read_message::<Response>(&mut bytes.as_slice(), LIMIT), Ok(Some(_))));
    }
    for bytes in requests() {
        assert!(matches!(read_message::<Request<'_>>(&mut bytes.as_slice(), LIMIT), Ok(Some(_))));
    }
}
