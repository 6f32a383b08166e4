//! The camera.

use arty::camera::CameraDescription;
use arty::diagnostic::Diagnostic;
use arty::math::Vec3;
use glam::{DMat4, DVec3};
use gltf::camera::Projection;

use crate::document::{Document, named};
use crate::left_out::LeftOut;

/// Width of the image in pixels; the height follows from the camera.
const WIDTH: u32 = 512;

/// The renderer's own proportions, for cameras that do not say theirs.
const ASPECT: f64 = 512.0 / 412.0;

/// A camera and the size of its image in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    pub(crate) camera: CameraDescription,
    pub(crate) size: [u32; 2],
}

/// Converts a camera; `None` if it is orthographic.
///
/// # Errors
/// If its field of view is not valid.
pub(crate) fn convert(
    document: &Document,
    camera: &gltf::Camera<'_>,
    to_world: &DMat4,
    left_out: &mut LeftOut,
) -> Result<Option<View>, Diagnostic> {
    let item = named("camera", camera.name(), camera.index());
    let Projection::Perspective(perspective) = camera.projection() else {
        left_out.add(format!("{item}: it is orthographic"));
        return Ok(None);
    };
    let aspect = perspective.aspect_ratio().map_or(ASPECT, f64::from);
    let half = 0.5 * f64::from(perspective.yfov());
    if !(aspect.is_finite() && aspect > 0.0 && half > 0.0 && half < std::f64::consts::FRAC_PI_2) {
        return Err(document.error(&item, "its field of view or aspect ratio is not valid"));
    }
    let eye = to_world.transform_point3(DVec3::ZERO);
    let direction = |axis: DVec3| to_world.transform_vector3(axis).try_normalize();
    let axes = direction(DVec3::NEG_Z).zip(direction(DVec3::Y));
    let (forward, up) = axes
        .filter(|(forward, up)| eye.is_finite() && forward.cross(*up).length() > 1e-4)
        .ok_or_else(|| document.error(&item, "its transform has no direction of view"))?;
    let fov = (2.0 * (aspect * half.tan()).atan()).to_degrees() as f32;
    let camera = CameraDescription {
        eye: eye.as_vec3(),
        // As far away as the scene's own numbers are large, so that rounding turns it as little as possible.
        center: (eye + forward * (1.0 + eye.length())).as_vec3(),
        up: up.as_vec3(),
        fov,
    };
    let height = (f64::from(WIDTH) / aspect).round().clamp(1.0, 65536.0) as u32;
    Ok(Some(View { camera, size: [WIDTH, height] }))
}

/// A camera in front of everything, for files without one.
pub(crate) fn in_front_of(points: impl Iterator<Item = [f32; 3]>) -> View {
    let (mut low, mut high) = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    for point in points.map(Vec3::from_array) {
        (low, high) = (low.min(point), high.max(point));
    }
    if !low.is_finite() || !high.is_finite() {
        (low, high) = (Vec3::NEG_ONE, Vec3::ONE);
    }
    let (center, radius) = (0.5 * (low + high), (0.5 * (high - low).length()).max(1e-3));
    let eye = center + Vec3::new(0.5, 0.4, 1.0).normalize() * radius * 3.0;
    let camera = CameraDescription { eye, center, up: Vec3::Y, fov: 45.0 };
    View { camera, size: [WIDTH, (f64::from(WIDTH) / ASPECT).round() as u32] }
}
