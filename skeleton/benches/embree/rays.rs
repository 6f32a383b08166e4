//! Three scenes, and the rays of a path tracer in each.

use std::f32::consts::TAU;
use std::path::Path;

use arty::accel::{Accel, offset_origin, point_on};
use arty::camera::Camera;
use arty::math::{Frame, Vec3, warp};
use arty::sampler::Sampler;
use arty::scene::{CameraDescription, file};

/// Number of rays of each kind.
const RAYS: usize = 1 << 16;

/// Maximum number of bounces.
const MAX_BOUNCES: usize = 8;

/// Width and height of the image for camera rays.
const SIZE: (u32, u32) = (512, 512);

/// Rings of the sphere, of twice as many quads each: a million triangles.
const RINGS: u32 = 500;

/// Triangles and a camera.
pub(super) struct Geometry {
    pub(super) name: &'static str,
    pub(super) triangles: Vec<[Vec3; 3]>,
    camera: CameraDescription,
    /// Target of the shadow rays.
    light: [Vec3; 3],
}

/// A ray.
pub(super) struct Start {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// The triangle it starts on.
    pub(super) exclude: Option<u32>,
}

/// A shadow ray.
pub(super) struct Segment {
    pub(super) origin: Vec3,
    pub(super) target: Vec3,
    /// The triangle it starts on.
    pub(super) exclude: u32,
}

/// The Cornell box, the knot of 70,000 triangles, and a bumpy sphere of a million in a room.
pub(super) fn geometries() -> Vec<Geometry> {
    vec![from_collection("cornell_box"), from_collection("mesh"), sphere()]
}

fn from_collection(name: &'static str) -> Geometry {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let scene = file::load(&scenes.join(name).with_extension("yml"))
        .expect("the scene is in the collection")
        .description;
    let mut triangles = Vec::new();
    let mut lights = Vec::new();
    for mesh in &scene.meshes {
        for triangle in &mesh.triangles {
            let corners = triangle.positions.map(|index| mesh.positions[index as usize]);
            if !scene.materials[triangle.material as usize].emission.is_black() {
                lights.push(corners);
            }
            triangles.push(corners);
        }
    }
    Geometry { name, triangles, camera: scene.camera, light: lights[0] }
}

/// A wavy sphere in a cube of four times its radius, with a light below the ceiling.
fn sphere() -> Geometry {
    let point = |ring: u32, step: u32| {
        let (theta, phi) = (TAU / 2.0 * ring as f32 / RINGS as f32, TAU * step as f32 / (2 * RINGS) as f32);
        let radius = 1.0 + 0.02 * (40.0 * theta).sin() * (40.0 * phi).sin();
        radius * Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
    };
    let mut triangles = Vec::new();
    for ring in 0..RINGS {
        for step in 0..2 * RINGS {
            let [a, b] = [point(ring, step), point(ring, step + 1)];
            let [c, d] = [point(ring + 1, step), point(ring + 1, step + 1)];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    for axis in 0..3 {
        for side in [-2.0, 2.0] {
            let corner = |u: f32, v: f32| {
                let mut corner = [0.0; 3];
                (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, 2.0 * u, 2.0 * v);
                Vec3::from(corner)
            };
            let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let light = [Vec3::new(-0.3, 1.95, -0.3), Vec3::new(0.3, 1.95, -0.3), Vec3::new(0.0, 1.95, 0.3)];
    triangles.push(light);
    let camera =
        CameraDescription { eye: Vec3::new(0.0, 0.5, 1.9), center: Vec3::ZERO, up: Vec3::Y, fov: 60.0 };
    Geometry { name: "sphere", triangles, camera, light }
}

/// Camera rays, diffuse bounces of their paths, and shadow rays from all of their vertices to points on a light.
#[derive(Default)]
pub(super) struct Rays {
    pub(super) primary: Vec<Start>,
    pub(super) bounces: Vec<Start>,
    pub(super) shadow: Vec<Segment>,
}

impl Rays {
    /// The rays of as many paths as needed, traced with arty.
    pub(super) fn of(geometry: &Geometry, accel: &Accel) -> Self {
        let camera = Camera::new(&geometry.camera, SIZE.0, SIZE.1);
        let mut rays = Self::default();
        for path in 0.. {
            if rays.primary.len() >= RAYS && rays.bounces.len() >= RAYS && rays.shadow.len() >= RAYS {
                break;
            }
            // Random pixels are harder than neighbouring ones, as in an image.
            let mut sampler = Sampler::new(1, (0, 0), path);
            let (u, v) = sampler.next_2d();
            let pixel = ((u * SIZE.0 as f32) as u32, (v * SIZE.1 as f32) as u32);
            let ray = camera.ray(pixel.0, pixel.1, sampler.next_2d());
            let mut ray = Start { origin: ray.origin, direction: ray.direction, exclude: None };
            for bounce in 0..MAX_BOUNCES {
                let Some(hit) = accel.intersect(ray.origin, ray.direction, f32::INFINITY, ray.exclude) else {
                    break;
                };
                let next = rays.scatter(geometry, &ray, hit.primitive, hit.barycentrics, &mut sampler);
                let kind = if bounce == 0 { &mut rays.primary } else { &mut rays.bounces };
                kind.push(std::mem::replace(&mut ray, next));
            }
        }
        rays.primary.truncate(RAYS);
        rays.bounces.truncate(RAYS);
        rays.shadow.truncate(RAYS);
        rays
    }

    /// Adds a shadow ray from a hit point and returns the ray of a diffuse bounce.
    fn scatter(
        &mut self,
        geometry: &Geometry,
        ray: &Start,
        primitive: u32,
        barycentrics: [f32; 2],
        sampler: &mut Sampler,
    ) -> Start {
        let triangle = &geometry.triangles[primitive as usize];
        let point = point_on(triangle, barycentrics);
        let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalize();
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        let target = point_on(&geometry.light, warp::triangle(sampler.next_2d()));
        if normal.dot(target - point) > 0.0 {
            self.shadow.push(Segment {
                origin: offset_origin(point, normal, target - point),
                target,
                exclude: primitive,
            });
        }
        let direction = Frame::around(normal).to_world(warp::cosine_hemisphere(sampler.next_2d()));
        Start { origin: offset_origin(point, normal, direction), direction, exclude: Some(primitive) }
    }
}
