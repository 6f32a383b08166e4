//! Building scenes in memory.

use arty::math::{Rgb, Vec3};
use arty::scene::{
    CameraDescription, Defaults, LightDescription, Material, Mesh, MeshTriangle, SceneDescription, Specular,
};
use glam::DVec3;

/// An empty scene with a camera that looks at the origin.
pub fn empty() -> SceneDescription {
    SceneDescription {
        camera: camera(DVec3::new(0.3, 0.4, 0.5), DVec3::ZERO, 0.01),
        meshes: Vec::new(),
        materials: Vec::new(),
        textures: Vec::new(),
        lights: Vec::new(),
        defaults: Defaults::default(),
        environment: None,
    }
}

/// A camera whose up vector is y.
pub fn camera(eye: DVec3, center: DVec3, fov: f32) -> CameraDescription {
    CameraDescription { eye: eye.as_vec3(), center: center.as_vec3(), up: Vec3::Y, fov }
}

/// A grey diffuse material with this albedo and emitted radiance.
pub fn grey(reflectance: f32, radiance: f32) -> Material {
    Material {
        name: "grey".to_owned(),
        diffuse: Rgb::gray(reflectance),
        diffuse_map: None,
        specular: Specular::None,
        emission: Rgb::gray(radiance),
    }
}

/// Adds a mesh of triangles with one material.
pub fn add(scene: &mut SceneDescription, corners: &[[DVec3; 3]], material: Material) {
    let index = scene.materials.len() as u32;
    scene.materials.push(material);
    let triangles = (0..corners.len() as u32).map(|triangle| MeshTriangle {
        positions: [3 * triangle, 3 * triangle + 1, 3 * triangle + 2],
        normals: None,
        uvs: None,
        material: index,
    });
    scene.meshes.push(Mesh {
        positions: corners.as_flattened().iter().map(|corner| corner.as_vec3()).collect(),
        triangles: triangles.collect(),
        ..Mesh::default()
    });
}

/// A rectangle given by a corner and two sides. Its front faces `right × up`.
pub fn rectangle(corner: DVec3, right: DVec3, up: DVec3) -> Vec<[DVec3; 3]> {
    vec![[corner, corner + right, corner + right + up], [corner, corner + right + up, corner + up]]
}

/// A square at height y, centered on the y axis, facing up.
pub fn floor(y: f64, side: f64) -> Vec<[DVec3; 3]> {
    rectangle(DVec3::new(-0.5 * side, y, 0.5 * side), side * DVec3::X, -side * DVec3::Z)
}

/// A square at height y, centered on the y axis, facing down.
pub fn ceiling(y: f64, side: f64) -> Vec<[DVec3; 3]> {
    rectangle(DVec3::new(-0.5 * side, y, -0.5 * side), side * DVec3::X, side * DVec3::Z)
}

/// A sphere of 8·4ⁿ triangles around the origin, facing inwards.
pub fn hollow_ball(radius: f64, n: u32) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for x in [1.0, -1.0] {
        for y in [1.0, -1.0] {
            for z in [1.0, -1.0] {
                let (a, b, c) = (x * DVec3::X, y * DVec3::Y, z * DVec3::Z);
                triangles.push(if x * y * z > 0.0 { [a, c, b] } else { [a, b, c] });
            }
        }
    }
    for _ in 0..n {
        let split = |[a, b, c]: [DVec3; 3]| {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| (from + to).normalize());
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(split).collect();
    }
    triangles.into_iter().map(|triangle| triangle.map(|corner| radius * corner)).collect()
}

