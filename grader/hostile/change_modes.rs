//! Changes modes, owners and times of files.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        use std::os::unix::fs::{PermissionsExt, chown};

        for (path, mode) in [("submission", 0o755), (".", 0o700), ("@ROOT@/README.md", 0o644)] {
            let mode = std::fs::Permissions::from_mode(mode);
            assert!(std::fs::set_permissions(path, mode).is_err(), "BREACH: mode of {path}");
            assert!(chown(path, None, None).is_err(), "BREACH: owner of {path}");
        }
        assert!(std::env::set_current_dir("/").is_err(), "BREACH: folder");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
