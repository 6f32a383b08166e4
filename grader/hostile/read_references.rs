//! Reads what its picture should look like, the solution, and what others handed in.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        for path in [
            "@ROOT@/references/point_plane.exr",
            "@ROOT@/solution/src/algorithms/render_pt.rs",
            "@ROOT@/scenes/point_plane.yml",
            "render_pt.rs",
            "main.rs",
            "submission",
            "messages.json",
            "/etc/passwd",
            "/etc/hostname",
            "/dev/null",
            "/dev/urandom",
        ] {
            assert!(std::fs::read(path).is_err(), "BREACH: {path}");
            assert!(std::fs::metadata(path).is_err(), "BREACH: {path} can be asked about");
        }
        for folder in [".", "..", "/tmp", "/", "/home", "@ROOT@"] {
            assert!(std::fs::read_dir(folder).is_err(), "BREACH: {folder}");
        }
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
