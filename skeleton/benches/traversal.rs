//! How many rays a second find their nearest hit, or find out whether they are blocked. One thread.
//!
//! `cargo bench -p arty --no-default-features --bench traversal`; with `ARTY_BENCH_LARGE` set, a sphere of a
//! million triangles too. Throughput is in elements, that is rays, a second.

use std::f32::consts::{PI, TAU};
use std::hint::black_box;

use arty::accel::{Accel, offset_origin, point_on};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;

type Triangle = [Vec3; 3];

const RAYS: usize = 1 << 14;

/// SplitMix64: good enough to strew rays with.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 40) as f32 / (1u64 << 24) as f32
    }

    pub(crate) fn direction(&mut self) -> Vec3 {
        let (z, angle) = (1.0 - 2.0 * self.next(), TAU * self.next());
        let radius = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    }
}

pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) triangles: Vec<Triangle>,
    eye: Vec3,
    center: Vec3,
    light: Triangle,
}

fn quad(triangles: &mut Vec<Triangle>, [a, b, c, d]: [Vec3; 4]) {
    triangles.extend([[a, b, c], [a, c, d]]);
}

/// A turned box that stands on y = 0.
fn block(triangles: &mut Vec<Triangle>, center: Vec3, half: Vec3, angle: f32) {
    let corner = |x: f32, y: f32, z: f32| {
        let (x, z) = (x * half.x, z * half.z);
        let turned =
            Vec3::new(x * angle.cos() - z * angle.sin(), y * half.y, x * angle.sin() + z * angle.cos());
        center + turned
    };
    let face = |axis: usize, sign: f32| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(u, v)| match axis {
            0 => corner(sign, u, v),
            1 => corner(u, sign, v),
            _ => corner(u, v, sign),
        })
    };
    for axis in 0..3 {
        quad(triangles, face(axis, -1.0));
        quad(triangles, face(axis, 1.0));
    }
}

/// A room of 36 triangles with two blocks and a light, open to the front.
pub(crate) fn room() -> Scene {
    let v = Vec3::new;
    let mut triangles = Vec::new();
    quad(&mut triangles, [v(-1., 0., -1.), v(1., 0., -1.), v(1., 0., 1.), v(-1., 0., 1.)]);
    quad(&mut triangles, [v(-1., 2., -1.), v(1., 2., -1.), v(1., 2., 1.), v(-1., 2., 1.)]);
    quad(&mut triangles, [v(-1., 0., -1.), v(1., 0., -1.), v(1., 2., -1.), v(-1., 2., -1.)]);
    quad(&mut triangles, [v(-1., 0., -1.), v(-1., 0., 1.), v(-1., 2., 1.), v(-1., 2., -1.)]);
    quad(&mut triangles, [v(1., 0., -1.), v(1., 0., 1.), v(1., 2., 1.), v(1., 2., -1.)]);
    quad(
        &mut triangles,
        [v(-0.25, 1.98, -0.25), v(0.25, 1.98, -0.25), v(0.25, 1.98, 0.25), v(-0.25, 1.98, 0.25)],
    );
    let light = triangles[10];
    block(&mut triangles, v(-0.35, 0.6, -0.3), v(0.3, 0.6, 0.3), 0.3);
    block(&mut triangles, v(0.35, 0.3, 0.35), v(0.3, 0.3, 0.3), -0.3);
    Scene { name: "room 36", triangles, eye: v(0.0, 1.0, 3.8), center: v(0.0, 1.0, 0.0), light }
}

/// A surface over a grid of `columns` × `rows` quads, in the middle of a light's reach.
fn grid(name: &'static str, columns: usize, rows: usize, at: impl Fn(f32, f32) -> Vec3) -> Scene {
    let mut triangles = Vec::with_capacity(2 * columns * rows);
    let at = |column: usize, row: usize| at(column as f32 / columns as f32, row as f32 / rows as f32);
    for column in 0..columns {
        for row in 0..rows {
            quad(
                &mut triangles,
                [at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)],
            );
        }
    }
    let light = [Vec3::new(-0.5, 3.0, 0.0), Vec3::new(0.5, 3.0, 0.0), Vec3::new(0.0, 3.0, 0.5)];
    Scene { name, triangles, eye: Vec3::new(0.0, 1.5, 3.0), center: Vec3::ZERO, light }
}

