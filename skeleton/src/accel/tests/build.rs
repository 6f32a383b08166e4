//! Building the structure.

use glam::Vec3;

use super::super::binary::BinaryTree;
use super::super::tree::Tree;
use super::super::{Accel, clean, point_on};
use super::{Random, ball, unit_normal};

#[test]
fn degenerate_and_duplicate_triangles_are_ignored() {
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
fn a_median_split_tree_gives_the_same_hits() {
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
    // Nested boxes, and needles of all lengths from a common point.
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
