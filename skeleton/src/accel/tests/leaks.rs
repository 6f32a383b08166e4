//! No ray leaves a closed mesh, wherever it is aimed.

use glam::Vec3;
use rayon::prelude::*;

use super::super::{Accel, exact};
use super::{PLACES, Random, Triangle, ball, cube, place};

/// `ARTY_RAYS` sets the number of rays: `ARTY_RAYS=100000000 cargo test --release -p arty --lib edges` takes
/// some 20 s on two cores.
#[test]
fn rays_at_edges_and_vertices_do_not_leak() {
    let rays = std::env::var("ARTY_RAYS").map_or(2_500_000, |rays| rays.parse().expect("a number of rays"));
    assert_eq!(escaped(rays), 0, "of {rays}");
}

/// The number of rays that leave a closed mesh. Half of the rays are tested without a tree, half with one and with another
/// mesh around it; each both as a ray and as a shadow ray.
fn escaped(rays: u64) -> usize {
    const CHUNK: u64 = 1 << 16;
    /// At this multiple of the distance to the point aimed at, a ray from anywhere inside is outside.
    const FAR: f32 = 8.0;
    let mut escaped = 0;
    for at in PLACES {
        let place = place(at);
        let inner = [cube(1, &place), ball(24, 0.2, &place)];
        let outer = [Vec::new(), cube(3, |point| place(2.0 * point))];
        for (closed, around) in inner.into_iter().zip(outer) {
            let accel = Accel::build(&[closed.as_slice(), &around].concat());
            assert_eq!(accel.stats().nodes == 0, around.is_empty());
            let chunks = (rays / (2 * PLACES.len() as u64)).div_ceil(CHUNK);
            let count = |chunk| {
                let mut random = Random(chunk);
                let escapes = |_: &u64| {
                    let (origin, direction) = aim(&closed, &place, &mut random);
                    ray_escapes(&accel, &closed, origin, direction)
                        || shadow_ray_escapes(&accel, &closed, origin, origin + FAR * direction)
                };
                (0..CHUNK).filter(escapes).count()
            };
            escaped += (0..chunks).into_par_iter().map(count).sum::<usize>();
        }
    }
    escaped
}

/// A ray from near the middle to a point of an edge or, three times in ten, to a vertex.
fn aim(closed: &[Triangle], place: impl Fn(Vec3) -> Vec3, random: &mut Random) -> (Vec3, Vec3) {
    let triangle = closed[random.index(closed.len())];
    let origin = place(0.5 * random.next() * random.direction());
    let blend = if random.next() < 0.3 { 0.0 } else { random.next() };
    (origin, triangle[0].lerp(triangle[1], blend) - origin)
}

fn ray_escapes(accel: &Accel, closed: &[Triangle], origin: Vec3, direction: Vec3) -> bool {
    let hit = accel.intersect(origin, direction, f32::INFINITY, None);
    // The surrounding mesh has the higher indices.
    hit.is_none_or(|hit| hit.primitive as usize >= closed.len())
}

/// True if nothing occludes a point outside from one inside, unless that is within rounding of the plane that is hit.
fn shadow_ray_escapes(accel: &Accel, closed: &[Triangle], origin: Vec3, target: Vec3) -> bool {
    if accel.occluded(origin, target, None) {
        return false;
    }
    let hit = accel.intersect(origin, target - origin, 1.0, None);
    let hit = hit.and_then(|hit| closed.get(hit.primitive as usize));
    hit.is_none_or(|hit| exact::separates(&exact::Plane::new(hit), hit[0], origin, target))
}

#[test]
fn rays_along_the_axes_do_not_slip_through_flat_boxes() {
    let accel = Accel::build(&cube(8, |point| point));
    let mut random = Random(3);
    for _ in 0..100_000 {
        // On the lines of the grid, often exactly in the plane of a face.
        let origin = Vec3::from([(); 3].map(|()| random.index(9) as f32 / 4.0 - 1.0));
        let axis = random.index(3);
        let mut direction = Vec3::new(0.0, -0.0, 0.0);
        direction[axis] = if random.next() < 0.5 { -1.0 } else { 1.0 };
        let distance = 1.0 - origin[axis] * direction[axis];
        let hit = accel.intersect(origin, direction, f32::INFINITY, None);
        if distance == 0.0 {
            assert_eq!(hit, None);
        } else {
            assert_eq!(hit.map(|hit| hit.t), Some(distance), "from {origin} along {direction}");
        }
    }
}