pub(crate) fn torus() -> Scene {
    grid("torus 70k", 264, 132, |u, v| {
        let (u, v) = (TAU * u, TAU * v);
        let radius = 1.0 + 0.4 * v.cos();
        Vec3::new(radius * u.cos(), 0.4 * v.sin(), radius * u.sin())
    })
}

pub(crate) fn sphere() -> Scene {
    grid("sphere 1M", 1000, 500, |u, v| {
        let (u, v) = (TAU * u, PI * v);
        Vec3::new(v.sin() * u.cos(), v.cos(), v.sin() * u.sin())
    })
}

/// Rays of the three kinds; shadow rays as pairs of end points.
pub(crate) struct Rays {
    pub(crate) primary: Vec<(Vec3, Vec3)>,
    pub(crate) bounces: Vec<(Vec3, Vec3)>,
    pub(crate) shadow: Vec<(Vec3, Vec3)>,
}

pub(crate) fn rays(scene: &Scene, accel: &Accel) -> Rays {
    let mut random = Random(1);
    let mut rays = Rays { primary: Vec::new(), bounces: Vec::new(), shadow: Vec::new() };
    let forward = (scene.center - scene.eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    while rays.bounces.len() < RAYS {
        // Neighbouring pixels follow each other in a picture; here each is drawn apart, the harder case.
        let (x, y) = (random.next() - 0.5, random.next() - 0.5);
        let mut ray = (scene.eye, (forward + 0.55 * (x * right + y * up)).normalize());
        if rays.primary.len() < RAYS {
            rays.primary.push(ray);
        }
        for _ in 0..4 {
            let Some(hit) = accel.intersect(ray.0, ray.1, f32::INFINITY) else { break };
            let triangle = scene.triangles[hit.primitive as usize];
            let point = point_on(&triangle, hit.barycentrics);
            let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalize();
            let normal = if normal.dot(ray.1) > 0.0 { -normal } else { normal };
            let (u, v) = (random.next(), random.next());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let target = point_on(&scene.light, [u, v]);
            rays.shadow.push((offset_origin(point, normal, target - point), target));
            let direction = (normal + random.direction()).normalize();
            ray = (offset_origin(point, normal, direction), direction);
            rays.bounces.push(ray);
        }
    }
    rays.bounces.truncate(RAYS);
    rays.shadow.truncate(RAYS);
    rays
}

pub(crate) fn hits(accel: &Accel, rays: &[(Vec3, Vec3)]) -> usize {
    let hit = |ray: &&(Vec3, Vec3)| accel.intersect(ray.0, ray.1, f32::INFINITY).is_some();
    rays.iter().filter(hit).count()
}

pub(crate) fn blocked(accel: &Accel, rays: &[(Vec3, Vec3)]) -> usize {
    rays.iter().filter(|ray| accel.occluded(ray.0, ray.1)).count()
}

fn traversal(criterion: &mut Criterion) {
    let mut scenes = vec![room(), torus()];
    if std::env::var_os("ARTY_BENCH_LARGE").is_some() {
        scenes.push(sphere());
    }
    for scene in scenes {
        let accel = Accel::build(&scene.triangles);
        let rays = rays(&scene, &accel);
        let mut group = criterion.benchmark_group(scene.name);
        group.throughput(Throughput::Elements(RAYS as u64));
        group.bench_function("primary", |b| b.iter(|| hits(&accel, black_box(&rays.primary))));
        group.bench_function("diffuse bounces", |b| b.iter(|| hits(&accel, black_box(&rays.bounces))));
        group.bench_function("shadow", |b| b.iter(|| blocked(&accel, black_box(&rays.shadow))));
        group.finish();
    }
}

criterion_group!(benches, traversal);
criterion_main!(benches);
