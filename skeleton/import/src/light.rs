//! Point and spot lights.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use arty::diagnostic::Diagnostic;
use arty::math::{Rgb, Vec3};
use arty::scene::LightDescription;
use glam::{DMat4, DVec3};
use gltf::khr_lights_punctual::{Kind, Light};

use crate::document::{Document, named};
use crate::left_out::LeftOut;

/// Converts a light; `None` if it is directional.
///
/// Intensities are in candela there, powers in watts here: `lumens_per_watt` converts between the two.
///
/// # Errors
/// If its values are not valid.
pub(crate) fn convert(
    document: &Document,
    light: &Light<'_>,
    to_world: &DMat4,
    lumens_per_watt: f64,
    left_out: &mut LeftOut,
) -> Result<Option<LightDescription>, Diagnostic> {
    let item = named("light", light.name(), light.index());
    let position = to_world.transform_point3(DVec3::ZERO).as_vec3();
    let power = |solid_angle: f64| {
        let watts = f64::from(light.intensity()) / lumens_per_watt * solid_angle;
        let power = Rgb::from(light.color().map(|channel| (f64::from(channel) * watts) as f32));
        let is_valid = power.is_finite() && power.min_channel() >= 0.0 && position.is_finite();
        is_valid.then_some(power).ok_or_else(|| document.error(&item, "its color or intensity is not valid"))
    };
    left_out.add_if(light.range().is_some(), || format!("{item}: its range; its light reaches any distance"));
    match light.kind() {
        Kind::Directional => {
            left_out.add(format!("{item}: it is directional, such as a sun"));
            Ok(None)
        }
        Kind::Point => Ok(Some(LightDescription::Point { position, power: power(4.0 * PI)? })),
        Kind::Spot { inner_cone_angle, outer_cone_angle } => {
            let (inner, outer) = (f64::from(inner_cone_angle), f64::from(outer_cone_angle));
            // A little more than a right angle, which in single precision is not exactly that.
            if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= FRAC_PI_2 + 1e-6) {
                let problem = format!("its cone from {inner} to {outer} is not valid");
                return Err(document.error(&item, problem));
            }
            let direction = to_world.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
            if direction == Vec3::ZERO {
                return Err(document.error(&item, "its transform has no direction"));
            }
            Ok(Some(LightDescription::Spot {
                position,
                direction,
                inner: inner.to_degrees() as f32,
                outer: (outer.to_degrees() as f32).min(90.0),
                // The solid angle with the same power at full intensity: see `arty`'s spot light.
                power: power(TAU * (1.0 - 0.5 * (inner.cos() + outer.cos())))?,
            }))
        }
    }
}
