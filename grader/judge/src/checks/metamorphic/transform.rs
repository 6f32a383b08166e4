//! Transformations of scenes with a known effect on the image.

use arty::math::{Rgb, Vec3};
use arty::scene::{LightDescription, Material, Mesh, MeshTriangle, SceneDescription, Specular};
use glam::Quat;

/// A similarity transform: rotation, then scaling, then translation.
#[derive(Clone, Copy, Debug)]
pub(in crate::checks) struct Transform {
    pub(in crate::checks) rotation: Quat,
    pub(in crate::checks) scale: f32,
    pub(in crate::checks) offset: Vec3,
}

impl Transform {
    const NONE: Self = Self { rotation: Quat::IDENTITY, scale: 1.0, offset: Vec3::ZERO };

    /// Scaling about the origin.
    pub(super) fn scale(scale: f32) -> Self {
        Self { scale, ..Self::NONE }
    }

    /// A rotation about a generic axis by a generic angle.
    pub(super) fn turn() -> Self {
        Self { rotation: Quat::from_axis_angle(Vec3::new(0.48, -0.6, 0.64), 2.3), ..Self::NONE }
    }

    /// A translation by several scene sizes.
    pub(super) fn shift() -> Self {
        Self { offset: Vec3::new(17.0, -29.0, 41.0), ..Self::NONE }
    }

    /// Transforms a scene. The power of point lights is scaled by the square of lengths, so that irradiances are
    /// unchanged.
    pub(in crate::checks) fn apply(&self, scene: &SceneDescription) -> SceneDescription {
        let point = |p: Vec3| self.rotation * p * self.scale + self.offset;
        let vector = |v: Vec3| self.rotation * v;
        let power = |power: Rgb| power * (self.scale * self.scale);
        let mut moved = scene.clone();
        moved.camera.eye = point(scene.camera.eye);
        moved.camera.center = point(scene.camera.center);
        moved.camera.up = vector(scene.camera.up);
        for mesh in &mut moved.meshes {
            mesh.positions.iter_mut().for_each(|position| *position = point(*position));
            mesh.normals.iter_mut().for_each(|normal| *normal = vector(*normal).normalize());
        }
        for light in &mut moved.lights {
            *light = match *light {
                LightDescription::Point { position, power: watts } => {
                    LightDescription::Point { position: point(position), power: power(watts) }
                }
                LightDescription::Spot { position, direction, inner, outer, power: watts } => {
                    LightDescription::Spot {
                        position: point(position),
                        direction: vector(direction),
                        inner,
                        outer,
                        power: power(watts),
                    }
                }
                LightDescription::Triangle { vertices, radiance } => {
                    LightDescription::Triangle { vertices: vertices.map(point), radiance }
                }
            };
        }
        if let Some(environment) = &mut moved.environment {
            environment.rotation = (self.rotation * environment.rotation).normalize();
        }
        moved
    }
}

/// Scales the emission of all lights.
pub(super) fn brightened(scene: &SceneDescription, factor: f32) -> SceneDescription {
    let mut brighter = scene.clone();
    brighter.materials.iter_mut().for_each(|material| material.emission *= factor);
    brighter.lights.iter_mut().for_each(|light| *emitted(light) *= factor);
    let texels = brighter.environment.iter_mut().flat_map(|environment| &mut environment.texels);
    texels.for_each(|texel| *texel *= factor);
    brighter
}

fn emitted(light: &mut LightDescription) -> &mut Rgb {
    match light {
        LightDescription::Point { power, .. } | LightDescription::Spot { power, .. } => power,
        LightDescription::Triangle { radiance, .. } => radiance,
    }
}

/// Splits each flat triangle that does not emit into four.
pub(super) fn tessellated(scene: &SceneDescription) -> SceneDescription {
    split_triangles(scene, |emits, triangle| !emits && triangle.normals.is_none(), quarters)
}

/// Splits each light into two: a point light into two of half the power, a triangle into its two halves.
pub(super) fn lights_split(scene: &SceneDescription) -> SceneDescription {
    let mut split = split_triangles(scene, |emits, _| emits, halves);
    split.lights = scene.lights.iter().flat_map(|light| split_light(*light)).collect();
    split
}

fn split_light(light: LightDescription) -> [LightDescription; 2] {
    match light {
        LightDescription::Point { .. } | LightDescription::Spot { .. } => {
            let mut half = light;
            *emitted(&mut half) *= 0.5;
            [half, half]
        }
        LightDescription::Triangle { vertices: [a, b, c], radiance } => {
            let middle = 0.5 * (a + b);
            [[a, middle, c], [middle, b, c]].map(|vertices| LightDescription::Triangle { vertices, radiance })
        }
    }
}

type Pieces = Vec<[[f32; 3]; 3]>;

