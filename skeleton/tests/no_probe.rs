//! Instrumentation for the grader exists in the build of its host only.

use arty::light::Light;
use arty::math::{Rgb, Vec3};

#[test]
fn a_normal_build_has_no_probe() {
    // Cargo unifies the features of all packages in a build: this fails if any of them enables `probe`.
    let probe = cfg!(feature = "probe");
    assert!(!probe, "run the tests without `--features probe`");
    // A script would add a point and a density: at least 16 bytes more than the largest shape, the triangle (3 vertices, a
    // normal, an area, a radiance), with the index and the tag.
    let triangle = 4 * size_of::<Vec3>() + size_of::<f32>() + size_of::<Rgb>();
    assert!(size_of::<Light>() <= triangle + 3 * size_of::<usize>(), "{}", size_of::<Light>());
}
