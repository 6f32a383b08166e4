//! Procedural scenes.

use std::collections::HashMap;

use arty::bsdf::Bsdf;
use arty::math::{Rgb, Vec3};
use arty::ray::Ray;
use arty::scene::{
    CameraDescription, Defaults, LightDescription, Material, Mesh, MeshTriangle, Scene, SceneDescription,
    Specular,
};

/// An empty scene with a camera at the origin that looks along −z.
pub(crate) fn empty() -> SceneDescription {
    SceneDescription {
        camera: CameraDescription { eye: Vec3::ZERO, center: Vec3::NEG_Z, up: Vec3::Y, fov: 60.0 },
        meshes: Vec::new(),
        materials: Vec::new(),
        textures: Vec::new(),
        lights: Vec::new(),
        defaults: Defaults::default(),
        environment: None,
    }
}

/// A black material.
pub(crate) fn black() -> Material {
    Material {
        name: "black".into(),
        diffuse: Rgb::BLACK,
        diffuse_map: None,
        specular: Specular::None,
        emission: Rgb::BLACK,
    }
}

/// A grey diffuse material.
pub(crate) fn diffuse(reflectance: f32) -> Material {
    Material { diffuse: Rgb::gray(reflectance), ..black() }
}

/// A Phong lobe only.
pub(crate) fn phong(reflectance: f32, exponent: f32) -> Material {
    Material { specular: Specular::Phong { reflectance: Rgb::gray(reflectance), exponent }, ..black() }
}

/// A mirror.
pub(crate) fn mirror(reflectance: f32) -> Material {
    Material { specular: Specular::Mirror { reflectance: Rgb::gray(reflectance) }, ..black() }
}

/// Clear glass.
pub(crate) fn glass(index: f32) -> Material {
    let specular = Specular::Glass { index, reflectance: Rgb::WHITE, transmittance: Rgb::WHITE };
    Material { specular, ..black() }
}

/// Adds triangles of one material to a scene.
pub(crate) fn add(scene: &mut SceneDescription, triangles: &[[Vec3; 3]], material: Material) {
    let index = scene.materials.len() as u32;
    scene.materials.push(material);
    scene.meshes.push(Mesh {
        positions: triangles.concat(),
        triangles: (0..triangles.len() as u32)
            .map(|i| MeshTriangle {
                positions: [3 * i, 3 * i + 1, 3 * i + 2],
                normals: None,
                uvs: None,
                material: index,
            })
            .collect(),
        ..Mesh::default()
    });
}

/// Adds triangle lights of radiance 1.
pub(crate) fn add_lights(scene: &mut SceneDescription, triangles: &[[Vec3; 3]]) {
    let light = |&vertices| LightDescription::Triangle { vertices, radiance: Rgb::WHITE };
    scene.lights.extend(triangles.iter().map(light));
}

/// A parallelogram; its front is the side from which corner, corner + a, corner + a + b are counter-clockwise.
pub(crate) fn quad(corner: Vec3, a: Vec3, b: Vec3) -> Vec<[Vec3; 3]> {
    vec![[corner, corner + a, corner + a + b], [corner, corner + a + b, corner + b]]
}

/// The box between two corners, its front inside.
pub(crate) fn room(low: Vec3, high: Vec3) -> Vec<[Vec3; 3]> {
    let size = high - low;
    let (x, y, z) = (size.x * Vec3::X, size.y * Vec3::Y, size.z * Vec3::Z);
    // Corners are sums of whole edges, so that faces share the bits of their corners.
    [
        quad(low, x, y),
        quad(low, y, z),
        quad(low, z, x),
        quad(high, -y, -x),
        quad(high, -z, -y),
        quad(high, -x, -z),
    ]
    .concat()
    .into_iter()
    .map(|triangle| triangle.map(|vertex| snap(vertex, low, high)))
    .collect()
}

/// The nearest corner of the box.
fn snap(vertex: Vec3, low: Vec3, high: Vec3) -> Vec3 {
    Vec3::select((vertex - low).abs().cmplt((vertex - high).abs()), low, high)
}

/// A sphere: an icosahedron, subdivided `levels` times, with vertices on the sphere.
pub(crate) fn icosphere(center: Vec3, radius: f32, levels: u32, front_outside: bool) -> Vec<[Vec3; 3]> {
    let g = 0.5 * (1.0 + 5f32.sqrt());
    let mut corners: Vec<Vec3> = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ]
    .map(|corner| Vec3::from(corner).normalize())
    .to_vec();
    let mut faces: Vec<[usize; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middles: HashMap<[usize; 2], usize> = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                corners.push((corners[a] + corners[b]).normalize());
                corners.len() - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let place = |[a, b, c]: [usize; 3]| {
        let order = if front_outside { [a, b, c] } else { [a, c, b] };
        order.map(|index| center + radius * corners[index])
    };
    faces.into_iter().map(place).collect()
}

/// The BSDF of a material at a point in the plane z = 0, viewed from `wo`.
#[derive(Clone, Copy)]
pub(crate) struct Surface {
    pub(crate) bsdf: Bsdf,
    pub(crate) normal: Vec3,
    pub(crate) geometric_normal: Vec3,
    pub(crate) wo: Vec3,
}

/// A large triangle of a material in the plane z = 0, facing up, with the given shading normal.
pub(crate) fn plate(material: Material, shading_normal: Option<Vec3>) -> Scene {
    let mut scene = empty();
    let corners = [Vec3::new(-9.0, -7.0, 0.0), Vec3::new(9.0, -7.0, 0.0), Vec3::new(0.0, 9.0, 0.0)];
    add(&mut scene, &[corners], material);
    if let Some(normal) = shading_normal {
        scene.meshes[0].normals = vec![normal];
        scene.meshes[0].triangles[0].normals = Some([0; 3]);
    }
    Scene::new(&scene)
}

/// The BSDF of a [`plate`], viewed from `wo`.
pub(crate) fn surface(plate: &Scene, wo: Vec3) -> Surface {
    let hit = plate.intersect(&Ray::new(wo, -wo)).expect("the plate is large");
    Surface { bsdf: hit.bsdf(), normal: hit.normal, geometric_normal: hit.geometric_normal, wo: hit.wo }
}

/// The unit direction at the angle `theta` (degrees) from +z and the azimuth `phi` (radians).
pub(crate) fn tilted(theta: f32, phi: f32) -> Vec3 {
    let (sin, cos) = f64::from(theta).to_radians().sin_cos();
    let (y, x) = f64::from(phi).sin_cos();
    Vec3::new((sin * x) as f32, (sin * y) as f32, cos as f32)
}
