//! The camera.

mod common;

use arty::camera::Camera;
use arty::math::Vec3;
use arty::scene::CameraDescription;

fn description(eye: Vec3, center: Vec3, up: Vec3) -> CameraDescription {
    CameraDescription { eye, center, up, fov: 50.0 }
}

#[test]
fn the_centre_is_in_the_middle_of_the_image_and_up_is_up() {
    for (eye, center, up) in [
        (Vec3::ZERO, Vec3::NEG_Z, Vec3::Y),
        (Vec3::new(1.0, -2.0, 3.0), Vec3::new(-4.0, 5.0, 6.0), Vec3::new(1.0, 1.0, 0.0)),
        (Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO, Vec3::new(0.0, 1.0, -1e-3)),
    ] {
        let camera = Camera::new(&description(eye, center, up), 30, 20);
        let forward = (center - eye).normalize();
        let at = |x: u32, y: u32| camera.ray(x, y, (0.0, 0.0)).direction;
        assert!((at(15, 10) - forward).length() < 1e-6);
        let (up_in_image, right) = (at(15, 0) - at(15, 20), at(30, 10) - at(0, 10));
        assert!(up_in_image.dot(up) > 0.0 && up_in_image.dot(forward).abs() < 1e-6);
        assert!(right.dot(up).abs() < 1e-5 && right.dot(forward).abs() < 1e-6);
        // Right-handed: right × up points back to the viewer.
        assert!(right.cross(up_in_image).dot(forward) < 0.0);
    }
}

#[test]
fn the_length_of_up_has_no_effect() {
    let ray = |length: f32| {
        let up = length * Vec3::new(0.2, 1.0, 0.1);
        Camera::new(&description(Vec3::ONE, Vec3::ZERO, up), 8, 6).ray(1, 2, (0.3, 0.4)).direction
    };
    for length in [1e-37, 1e-25, 1e-10, 1e10, 1e25, 1e37] {
        assert!((ray(length) - ray(1.0)).length() < 1e-6, "{length}: {}", ray(length));
    }
}

#[test]
fn pixels_are_square_and_adjacent() {
    let camera = Camera::new(&description(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y), 31, 17);
    let on_plane = |x, y, place| {
        let direction = camera.ray(x, y, place).direction;
        assert!((direction.length() - 1.0).abs() < 1e-6);
        direction / -direction.z
    };
    let pixel = 2.0 * 25f32.to_radians().tan() / 31.0;
    for (x, y) in [(0, 0), (30, 16), (7, 3)] {
        let corner = on_plane(x, y, (0.0, 0.0));
        assert!((on_plane(x, y, (1.0, 1.0)) - corner - Vec3::new(pixel, -pixel, 0.0)).length() < 1e-6);
        assert!((on_plane(x + 1, y, (0.0, 0.5)) - on_plane(x, y, (1.0, 0.5))).length() < 1e-6);
    }
    assert!((on_plane(0, 0, (0.0, 0.0)) + on_plane(30, 16, (1.0, 1.0)) + 2.0 * Vec3::Z).length() < 1e-6);
}
