//! Rays against triangles: compared with brute force, aimed at edges, started on surfaces, ended on lights.

use glam::{DVec3, Vec3};

use super::binary::BinaryTree;
use super::lanes::Portable;
use super::tree::Tree;
use super::{Accel, NO_PRIMITIVE, Pairs, TriangleHit, clean, offset_origin, point_on};

type Triangle = [Vec3; 3];

/// SplitMix64, with fixed seeds.
struct Random(u64);

impl Random {
    /// In [0, 1).
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 40) as f32 / (1u64 << 24) as f32
    }

    fn index(&mut self, count: usize) -> usize {
        (self.next() * count as f32) as usize % count
    }

    /// In the cube from −1 to 1.
    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let point = self.point();
            if (0.01..1.0).contains(&point.length_squared()) {
                return point.normalize();
            }
        }
    }

    /// Weights of corners 1 and 2, uniform over a triangle.
    fn barycentrics(&mut self) -> [f32; 2] {
        let (v, w) = (self.next(), self.next());
        if v + w > 1.0 { [1.0 - v, 1.0 - w] } else { [v, w] }
    }
}

/// A ball with a rough surface, closed: each face of an octahedron divided into `n`² triangles. It contains the
/// ball of half its radius, and is star-shaped as seen from its centre.
fn ball(n: usize, roughness: f32, place: impl Fn(Vec3) -> Vec3) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for octant in 0..8 {
        let sign = Vec3::new(
            if octant & 1 == 0 { 1.0 } else { -1.0 },
            if octant & 2 == 0 { 1.0 } else { -1.0 },
            if octant & 4 == 0 { 1.0 } else { -1.0 },
        );
        let at = |i: usize, j: usize| {
            let grid = Vec3::new(i as f32, j as f32, (n - i - j) as f32) * sign;
            // A radius that depends on the vertex only, so that neighbours agree.
            let seed = (grid.x as i64 * 1_000_003 + grid.y as i64 * 1_009 + grid.z as i64) as u64;
            place(grid.normalize() * (1.0 - roughness * Random(seed).next()))
        };
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 2 <= n {
                    triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    triangles
}

/// The cube from −1 to 1, each face divided into `n`² squares.
fn cube(n: usize, place: impl Fn(Vec3) -> Vec3) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    let at = |i: usize| 2.0 * i as f32 / n as f32 - 1.0;
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for i in 0..n {
                for j in 0..n {
                    let corner = |u: usize, v: usize| {
                        let mut point = Vec3::splat(side);
                        point[(axis + 1) % 3] = at(i + u);
                        point[(axis + 2) % 3] = at(j + v);
                        place(point)
                    };
                    triangles.push([corner(0, 0), corner(1, 0), corner(1, 1)]);
                    triangles.push([corner(0, 0), corner(1, 1), corner(0, 1)]);
                }
            }
        }
    }
    triangles
}

/// Where scenes are put: scaled, and moved by a thousand times their size.
const PLACES: [(f32, f32); 6] = [(1.0, 0.0), (1e-4, 0.0), (1e4, 0.0), (1.0, 1e3), (1e-4, 1e3), (1e4, 1e3)];

fn place((scale, offset): (f32, f32)) -> impl Fn(Vec3) -> Vec3 {
    move |point| (point + offset * Vec3::new(1.0, -0.7, 0.4)) * scale
}

fn unit_normal(triangle: &Triangle) -> DVec3 {
    super::exact::normal(triangle).normalize()
}

/// A pixel's or a shadow's worth of random triangles, some of them small, some long.
fn soup(random: &mut Random, count: usize) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let (middle, size) = (random.point(), random.next() * 0.7);
            [(); 3].map(|()| middle + size * random.point())
        })
        .collect()
}

