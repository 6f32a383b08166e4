//! Talks to the world.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        use std::net::{TcpListener, TcpStream, ToSocketAddrs, UdpSocket};

        assert!(TcpListener::bind("127.0.0.1:0").is_err(), "BREACH: listens");
        assert!(TcpStream::connect("127.0.0.1:22").is_err(), "BREACH: connects");
        assert!(UdpSocket::bind("127.0.0.1:0").is_err(), "BREACH: UDP");
        assert!("localhost:80".to_socket_addrs().is_err(), "BREACH: looks up names");
        if let Err(error) = TcpStream::connect("127.0.0.1:1") {
            assert!(error.kind() == std::io::ErrorKind::PermissionDenied, "BREACH: {error}");
        }
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {
        Rgb::BLACK
    }
}
