//! The camera.

use serde::{Deserialize, Serialize};

use crate::math::{Vec3, direction_and_distance};
use crate::ray::Ray;

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraDescription {
    /// Position of the pinhole, in world space.
    pub eye: Vec3,
    /// The point shown in the centre of the image.
    pub center: Vec3,
    /// The up direction; need be neither a unit vector nor perpendicular to the view direction.
    pub up: Vec3,
    /// Horizontal field of view, in degrees.
    pub fov: f32,
}

/// A pinhole camera for an image of a given size, with a box filter of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    eye: Vec3,
    /// Vector to the upper left corner of the image on the plane at distance 1.
    corner: Vec3,
    /// Vector from one pixel to the next on its right, on that plane.
    right: Vec3,
    /// Vector from one pixel to the next below it, on that plane.
    down: Vec3,
}

impl Camera {
    /// A camera for images of `width × height` square pixels. The field of view is horizontal.
    pub fn new(description: &CameraDescription, width: u32, height: u32) -> Self {
        let CameraDescription { eye, center, up, fov } = *description;
        let forward = direction_and_distance(eye, center).0;
        // Both are unit vectors, so that their product cannot overflow or underflow for any length of `up`.
        let right =
            direction_and_distance(Vec3::ZERO, forward.cross(direction_and_distance(Vec3::ZERO, up).0)).0;
        let down = forward.cross(right);
        let half_width = (0.5 * fov).to_radians().tan();
        let pixel = 2.0 * half_width / width as f32;
        let corner = forward - half_width * right - 0.5 * pixel * height as f32 * down;
        Self { eye, corner, right: pixel * right, down: pixel * down }
    }

    /// The ray through pixel (x, y), counted from the upper left, at the position (u, v) in [0, 1)² within the pixel.
    #[inline]
    pub fn ray(&self, x: u32, y: u32, (u, v): (f32, f32)) -> Ray {
        let on_plane = self.corner + (x as f32 + u) * self.right + (y as f32 + v) * self.down;
        Ray::new(self.eye, on_plane.normalize())
    }

    /// Where a point (world space) appears: column, row and depth. The inverse of [`ray`](Self::ray).
    ///
    /// The depth is the distance from the pinhole along the view direction; where it is not positive, the point is not in
    /// front of the camera, and column and row mean nothing.
    pub fn project(&self, point: Vec3) -> Vec3 {
        let forward = direction_and_distance(Vec3::ZERO, self.right.cross(self.down)).0;
        let from_eye = point - self.eye;
        let depth = from_eye.dot(forward);
        let on_plane = from_eye / depth - self.corner;
        let along = |axis: Vec3| on_plane.dot(axis) / axis.length_squared();
        Vec3::new(along(self.right), along(self.down), depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_of_view_is_horizontal_and_pixels_are_square() {
        let description = CameraDescription {
            eye: Vec3::new(1.0, 2.0, 3.0),
            center: Vec3::new(1.0, 2.0, 0.0),
            up: Vec3::Y,
            fov: 90.0,
        };
        let camera = Camera::new(&description, 200, 100);
        let middle = camera.ray(100, 50, (0.0, 0.0));
        assert_eq!(middle.origin, description.eye);
        assert!((middle.direction - Vec3::NEG_Z).length() < 1e-6);
        let left = camera.ray(0, 50, (0.0, 0.0)).direction;
        assert!((left - Vec3::new(-1.0, 0.0, -1.0).normalize()).length() < 1e-6, "45° to the left: {left}");
        let top = camera.ray(100, 0, (0.0, 0.0)).direction;
        assert!((top - Vec3::new(0.0, 0.5, -1.0).normalize()).length() < 1e-6, "half as high as wide: {top}");
    }

    #[test]
    fn a_point_appears_where_its_ray_starts() {
        let description = CameraDescription {
            eye: Vec3::new(1.0, 2.0, 3.0),
            center: Vec3::new(-1.0, 0.5, 0.0),
            up: Vec3::new(0.1, 2.0, 0.3),
            fov: 55.0,
        };
        let camera = Camera::new(&description, 64, 48);
        for (x, y) in [(0, 0), (63, 0), (31, 24), (5, 47)] {
            let ray = camera.ray(x, y, (0.25, 0.75));
            let seen = camera.project(ray.origin + 7.0 * ray.direction);
            assert!(
                (seen.x - x as f32 - 0.25).abs() < 1e-3 && (seen.y - y as f32 - 0.75).abs() < 1e-3,
                "{seen}"
            );
            assert!(seen.z > 0.0 && seen.z <= 7.0, "{seen}");
            assert!(camera.project(ray.origin - 7.0 * ray.direction).z < 0.0, "behind the camera");
        }
    }
}