/// The scene scaled about the origin, then translated, with all emission scaled by `emission`.
///
/// Its picture is the original times `emission`: radiance does not depend on scale, and the power of lights without an
/// area is scaled by the square of lengths.
pub fn changed(scene: &SceneDescription, scale: f64, offset: DVec3, emission: f32) -> SceneDescription {
    let at = |point: Vec3| (scale * point.as_dvec3() + offset).as_vec3();
    let mut changed = scene.clone();
    changed.camera.eye = at(scene.camera.eye);
    changed.camera.center = at(scene.camera.center);
    changed
        .meshes
        .iter_mut()
        .flat_map(|mesh| &mut mesh.positions)
        .for_each(|position| *position = at(*position));
    changed.materials.iter_mut().for_each(|material| material.emission *= emission);
    let texels = changed.environment.iter_mut().flat_map(|environment| &mut environment.texels);
    texels.for_each(|texel| *texel *= emission);
    let power_factor = (scale * scale * f64::from(emission)) as f32;
    for light in &mut changed.lights {
        match light {
            LightDescription::Triangle { vertices, radiance } => {
                *vertices = vertices.map(at);
                *radiance *= emission;
            }
            LightDescription::Point { position, power } | LightDescription::Spot { position, power, .. } => {
                *position = at(*position);
                *power *= power_factor;
            }
        }
    }
    changed
}

/// A point light.
pub fn point_light(position: Vec3, power: Rgb) -> LightDescription {
    LightDescription::Point { position, power }
}

/// A cube of side 2 around the origin. The orientation of its sides varies.
pub fn cube() -> Vec<[DVec3; 3]> {
    let corner = |index: u32| {
        let side = |bit: u32| if index >> bit & 1 == 0 { -1.0 } else { 1.0 };
        DVec3::new(side(0), side(1), side(2))
    };
    let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    sides
        .iter()
        .flat_map(|&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]].map(|side| side.map(corner)))
        .collect()
}

/// A room of about four units with diffuse and glossy surfaces, a shelf near a wall, a sheet just above the floor, an
/// area light and a point light.
pub fn room() -> SceneDescription {
    let mut scene = empty();
    scene.camera = camera(DVec3::new(0.3, 1.2, 3.2), DVec3::new(0.0, 0.6, 0.0), 45.0);
    let wall = rectangle(DVec3::new(-1.5, 0.0, -1.5), 3.0 * DVec3::X, 2.0 * DVec3::Y);
    add(&mut scene, &floor(0.0, 3.0), grey(0.6, 0.0));
    add(&mut scene, &wall, grey(0.5, 0.0));
    let lobe = Specular::Phong { reflectance: Rgb::gray(0.4), exponent: 20.0 };
    let plate = rectangle(DVec3::new(0.2, 0.05, 0.9), 0.8 * DVec3::X, DVec3::new(0.0, 0.4, -0.6));
    add(&mut scene, &plate, Material { specular: lobe, ..grey(0.3, 0.0) });
    // A shelf near the wall and a sheet just above the floor, which cast shadows at small distances.
    let shelf = rectangle(DVec3::new(-1.2, 0.8, -1.48), 0.8 * DVec3::X, 0.3 * DVec3::Z);
    add(&mut scene, &shelf, grey(0.4, 0.0));
    add(&mut scene, &rectangle(DVec3::new(-1.0, 0.03, 1.0), 0.9 * DVec3::X, -0.9 * DVec3::Z), grey(0.7, 0.0));
    let lamp = rectangle(DVec3::new(-0.5, 1.9, -0.4), 0.6 * DVec3::X, 0.6 * DVec3::Z);
    add(&mut scene, &lamp, grey(0.0, 8.0));
    let power = Rgb::gray(12.0);
    scene.lights.push(LightDescription::Point { position: Vec3::new(0.9, 1.4, 0.6), power });
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_face_the_documented_side() {
        let front = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize();
        assert!(floor(1.0, 2.0).into_iter().all(|triangle| front(triangle).distance(DVec3::Y) < 1e-12));
        assert!(ceiling(1.0, 2.0).into_iter().all(|triangle| front(triangle).distance(DVec3::NEG_Y) < 1e-12));
        let ball = hollow_ball(2.0, 2);
        assert_eq!(ball.len(), 128);
        assert!(ball.into_iter().all(|triangle| front(triangle).dot(triangle[0]) < 0.0));
    }
}
