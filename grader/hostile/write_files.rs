//! Writes, moves and removes files.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        use std::fs;

        for path in
            ["/tmp/arty-owned", "owned", "submission", "render_pt.rs", "/dev/shm/arty-owned", "@ROOT@/owned"]
        {
            assert!(fs::write(path, "owned").is_err(), "BREACH: {path} is written");
            assert!(fs::remove_file(path).is_err(), "BREACH: {path} is removed");
            assert!(fs::create_dir(path).is_err(), "BREACH: {path} is made");
            assert!(fs::rename("submission", path).is_err(), "BREACH: moved to {path}");
            assert!(fs::hard_link("submission", path).is_err(), "BREACH: linked to {path}");
            assert!(std::os::unix::fs::symlink("/etc/passwd", path).is_err(), "BREACH: linked from {path}");
        }
        assert!(fs::remove_dir_all(".").is_err(), "BREACH: its folder is removed");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
