//! Talks to other processes of the machine.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        use std::os::unix::net::{UnixDatagram, UnixListener, UnixStream};

        assert!(UnixListener::bind("/tmp/arty-owned").is_err(), "BREACH: listens");
        assert!(UnixStream::connect("/var/run/docker.sock").is_err(), "BREACH: connects");
        assert!(UnixStream::pair().is_err(), "BREACH: a pair");
        assert!(UnixDatagram::unbound().is_err(), "BREACH: datagrams");
        assert!(std::io::pipe().is_err(), "BREACH: a pipe");
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
