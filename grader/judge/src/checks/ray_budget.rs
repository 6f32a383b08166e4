//! **ray-budget**: how many rays does a path take?
//!
//! The sheet asks for a single shadow ray at each hit point. How it is traced (`occluded`, or `intersect` and a look at
//! what is hit) is the student's choice, and so is a ray of its own for multiple importance sampling: at most three
//! rays for each bounce, and one from the camera. Points are lost only for more than that, and for paths that do not end.
//! Shadow rays that cannot bring anything are remarked upon.

use arty::integrator::Settings;
use arty::math::{Rgb, Vec3};
use arty::scene::{
    CameraDescription, Defaults, LightDescription, Material, Mesh, MeshTriangle, SceneDescription, Specular,
};
use host::protocol::{ProbeJob, ProbedPath, ScriptedScene};

use super::{Bench, Stop};
use verdict::report::{CheckResult, Reason, Verdict};
use verdict::rubric::CheckSpec;

/// Lights in the room: more than any path may ask.
const LIGHTS: u32 = 8;

/// Paths in each room.
const PATHS: u64 = 256;

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let mut process = bench.start()?;
    let seed = bench.seed_of(spec);
    let mut probe = |scene: SceneDescription, max_bounces: u32| -> Result<Vec<ProbedPath>, Stop> {
        let bsdfs = vec![None; scene.materials.len()];
        let scripted = ScriptedScene {
            scene,
            bsdfs,
            lights: Vec::new(),
            origin: Vec3::new(0.1, 0.2, 0.9),
            direction: Vec3::new(0.2, -0.1, -1.0).normalize(),
        };
        let settings = Settings { technique: spec.technique, max_bounces };
        let job = ProbeJob { settings, scenes: vec![scripted], samples: PATHS, seed, stratified: false };
        result.samples += PATHS;
        Ok(process.probe(&job)??.into_iter().flatten().collect())
    };

    let mut complaint = None;
    for bounces in 1..=spec.max_bounces {
        let paths = probe(room(Specular::None, LIGHTS), bounces)?;
        complaint = complaint.or_else(|| complain(&paths, bounces));
    }
    let mirrors = probe(room(Specular::Mirror { reflectance: Rgb::gray(0.9) }, LIGHTS), spec.max_bounces)?;
    let dark = probe(room(Specular::None, 0), spec.max_bounces)?;
    let asked = |paths: &[ProbedPath]| paths.iter().map(|path| path.shadow_rays).max().unwrap_or(0);
    if asked(&mirrors) > 0 {
        result.remarks.push(
            "shadow rays are traced from perfect mirrors, which cannot show a light that was asked for"
                .to_owned(),
        );
    }
    if asked(&dark) > 0 {
        result.remarks.push("shadow rays are traced in a scene without lights".to_owned());
    }
    (result.verdict, result.reason, result.explanation) = match complaint {
        Some(complaint) => (Verdict::Fail, Reason::RayBudget, complaint),
        None => (Verdict::Pass, Reason::None, "at most one shadow ray at each hit point".to_owned()),
    };
    Ok(())
}

/// What is too much, if anything is.
fn complain(paths: &[ProbedPath], bounces: u32) -> Option<String> {
    let most = |count: fn(&ProbedPath) -> u32| paths.iter().map(count).max().unwrap_or(0);
    let (shadow_rays, all) = (most(|path| path.shadow_rays), most(|path| path.rays + path.shadow_rays));
    let hit_points =
        if bounces == 1 { "at one hit point".to_owned() } else { format!("at {bounces} hit points") };
    if shadow_rays > bounces {
        return Some(format!(
            "{shadow_rays} shadow rays {hit_points}, in a room with {LIGHTS} lights; the sheet asks for a single one \
             at each"
        ));
    }
    let enough = 1 + 3 * bounces;
    (all > enough).then(|| {
        format!(
            "{all} rays for a path that may scatter {bounces} times, in a room with {LIGHTS} lights; {enough} are \
             enough even if shadow rays and those of multiple importance sampling are rays of their own"
        )
    })
}

/// A closed room with walls of one material and point lights under its ceiling.
fn room(specular: Specular, lights: u32) -> SceneDescription {
    let corner = |index: u32| {
        let side = |bit: u32| if index >> bit & 1 == 0 { -1.0 } else { 1.0 };
        Vec3::new(side(0), side(1), side(2))
    };
    // Two triangles a side; which way they face makes no difference to what is tested here.
    let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let triangle = |positions: [u32; 3]| MeshTriangle { positions, normals: None, uvs: None, material: 0 };
    let triangles = sides
        .iter()
        .flat_map(|&[a, b, c, d]: &[u32; 4]| [triangle([a, b, c]), triangle([a, c, d])])
        .collect();
    let diffuse = if specular == Specular::None { Rgb::gray(0.9) } else { Rgb::BLACK };
    let light = |index: u32| {
        let angle = std::f32::consts::TAU * index as f32 / LIGHTS as f32;
        let position = Vec3::new(0.5 * angle.cos(), 0.8, 0.5 * angle.sin());
        LightDescription::Point { position, power: Rgb::WHITE }
    };
    SceneDescription {
        camera: CameraDescription { eye: Vec3::ZERO, center: Vec3::NEG_Z, up: Vec3::Y, fov: 60.0 },
        meshes: vec![Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() }],
        materials: vec![Material {
            name: "walls".to_owned(),
            diffuse,
            diffuse_map: None,
            specular,
            emission: Rgb::BLACK,
        }],
        textures: Vec::new(),
        lights: (0..lights).map(light).collect(),
        defaults: Defaults::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(rays: u32, shadow_rays: u32) -> Vec<ProbedPath> {
        vec![ProbedPath { radiance: [0.0; 3], rays, shadow_rays, light_samples: 1 }; 2]
    }

    #[test]
    fn one_shadow_ray_however_it_is_traced_is_enough() {
        for (rays, shadow_rays, bounces) in [(2, 1, 1), (3, 0, 1), (4, 0, 1), (3, 1, 1), (4, 3, 3), (1, 0, 1)]
        {
            assert_eq!(complain(&paths(rays, shadow_rays), bounces), None, "{rays} + {shadow_rays}");
        }
        for (rays, shadow_rays, bounces) in [(2, 8, 1), (10, 0, 1), (5, 0, 1), (4, 24, 3), (40, 1, 1)] {
            assert!(complain(&paths(rays, shadow_rays), bounces).is_some(), "{rays} + {shadow_rays}");
        }
    }

    #[test]
    fn the_room_is_closed() {
        assert!(arty::scene::Scene::new(&room(Specular::None, 2)).features().closed);
    }
}