/// Splits a triangle at the midpoints of its sides into four. Corners are barycentric coordinates.
fn quarters() -> Pieces {
    let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let [ab, bc, ca] = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
    vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

fn halves() -> Pieces {
    let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let ab = [0.5, 0.5, 0.0];
    vec![[a, ab, c], [ab, b, c]]
}

/// Replaces the triangles for which `wanted` is true by pieces. The pieces share no vertices.
fn split_triangles(
    scene: &SceneDescription,
    wanted: impl Fn(bool, &MeshTriangle) -> bool,
    pieces: fn() -> Pieces,
) -> SceneDescription {
    let mut split = scene.clone();
    for (mesh, original) in split.meshes.iter_mut().zip(&scene.meshes) {
        mesh.triangles.clear();
        for triangle in &original.triangles {
            let emits = !scene.materials[triangle.material as usize].emission.is_black();
            // Interpolated normals of the pieces would differ from those of the triangle.
            if !wanted(emits, triangle) || triangle.normals.is_some() {
                mesh.triangles.push(*triangle);
                continue;
            }
            for piece in pieces() {
                let corner = |weights: [f32; 3], mesh: &mut Mesh| {
                    let mix = |values: &[Vec3; 3]| (0..3).map(|i| weights[i] * values[i]).sum::<Vec3>();
                    mesh.positions.push(mix(&triangle.positions.map(|i| original.positions[i as usize])));
                    if let Some(uvs) = triangle.uvs {
                        let uvs = uvs.map(|i| original.uvs[i as usize]);
                        mesh.uvs.push((0..3).map(|i| weights[i] * uvs[i]).sum());
                    }
                };
                piece.into_iter().for_each(|weights| corner(weights, mesh));
                let last_three = |length: usize| [3, 2, 1].map(|back| length as u32 - back);
                mesh.triangles.push(MeshTriangle {
                    positions: last_three(mesh.positions.len()),
                    uvs: triangle.uvs.map(|_| last_three(mesh.uvs.len())),
                    ..*triangle
                });
            }
        }
    }
    split
}

/// Adds black triangles on all sides, outside of the bounding box, so that they occlude nothing.
pub(super) fn with_black_objects(scene: &SceneDescription) -> SceneDescription {
    let mut larger = scene.clone();
    let points = scene.meshes.iter().flat_map(|mesh| &mesh.positions).copied();
    let lights = scene.lights.iter().flat_map(|light| match *light {
        LightDescription::Point { position, .. } | LightDescription::Spot { position, .. } => vec![position],
        LightDescription::Triangle { vertices, .. } => vertices.to_vec(),
    });
    let all = points.chain(lights).chain([scene.camera.eye]);
    let (low, high) =
        all.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let (center, size) = (0.5 * (low + high), (high - low).max_element());
    let material = larger.materials.len() as u32;
    larger.materials.push(Material {
        name: "beside".to_owned(),
        diffuse: Rgb::BLACK,
        diffuse_map: None,
        specular: Specular::None,
        emission: Rgb::BLACK,
    });
    let mut mesh = Mesh::default();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for sign in [-1.5, 1.5] {
            let (right, up) = (axis.any_orthonormal_vector(), axis.cross(axis.any_orthonormal_vector()));
            let first = mesh.positions.len() as u32;
            for (x, y) in [(-1.0, -0.7), (0.9, -0.5), (0.1, 0.8)] {
                mesh.positions.push(center + size * (sign * axis + x * right + y * up));
            }
            let positions = [first, first + 1, first + 2];
            mesh.triangles.push(MeshTriangle { positions, normals: None, uvs: None, material });
        }
    }
    larger.meshes.push(mesh);
    larger
}

/// Divides the lights between two scenes, whose images sum to that of the original; `None` with fewer than two lights.
///
/// The surface of a removed light stays in the scene: only its emission is removed.
pub(super) fn lights_apart(scene: &SceneDescription) -> Option<[SceneDescription; 2]> {
    let emits = |material: &Material| !material.emission.is_black();
    let lights = scene.lights.len() + scene.materials.iter().filter(|material| emits(material)).count();
    (lights >= 2).then(|| {
        [0, 1].map(|part| {
            let mut some = scene.clone();
            let materials = some.materials.iter_mut().filter(|material| emits(material));
            let emissions = materials.map(|material| &mut material.emission);
            // The environment is one of the lights, too.
            let sky = some.environment.iter_mut().filter(|_| part == 0).flat_map(|it| &mut it.texels);
            sky.for_each(|texel| *texel = Rgb::BLACK);
            let all = some.lights.iter_mut().map(emitted).chain(emissions);
            all.enumerate().filter(|(index, _)| index % 2 == part).for_each(|(_, light)| *light = Rgb::BLACK);
            some
        })
    })
}
