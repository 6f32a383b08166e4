//! Origins and targets of rays: off the surface they start on, on the light they end at.

use glam::Vec3;

use super::super::{Accel, exact, offset_origin, point_on};
use super::{PLACES, Random, Triangle, ball, cube, place, unit_normal};

#[test]
fn a_light_does_not_occlude_itself_but_a_plate_in_front_of_it_does() {
    for at in PLACES {
        let (scale, offset) = at;
        let place = place(at);
        let mut random = Random(4);
        for _ in 0..40 {
            // A light of two triangles, coplanar up to rounding, and a second sheet close behind it.
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
            // A plate in front of it, at a ten-thousandth of the size, which must be more than rounding.
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
                // Through the middle of the plate: from twice its height, not past its rim.
                let inner = point_on(&light[0], [0.3 + 0.1 * random.next(), 0.3]);
                let origin = inner + scale * (0.3 * random.point() + 2.0 * normal);
                assert!(blocked.occluded(origin, inner, None), "{at:?}: a plate before");
                assert!(!blocked.occluded(inner + scale * normal, inner + scale * 2.0 * normal, None));
            }
        }
    }
}

#[test]
fn the_excluded_triangle_is_not_hit() {
    let plate = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(2.0, -1.0, z), Vec3::new(-1.0, 2.0, z)];
    // One block, and a tree.
    for count in [3, 100] {
        let triangles: Vec<Triangle> = (0..count).map(|index| plate(index as f32)).collect();
        let accel = Accel::build(&triangles);
        let (origin, up) = (Vec3::new(0.1, 0.1, 0.5), Vec3::Z);
        let hit = |exclude| accel.intersect(origin, up, f32::INFINITY, exclude).map(|hit| hit.primitive);
        assert_eq!((hit(None), hit(Some(0)), hit(Some(1))), (Some(1), Some(1), Some(2)));
        let blocked = |exclude| accel.occluded(origin, origin + up, exclude);
        assert!(blocked(None) && blocked(Some(0)) && !blocked(Some(1)));
    }
}

#[test]
fn rays_do_not_hit_the_surface_they_start_on() {
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
            // Points within rounding of an edge may be on the far side of the neighbour's plane.
            let allowed = if at.1 == 0.0 { 2 } else { 2_000 };
            assert!(escaped <= allowed, "{at:?}: {escaped} escaped");
        }
    }
}

#[test]
fn an_offset_point_is_on_its_side_of_the_plane_and_close() {
    let mut random = Random(10);
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        for offset in [0.0, 1.0, 1e3] {
            for _ in 0..20_000 {
                // Random planes, axis-aligned planes, and planes through the origin.
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
                let area = exact::normal(&triangle).length();
                if area < 1e-3 * f64::from(scale * scale) {
                    continue; // Its normal would be inaccurate.
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
                let magnitude = f64::from(point.abs().max_element());
                assert!(height < 8.0 * f64::from(f32::EPSILON) * magnitude + 1e-29, "{height} from {point}");
            }
        }
    }
}
