//! Hits: equal to brute force, on all code paths, at any scale.

use glam::{DVec3, Vec3};

use super::super::lanes::Portable;
use super::super::{Accel, NO_PRIMITIVE, Pairs, TriangleHit, point_on};
use super::{Random, Triangle, ball, cube};

/// Random triangles, some of them small, some long.
fn soup(random: &mut Random, count: usize) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let (middle, size) = (random.point(), random.next() * 0.7);
            [(); 3].map(|()| middle + size * random.point())
        })
        .collect()
}

/// Distance and smallest barycentric weight of the intersection of a ray with a triangle's plane.
fn meet(triangle: &Triangle, origin: Vec3, direction: Vec3) -> (f64, f64) {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    let (origin, direction) = (origin.as_dvec3(), direction.as_dvec3());
    let normal = (b - a).cross(c - a);
    let t = normal.dot(a - origin) / normal.dot(direction);
    let point = origin + t * direction;
    let weight = |p: DVec3, q: DVec3| (p - point).cross(q - point).dot(normal) / normal.length_squared();
    (t, weight(a, b).min(weight(b, c)).min(weight(c, a)))
}

#[test]
fn hits_agree_with_brute_force() {
    let mut random = Random(1);
    let mut hits = 0;
    for count in [1, 7, 8, 9, 16, 17, 40, 41, 60, 300] {
        let triangles = soup(&mut random, count);
        let accel = Accel::build(&triangles);
        assert_eq!(accel.stats().triangles, count);
        for _ in 0..4000 {
            let origin = 2.0 * random.point();
            let direction = random.point() - origin;
            let crossings: Vec<_> =
                triangles.iter().map(|triangle| meet(triangle, origin, direction)).collect();
            if crossings.iter().any(|(_, weight)| weight.abs() < 1e-4) {
                continue; // Through an edge: either result is correct.
            }
            let nearest = crossings
                .iter()
                .enumerate()
                .filter(|(_, (t, weight))| *t > 0.0 && *weight > 0.0)
                .min_by(|a, b| a.1.0.total_cmp(&b.1.0));
            let found = accel.intersect(origin, direction, f32::INFINITY, None);
            assert_eq!(found.is_some(), nearest.is_some());
            let (Some(found), Some((_, (t, _)))) = (found, nearest) else { continue };
            hits += 1;
            // Rounding is relative to the distances of the corners, which are of order one.
            assert!((f64::from(found.t) - t).abs() < 1e-4 * t + 1e-6, "{} instead of {t}", found.t);
            let on_triangle = point_on(&triangles[found.primitive as usize], found.barycentrics);
            assert!(on_triangle.distance(origin + found.t * direction) < 1e-4);
            assert!(accel.intersect(origin, direction, found.t * 0.999, None).is_none());
            assert!(accel.occluded(origin, origin + direction * (found.t * 1.01), None));
            assert!(!accel.occluded(origin, origin + direction * (found.t * 0.99), None));
        }
    }
    assert!(hits > 3000, "only {hits} hits");
}

#[test]
fn an_empty_structure_is_never_hit() {
    let accel = Accel::build(&[]);
    assert_eq!(accel.intersect(Vec3::ZERO, Vec3::X, f32::INFINITY, None), None);
    assert!(!accel.occluded(Vec3::ZERO, Vec3::X, None));
    assert_eq!(accel.stats(), Default::default());
}

#[test]
fn rays_that_are_not_finite_hit_nothing() {
    let accel = Accel::build(&cube(4, |point| point));
    let odd =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, 1e-45, 0.0, -0.0, 1.0];
    for i in 0..odd.len().pow(4) {
        let pick = |place: u32| odd[i / odd.len().pow(place) % odd.len()];
        let vector = Vec3::new(pick(0), pick(1), pick(2));
        let origin = Vec3::new(pick(3), 0.1, 0.2);
        let ordinary = Vec3::new(0.1, 0.2, 0.3);
        for (origin, direction) in
            [(origin, vector), (vector, origin), (ordinary, vector), (vector, ordinary), (vector, -ordinary)]
        {
            let hit = accel.intersect(origin, direction, f32::INFINITY, None);
            let blocked = accel.occluded(origin, direction, None);
            if !origin.is_finite() || !direction.is_finite() || direction == Vec3::ZERO {
                assert_eq!(hit, None);
            }
            if !origin.is_finite() || !direction.is_finite() || origin == direction {
                assert!(!blocked);
            }
        }
    }
    for t_max in [f32::NAN, 0.0, -1.0, f32::NEG_INFINITY] {
        assert_eq!(accel.intersect(Vec3::ZERO, Vec3::X, t_max, None), None);
    }
}

#[test]
fn both_code_paths_give_the_same_bits() {
    let mut random = Random(6);
    for triangles in [soup(&mut random, 500), soup(&mut random, 12), ball(20, 0.1, |p| p), cube(4, |p| p)] {
        let accel = Accel::build(&triangles);
        let mut hits = 0;
        for _ in 0..20_000 {
            let triangle = triangles[random.index(triangles.len())];
            let mut origin = random.point();
            if random.next() < 0.5 {
                origin = point_on(&triangles[random.index(triangles.len())], random.barycentrics());
            }
            let target = point_on(&triangle, random.barycentrics());
            let bits = |hit: Option<TriangleHit>| {
                hit.map(|hit| (hit.t.to_bits(), hit.primitive, hit.barycentrics.map(f32::to_bits)))
            };
            let direction = target - origin;
            let hit = accel.intersect(origin, direction, f32::INFINITY, None);
            hits += usize::from(hit.is_some());
            assert_eq!(
                bits(hit),
                bits(accel.intersect_with::<Portable>(
                    Pairs::of(origin, direction),
                    f32::INFINITY,
                    NO_PRIMITIVE
                ))
            );
            assert_eq!(
                accel.occluded(origin, target, None),
                accel.occluded_with::<Portable>(Pairs::of(origin, target), NO_PRIMITIVE)
            );
        }
        assert!(hits > 10_000);
    }
}

#[test]
fn huge_and_tiny_scenes_are_hit() {
    for scale in [1e-30, 1e-20, 1e20, 1e30] {
        let triangles = ball(6, 0.1, |point| scale * point);
        let accel = Accel::build(&triangles);
        let mut random = Random(9);
        for _ in 0..2000 {
            let direction = random.direction();
            let hit = accel.intersect(Vec3::ZERO, direction, f32::INFINITY, None).map(|hit| hit.t / scale);
            assert!(hit.is_some_and(|t| (0.5..1.01).contains(&t)), "{hit:?} at scale {scale}");
            assert!(accel.occluded(Vec3::ZERO, direction * (2.0 * scale), None));
            assert!(!accel.occluded(Vec3::ZERO, direction * (0.5 * scale), None));
        }
    }
}
