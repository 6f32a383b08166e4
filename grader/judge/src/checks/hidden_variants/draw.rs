//! Random generation of scenes.
//!
//! A scene is a room, closed or open at the front, with some blocks and lights, transformed by a random similarity.
//! Lights keep a distance from walls and blocks, specular lobes are wide and lights are not small, so that every
//! technique has a low variance.

use arty::math::{Rgb, Vec3};
use arty::sampler::Sampler;
use arty::scene::{
    CameraDescription, Defaults, LightDescription, Material, Mesh, MeshTriangle, SceneDescription, Specular,
};
use glam::Quat;

use super::super::metamorphic::Transform;

/// Half of the width and depth of the room, and its height.
const HALF: f32 = 2.0;
const HEIGHT: f32 = 3.0;

/// Generates a scene.
pub(super) fn scene(random: &mut Sampler) -> SceneDescription {
    let mut draw = Draw { random };
    let mut mesh = Mesh::default();
    let mut materials = Vec::new();
    let sides = if draw.chance(0.5) { 6 } else { 5 };
    let (low, high) = (Vec3::new(-HALF, 0.0, -HALF), Vec3::new(HALF, HEIGHT, HALF));
    add_box(&mut mesh, low, high, sides, |p| p, materials.len() as u32);
    materials.push(draw.diffuse("room"));
    for number in 0..draw.count(1, 3) {
        let half = Vec3::new(draw.between(0.25, 0.5), draw.between(0.2, 0.6), draw.between(0.25, 0.5));
        // Side by side: intersecting blocks would hide each other's surfaces.
        let foot = Vec3::new(-1.2 + 1.2 * number as f32, 0.0, draw.between(-1.0, 0.2));
        let turn = Quat::from_rotation_y(draw.between(0.0, 3.0));
        let center = foot + Vec3::Y * (half.y + 0.1);
        add_box(&mut mesh, -half, half, 6, |p| turn * p + center, materials.len() as u32);
        materials.push(draw.material());
    }
    let mut lights = vec![draw.triangle_light()];
    for _ in 0..draw.count(0, 4) {
        lights.push(if draw.chance(0.5) { draw.triangle_light() } else { draw.point_light() });
    }
    let scene = SceneDescription {
        camera: CameraDescription {
            eye: Vec3::new(draw.between(-1.0, 1.0), draw.between(1.0, 2.0), 0.9 * HALF),
            center: Vec3::new(draw.between(-0.4, 0.4), draw.between(0.6, 1.0), -0.5),
            up: Vec3::Y,
            fov: draw.between(50.0, 75.0),
        },
        meshes: vec![mesh],
        materials,
        textures: Vec::new(),
        lights,
        defaults: Defaults::default(),
        environment: None,
    };
    let axis = Vec3::new(draw.between(-1.0, 1.0), draw.between(-1.0, 1.0), draw.between(0.1, 1.0));
    Transform {
        rotation: Quat::from_axis_angle(axis.normalize(), draw.between(0.0, 3.0)),
        scale: draw.between(-2.0, 2.0).exp(),
        offset: Vec3::new(draw.between(-5.0, 5.0), draw.between(-5.0, 5.0), draw.between(-5.0, 5.0)),
    }
    .apply(&scene)
}

struct Draw<'a> {
    random: &'a mut Sampler,
}

