//! Run-time cost of features: the Cornell box with and without each of them.
//!
//! `cargo bench -q -p solution --bench features > solution/benches/features.md` writes the committed table. Times are
//! relative to the plain box: interleaved within one run, medians over rounds, on one thread.

#[path = "../src/algorithms/render_pt.rs"]
#[allow(unreachable_pub)] // its items are used by the program it belongs to, not here
mod render_pt;

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use arty::film::Film;
use arty::math::{Rgb, Vec2, Vec3};
use arty::prelude::{Scene, Settings, Technique};
use arty::render::render;
use arty::sampler::Streams;
use arty::scene::{
    LightDescription, Material, Mesh, MeshTriangle, SceneDescription, Specular, Texture, file,
};
use rayon::ThreadPoolBuilder;
use render_pt::PathTracer;

const WIDTH: u32 = 128;
const HEIGHT: u32 = 103;
const SAMPLES: u64 = 4;
const MAX_BOUNCES: u32 = 8;
const ROUNDS: usize = 41;

/// Adds a feature to the material and to the meshes.
type Feature = fn(&mut SceneDescription, usize);

const FEATURES: [(&str, Feature); 5] = [
    ("texture", |scene, material| {
        scene.textures.push(Texture { width: 1, height: 1, texels: vec![[220; 3]] });
        scene.materials[material].diffuse_map = Some(scene.textures.len() as u32 - 1);
        for mesh in &mut scene.meshes {
            mesh.uvs = vec![Vec2::ZERO];
            each_of(mesh, material, |triangle, _| triangle.uvs = Some([0; 3]));
        }
    }),
    ("interpolated normals", |scene, material| {
        for mesh in &mut scene.meshes {
            let mut normals = Vec::new();
            each_of(mesh, material, |triangle, [a, b, c]| {
                normals.push((b - a).cross(c - a).normalize());
                triangle.normals = Some([normals.len() as u32 - 1; 3]);
            });
            mesh.normals = normals;
        }
    }),
    ("glossy", |scene, material| {
        scene.materials[material].specular = Specular::Phong { reflectance: Rgb::gray(0.2), exponent: 50.0 };
    }),
    ("mirror", |scene, material| {
        scene.materials[material].specular = Specular::Mirror { reflectance: Rgb::gray(0.2) };
    }),
    ("glass", |scene, material| {
        let half = Rgb::gray(0.5);
        scene.materials[material].specular =
            Specular::Glass { index: 1.5, reflectance: half, transmittance: half };
    }),
];

/// Modifies each triangle of a material, given its vertices.
fn each_of(mesh: &mut Mesh, material: usize, mut change: impl FnMut(&mut MeshTriangle, [Vec3; 3])) {
    let Mesh { positions, triangles, .. } = mesh;
    for triangle in triangles.iter_mut().filter(|triangle| triangle.material as usize == material) {
        change(triangle, triangle.positions.map(|index| positions[index as usize]));
    }
}

/// The box, with an additional material on a triangle behind the back wall that no path reaches.
fn plain() -> SceneDescription {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut scene = file::load(&scenes.join("cornell_box.yml")).expect("the scene is there").description;
    scene.materials.push(Material { name: "unseen".to_owned(), ..scene.materials[0].clone() });
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| 0.1 * corner - 5.0 * Vec3::Z);
    scene.meshes.push(Mesh {
        positions: corners.to_vec(),
        triangles: vec![MeshTriangle {
            positions: [0, 1, 2],
            normals: None,
            uvs: None,
            material: scene.materials.len() as u32 - 1,
        }],
        ..Mesh::default()
    });
    scene
}

/// The variants of the plain scene, with their names in the table.
fn variants() -> Vec<(String, SceneDescription)> {
    let plain = plain();
    let blocks = plain.materials.iter().position(|material| material.name == "blocks");
    let places = [("not met", plain.materials.len() - 1), ("on the blocks", blocks.expect("it has blocks"))];
    let mut variants = Vec::new();
    for (name, feature) in FEATURES {
        for (place, material) in places {
            let mut scene = plain.clone();
            feature(&mut scene, material);
            variants.push((format!("{name}, {place}"), scene));
        }
    }
    let light = LightDescription::Point { position: Vec3::new(0.0, 1.0, 0.0), power: Rgb::gray(1.0) };
    for count in [1, 1000] {
        let mut scene = plain.clone();
        scene.lights.extend(vec![light; count]);
        variants.push((format!("{count} more point lights"), scene));
    }
    for times in [4, 64] {
        let mut scene = plain.clone();
        for mesh in &mut scene.meshes {
            (0..u32::ilog2(times) / 2).for_each(|_| split(mesh));
        }
        variants.push((format!("{times} times the triangles, lights too"), scene));
    }
    variants
}

/// Divides each triangle into four.
fn split(mesh: &mut Mesh) {
    let mut triangles = Vec::new();
    for triangle in std::mem::take(&mut mesh.triangles) {
        let [a, b, c] = triangle.positions;
        let mut middle = |a: u32, b: u32| {
            mesh.positions.push(0.5 * (mesh.positions[a as usize] + mesh.positions[b as usize]));
            mesh.positions.len() as u32 - 1
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        triangles.extend(parts.map(|positions| MeshTriangle { positions, ..triangle }));
    }
    mesh.triangles = triangles;
}

fn seconds(scene: &Scene, technique: Technique) -> f64 {
    let mut film = Film::new(WIDTH, HEIGHT);
    let tracer = PathTracer::new(Settings { technique, max_bounces: MAX_BOUNCES });
    let start = Instant::now();
    render(&tracer, scene, &mut film, 0..SAMPLES, Streams::independent(1), &AtomicBool::new(false));
    start.elapsed().as_secs_f64()
}

fn main() {
    let pool = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    let plain = Scene::new(&plain());
    let variants: Vec<(String, Scene)> =
        variants().into_iter().map(|(name, scene)| (name, Scene::new(&scene))).collect();
    println!("# What features cost\n");
    println!(
        "Made by `cargo bench -q -p solution --bench features`; do not edit. Time of a sample in `cornell_box` with a"
    );
    println!(
        "feature, relative to the same without it, on one thread, in turns within one run. `not met`: the feature is in"
    );
    println!("the scene, where no path meets it. Features on the blocks change paths, too.\n");
    println!("| feature | {} |", Technique::ALL.map(Technique::name).join(" | "));
    println!("|---|{}", "---:|".repeat(Technique::ALL.len()));
    for (name, scene) in &variants {
        let ratio = |technique| {
            let mut ratios: Vec<f64> = pool.install(|| {
                (0..ROUNDS).map(|_| seconds(scene, technique) / seconds(&plain, technique)).collect()
            });
            ratios.sort_by(f64::total_cmp);
            format!("{:.2}", ratios[ROUNDS / 2])
        };
        println!("| {name} | {} |", Technique::ALL.map(ratio).join(" | "));
    }
}
