//! Paths as the window shows them: what they add by the formulas of the sheet is what the solution returns.

#![cfg(feature = "view")]

#[path = "../src/algorithms/mod.rs"]
pub mod algorithms;

use std::path::Path;

use arty::cli::Algorithm;
use arty::integrator::{Integrator, Settings, Technique};
use arty::scene::{Scene, file};
use arty_view::path::Query;
use arty_view::path::trace::trace;
use arty_view::path::vertices;

use algorithms::{render_debug::DebugTracer, render_pt::PathTracer};

const SIZE: (u32, u32) = (64, 48);

fn make(algorithm: Algorithm, _: &Scene) -> Box<dyn Integrator> {
    match algorithm {
        Algorithm::Debug(view) => Box::new(DebugTracer::new(view)),
        Algorithm::PathTracer(settings) => Box::new(PathTracer::new(settings)),
    }
}

#[test]
fn contributions_along_a_path_sum_to_what_the_solution_returns() {
    for name in ["cornell_box", "cornell_box_glossy", "cornell_box_water", "mixed_lights", "mirror_light"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/{name}.yml"));
        let description = file::load(&path).expect("a scene").description;
        let scene = Scene::new(&description);
        let lights: Vec<bool> = scene.lights().iter().map(|light| light.has_area()).collect();
        let (mut compared, mut bright) = (0, 0);
        for technique in Technique::ALL {
            // With more bounces there is Russian roulette, whose effect is not known.
            let settings = Settings { technique, max_bounces: 4 };
            for pixel in (0..SIZE.1).step_by(7).flat_map(|y| (0..SIZE.0).step_by(7).map(move |x| (x, y))) {
                let query = Query { camera: description.camera, settings, pixel, sample: 0 };
                let traced = trace(&scene, make, &query, SIZE, 3);
                for recorded in traced.paths.expect("no panic") {
                    let path = vertices::Path::new(&recorded, technique, &lights);
                    assert!(!path.roulette);
                    assert_eq!(
                        traced.values[recorded.sample as usize], recorded.radiance,
                        "it can be repeated"
                    );
                    let (sum, returned) = (path.sum(), recorded.radiance);
                    let error = (sum - returned).map(f32::abs).max_channel();
                    let where_at = format!("{name} {technique} {pixel:?} {}", recorded.sample);
                    // Both are computed in single precision, in another order.
                    assert!(error <= 1e-4 * returned.max_channel(), "{where_at}: {sum:?}, {returned:?}");
                    compared += 1;
                    bright += u32::from(!returned.is_black());
                }
            }
        }
        assert!(bright > compared / 20, "{name}: {bright} of {compared} paths find light");
    }
}
