//! Tests of chains.

use arty::ray::Ray;
use arty::scene::Scene;

use super::*;

/// The points that a path through the chain meets.
#[test]
fn each_surface_sees_the_next_one_and_the_last_one_the_light() {
    use SurfaceKind::{Diffuse, Glass};
    for count in 1..=12 {
        for kind in [Diffuse, Glass] {
            for apart in [0.0, 0.25] {
                let mut chain = Chain::new(&vec![kind; count], PathEnd::AreaLight);
                chain.apart = apart;
                let audited = chain.scene();
                let scene = Scene::new(&audited.scene);
                let mut ray = Ray::new(audited.origin, audited.direction);
                for index in 1..=count {
                    let hit = scene.intersect(&ray).expect("there is a surface");
                    assert!(
                        hit.point.distance(chain.point(index).as_vec3()) < 1e-3,
                        "{count} {kind:?} {index}"
                    );
                    assert!(hit.emission().is_none());
                    if index == count && kind == Diffuse {
                        assert!(!scene.occluded(&hit, chain.sampled_point().as_vec3()));
                        assert!(
                            (f64::from(hit.cos(ray_to(&hit, &chain))) - chain.sampled().cos).abs() < 1e-4
                        );
                    }
                    let next = chain.point(index + 1).as_vec3() - hit.point;
                    ray = hit.spawn(next.normalize());
                }
                let light = scene.intersect(&ray).expect("there is a light");
                let emission = light.emission().expect("its front is hit");
                assert!((emission.cos_light - 0.8).abs() < 1e-4);
            }
        }
    }
}

fn ray_to(hit: &arty::scene::Hit<'_>, chain: &Chain) -> Vec3 {
    (chain.sampled_point().as_vec3() - hit.point).normalize()
}
