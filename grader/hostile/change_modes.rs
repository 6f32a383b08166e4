//! Changes modes, owners and times of files.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        use std::os::unix::fs::{PermissionsExt, chown};

        for path in ["hand-in", ".", "/tmp", "@ROOT@/README.md"] {
            let open = std::fs::Permissions::from_mode(0o777);
            assert!(std::fs::set_permissions(path, open).is_err(), "BREACH: mode of {path}");
            assert!(chown(path, Some(0), Some(0)).is_err(), "BREACH: owner of {path}");
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