impl Draw<'_> {
    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.random.next_1d()
    }

    fn chance(&mut self, probability: f32) -> bool {
        self.random.next_1d() < probability
    }

    fn count(&mut self, min: u32, max: u32) -> u32 {
        min + (self.random.next_1d() * (max - min + 1) as f32) as u32
    }

    fn color(&mut self, low: f32, high: f32) -> Rgb {
        Rgb::new(self.between(low, high), self.between(low, high), self.between(low, high))
    }

    fn diffuse(&mut self, name: &str) -> Material {
        Material {
            name: name.to_owned(),
            diffuse: self.color(0.2, 0.7),
            diffuse_map: None,
            specular: Specular::None,
            emission: Rgb::BLACK,
        }
    }

    fn material(&mut self) -> Material {
        let mut material = self.diffuse("block");
        let choice = self.random.next_1d();
        if choice < 0.5 {
            return material;
        }
        let reflectance = self.color(0.1, 0.3);
        if choice < 0.8 {
            material.specular = Specular::Phong { reflectance, exponent: self.between(4.0, 24.0) };
        } else {
            material.specular = Specular::Mirror { reflectance };
            if choice > 0.9 {
                material.diffuse = Rgb::BLACK;
            }
        }
        material
    }

    /// A random position at a distance from the walls and above the blocks.
    fn place(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.1, 1.1), self.between(2.0, 2.4), self.between(-1.1, 1.1))
    }

    fn triangle_light(&mut self) -> LightDescription {
        let center = self.place();
        let tilt =
            Quat::from_rotation_x(self.between(-0.6, 0.6)) * Quat::from_rotation_z(self.between(-0.6, 0.6));
        let (size, turn) = (self.between(0.3, 0.5), self.between(0.0, 2.0));
        let corner = |number: f32| {
            let angle = turn + std::f32::consts::TAU * number / 3.0;
            // Counter-clockwise seen from below.
            center + tilt * (size * Vec3::new(angle.cos(), 0.0, angle.sin()))
        };
        LightDescription::Triangle {
            vertices: [corner(0.0), corner(1.0), corner(2.0)],
            radiance: self.color(2.0, 12.0),
        }
    }

    fn point_light(&mut self) -> LightDescription {
        let (position, power) = (self.place(), self.color(20.0, 80.0));
        if self.chance(0.7) {
            return LightDescription::Point { position, power };
        }
        let direction = Vec3::new(self.between(-0.4, 0.4), -1.0, self.between(-0.4, 0.4));
        let inner = self.between(20.0, 40.0);
        LightDescription::Spot { position, direction, inner, outer: inner + 20.0, power: power * 0.3 }
    }
}

/// Adds the first `sides` sides of a box. The sixth side is the one at +z.
fn add_box(
    mesh: &mut Mesh,
    low: Vec3,
    high: Vec3,
    sides: usize,
    place: impl Fn(Vec3) -> Vec3,
    material: u32,
) {
    let first = mesh.positions.len() as u32;
    for index in 0..8 {
        let side = |bit: u32, low: f32, high: f32| if index >> bit & 1 == 0 { low } else { high };
        let corner = Vec3::new(side(0, low.x, high.x), side(1, low.y, high.y), side(2, low.z, high.z));
        mesh.positions.push(place(corner));
    }
    let corners = [[0, 1, 3, 2], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5], [4, 5, 7, 6]];
    for [a, b, c, d] in corners.into_iter().take(sides) {
        for positions in [[a, b, c], [a, c, d]] {
            let positions = positions.map(|corner: u32| first + corner);
            mesh.triangles.push(MeshTriangle { positions, normals: None, uvs: None, material });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arty::scene::Scene;

    #[test]
    fn generated_scenes_differ_are_lit_and_fill_the_picture() {
        let mut closed = 0;
        for seed in 0..40 {
            let description = scene(&mut Sampler::new(seed, (0, 0), 0));
            assert_eq!(description.hash(), scene(&mut Sampler::new(seed, (0, 0), 0)).hash());
            assert_ne!(description.hash(), scene(&mut Sampler::new(seed + 1, (0, 0), 0)).hash());
            let scene = Scene::new(&description);
            assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
            assert!(scene.features().area_lights > 0 && scene.features().lit_surfaces > 0);
            closed += usize::from(scene.features().closed);
            let camera = scene.camera(16, 16);
            let (mut hits, mut lit) = (0, 0);
            for pixel in 0..256 {
                let Some(hit) = scene.intersect(&camera.ray(pixel % 16, pixel / 16, (0.5, 0.5))) else {
                    continue;
                };
                hits += 1;
                let mut random = Sampler::new(1, (pixel, 0), 0);
                lit += usize::from(scene.lights().iter().any(|light| {
                    let sample = light.sample_direct(hit.point, &mut random);
                    sample.is_some_and(|sample| !scene.occluded(&hit, sample.point))
                }));
            }
            assert!(hits == 256 && lit > 60, "seed {seed}: {hits} pixels hit, {lit} lit directly");
        }
        assert!((8..=32).contains(&closed), "{closed} of 40 are closed");
    }
}