/// Distance and least barycentric weight where a ray meets a triangle's plane.
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
fn hits_are_those_of_brute_force() {
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
                continue; // Through an edge: either answer is right.
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
fn rays_at_vertices_and_edges_of_a_closed_mesh_do_not_escape() {
    for at in PLACES {
        let place = place(at);
        let triangles: Vec<_> =
            ball(24, 0.2, &place).into_iter().chain(cube(3, |p| place(2.0 * p))).collect();
        // Rays from within the ball at the ball; those from between at the cube are covered by the next mesh.
        let accel = Accel::build(&triangles);
        let count = ball(24, 0.2, &place).len();
        let mut random = Random(2);
        let mut escaped = 0;
        for _ in 0..220_000 {
            let triangle = triangles[random.index(count)];
            let origin = place(0.5 * random.next() * random.direction());
            let blend = if random.next() < 0.3 { 0.0 } else { random.next() };
            let target = triangle[0].lerp(triangle[1], blend);
            let hit = accel.intersect(origin, target - origin, f32::INFINITY, None);
            escaped += usize::from(hit.is_none_or(|hit| hit.primitive as usize >= count));
        }
        assert_eq!(escaped, 0, "scale and offset {at:?}");
    }
}

#[test]
fn rays_along_the_axes_do_not_slip_through_flat_boxes() {
    let accel = Accel::build(&cube(8, |point| point));
    let mut random = Random(3);
    for _ in 0..100_000 {
        // On the lines of the grid, often right in the plane of a face.
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

#[test]
fn triangles_that_cannot_be_hit_and_duplicates_are_left_out() {
    let v = Vec3::new;
    let [a, b, c] = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)];
    let triangles = [
        [a, a, b],
        [a, b, c],
        [c, a, b],
        [v(-0.0, 0.0, 0.0), c, b],
        [v(0.1, 0.2, 0.3), v(0.2, 0.4, 0.6), v(0.4, 0.8, 1.2)],
        [a, v(f32::NAN, 0.0, 0.0), c],
        [a, v(f32::INFINITY, 0.0, 0.0), c],
        [a, v(1e-30, 0.0, 0.0), v(0.0, 1e-30, 0.0)],
    ];
    let accel = Accel::build(&triangles);
    let stats = accel.stats();
    assert_eq!((stats.triangles, stats.degenerate, stats.duplicates), (2, 4, 2));
    let hit = accel.intersect(v(0.2, 0.2, 1.0), v(0.0, 0.0, -1.0), 2.0, None);
    assert_eq!(hit.map(|hit| (hit.t, hit.primitive)), Some((1.0, 1)));
}

#[test]
fn nothing_is_hit_where_nothing_is() {
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
            [(origin, vector), (vector, origin), (ordinary, vector), (vector, ordinary)]
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
fn a_light_does_not_block_itself_but_what_is_before_it_does() {
    for at in PLACES {
        let (scale, offset) = at;
        let place = place(at);
        let mut random = Random(4);
        for _ in 0..40 {
            // A light of two triangles, flat but for rounding, and a second sheet close behind it.
            let corners: [Vec3; 4] = {
                let (middle, u) = (random.point(), random.direction());
                let v = u.cross(random.direction()).normalize();
                [-u - v, u - v, u + v, v - u].map(|corner| middle + 0.3 * corner)
            };
            let [a, b, c, d] = corners.map(&place);
            let light = [[a, b, c], [a, c, d]];
            let normal = unit_normal(&light[0]).as_vec3();
            let behind = light.map(|triangle| triangle.map(|corner| corner - 0.02 * scale * normal));
            let alone = Accel::build(&light);
            let backed = Accel::build(&[light[0], light[1], behind[0], behind[1]]);
            // A plate before it, by a ten-thousandth of the size; rounding must leave that a distance.
            let gap = if offset == 0.0 { 1e-4 } else { 1e-2 };
            let before = light.map(|triangle| triangle.map(|corner| corner + gap * scale * normal));
            let blocked = Accel::build(&[light[0], light[1], before[0], before[1]]);
            for _ in 0..500 {
                let target = point_on(&light[random.index(2)], random.barycentrics());
                let distance = scale * 10f32.powf(4.0 * random.next() - 3.0);
                let along = random.direction();
                // From straight above to a ten-thousandth above the plane.
                let slope = 10f32.powf(-4.0 * random.next());
                let along = (along - along.dot(normal) * normal).normalize();
                let away = (along + slope * normal).normalize() * distance;
                let origin = target + away;
                let height = (origin - target).as_dvec3().dot(normal.as_dvec3());
                let rounding = f64::from(f32::EPSILON * target.abs().max(origin.abs()).max_element());
                if height < 4.0 * rounding {
                    continue;
                }
                assert!(!alone.occluded(origin, target, None), "{at:?}: its own light, from {away}");
                assert!(!backed.occluded(origin, target, None), "{at:?}: a sheet behind, from {away}");
                // Through the middle of the plate: from twice as high as it is, and not past its rim.
                let inner = point_on(&light[0], [0.3 + 0.1 * random.next(), 0.3]);
                let origin = inner + scale * (0.3 * random.point() + 2.0 * normal);
                assert!(blocked.occluded(origin, inner, None), "{at:?}: a plate before");
                assert!(!blocked.occluded(inner + scale * normal, inner + scale * 2.0 * normal, None));
            }
        }
    }
}

#[test]
fn the_triangle_that_is_left_is_not_there() {
    let plate = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(2.0, -1.0, z), Vec3::new(-1.0, 2.0, z)];
    // One packet, and a tree.
    for count in [3, 100] {
        let triangles: Vec<Triangle> = (0..count).map(|index| plate(index as f32)).collect();
        let accel = Accel::build(&triangles);
        let (origin, up) = (Vec3::new(0.1, 0.1, 0.5), Vec3::Z);
        let hit = |leaves| accel.intersect(origin, up, f32::INFINITY, leaves).map(|hit| hit.primitive);
        assert_eq!((hit(None), hit(Some(0)), hit(Some(1))), (Some(1), Some(1), Some(2)));
        let blocked = |leaves| accel.occluded(origin, origin + up, leaves);
        assert!(blocked(None) && blocked(Some(0)) && !blocked(Some(1)));
    }
}

#[test]
fn rays_do_not_hit_what_they_start_from() {
    for at in PLACES {
        let place = place(at);
        for triangles in [ball(40, 0.0, &place), cube(8, &place)] {
            let accel = Accel::build(&triangles);
            let mut random = Random(5);
            let mut ray = (place(Vec3::ZERO), random.direction());
            let mut escaped = 0;
            for _ in 0..20_000 {
                let Some(hit) = accel.intersect(ray.0, ray.1, f32::INFINITY, None) else {
                    escaped += 1;
                    ray = (place(Vec3::ZERO), random.direction());
                    continue;
                };
                let triangle = triangles[hit.primitive as usize];
                let normal = unit_normal(&triangle);
                let inwards = if normal.dot(ray.1.as_dvec3()) > 0.0 { -normal } else { normal }.as_vec3();
                let direction = (inwards + 0.999 * random.direction()).normalize();
                let origin = offset_origin(point_on(&triangle, hit.barycentrics), inwards, direction);
                ray = (origin, direction);
                let next = accel.intersect(ray.0, ray.1, f32::INFINITY, None);
                assert_ne!(next.map(|next| next.primitive), Some(hit.primitive), "{at:?}");
                let told = accel.intersect(ray.0, ray.1, f32::INFINITY, Some(hit.primitive));
                assert_eq!(next, told, "{at:?}: to know what is left saves time and changes nothing");
            }
            // Points within rounding of an edge may come to lie on the far side of the neighbour's plane.
            let allowed = if at.1 == 0.0 { 2 } else { 2_000 };
            assert!(escaped <= allowed, "{at:?}: {escaped} escaped");
        }
    }
}

#[test]
fn both_kinds_of_code_give_the_same_bits() {
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
fn a_halved_tree_gives_the_same_hits() {
    let triangles = ball(20, 0.1, |point| point);
    let accel = Accel::build(&triangles);
    let cleaned = clean::clean(&triangles);
    let mut halved = accel.clone();
    halved.tree =
        Tree::collapse(&BinaryTree::halve(&cleaned.triangles), &cleaned.triangles, &cleaned.primitives);
    let mut random = Random(7);
    for _ in 0..10_000 {
        let (origin, direction) = (2.0 * random.point(), random.direction());
        let [a, b] =
            [&accel, &halved].map(|accel| accel.intersect(origin, direction, 9.0, None).map(|hit| hit.t));
        assert_eq!(a, b);
    }
}

#[test]
fn awkward_meshes_are_built_and_hit() {
    // Thousands of different triangles with the same box.
    let mut random = Random(8);
    let same_box = |random: &mut Random| {
        let (u, v) = (random.next(), random.next());
        [Vec3::ZERO, Vec3::new(1.0, u, 1.0), Vec3::new(v, 1.0, 0.0)]
    };
    let coincident: Vec<_> = (0..20_000).map(|_| same_box(&mut random)).collect();
    // Boxes one in another, and needles of all lengths from a common point.
    let nested: Vec<_> =
        (1..3000).map(|i| [-1.0, 0.0, 1.0].map(|x: f32| i as f32 * Vec3::new(x, x * x - 0.5, x))).collect();
    let needles: Vec<_> = (1..2000)
        .map(|i| {
            let far = 1.1f32.powi(i % 400 - 200) * random.direction();
            [Vec3::ZERO, far, far + 1e-5 * far.length() * random.direction()]
        })
        .collect();
    for triangles in [coincident, nested, needles] {
        let accel = Accel::build(&triangles);
        let mut hit = 0;
        for triangle in &triangles {
            let target = point_on(triangle, [0.4, 0.4]);
            let origin = target + 3.0 * unit_normal(triangle).as_vec3() * target.length();
            hit += usize::from(accel.intersect(origin, target - origin, 2.0, None).is_some());
        }
        assert!(hit * 10 > triangles.len() * 9, "{hit} of {}", triangles.len());
    }
}

#[test]
fn enormous_and_minute_scenes_are_hit() {
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

#[test]
fn an_offset_point_is_on_its_side_of_the_plane_and_near() {
    let mut random = Random(10);
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        for offset in [0.0, 1.0, 1e3] {
            for _ in 0..20_000 {
                // Planes at random, along the axes, and through the origin.
                let kind = random.index(3);
                let mut triangle = [(); 3].map(|()| random.point());
                match kind {
                    0 => triangle = triangle.map(|corner| corner + offset * Vec3::new(0.3, 1.0, -0.5)),
                    1 => {
                        let axis = random.index(3);
                        let level = random.index(2) as f32 * offset;
                        triangle.iter_mut().for_each(|corner| corner[axis] = level);
                    }
                    _ => triangle[1] = -triangle[0],
                }
                let triangle = triangle.map(|corner| scale * corner);
                let area = super::exact::normal(&triangle).length();
                if area < 1e-3 * f64::from(scale * scale) {
                    continue; // Its normal would say little.
                }
                let normal = unit_normal(&triangle);
                // Often next to the middle of an edge: with kind 2, next to (0, 0, 0).
                let near = if random.next() < 0.5 { 1.0 } else { 1e-4 };
                let [v, w] = random.barycentrics();
                let point = point_on(&triangle, [0.5 + near * (v - 0.5), near * w * (1.0 - v)]);
                let direction = random.direction();
                let moved = offset_origin(point, normal.as_vec3(), direction);
                let side = f64::from(normal.as_vec3().dot(direction)).signum();
                let height = side * normal.dot(moved.as_dvec3() - triangle[0].as_dvec3());
                assert!(height > 0.0, "{height} beside {triangle:?}");
                let greatest = f64::from(point.abs().max_element());
                assert!(height < 8.0 * f64::from(f32::EPSILON) * greatest + 1e-29, "{height} from {point}");
            }
        }
    }
}
