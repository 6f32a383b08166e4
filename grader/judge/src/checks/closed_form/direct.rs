//! Direct light from point lights, from polygons that are fully visible or fully invisible, and from an environment that
//! nothing occludes.

use std::f64::consts::PI;

use arty::math::Vec3;
use arty::scene::{Hit, LightDescription, SceneDescription};
use glam::DVec3;

use super::pixels::Pixels;
use super::polygon;
use super::sky::Sky;
use crate::checks::SceneWithReference;
use verdict::check::WhyNot;
use verdict::rubric::EmissionOnHit;

/// A light with a closed form.
enum DirectLight {
    /// A point light of intensity I = Φ / 4π: E = I cos θ / d².
    Point { position: Vec3, intensity: [f64; 3] },
    /// A triangle that emits from its front side.
    Triangle { corners: [DVec3; 3], radiance: [f64; 3] },
}

/// Maximum number of lights in a scene with a closed form.
const MAX_LIGHTS: usize = 64;

/// Radiance of each pixel, without visible lights if emission on hit is off.
pub(super) fn picture(
    scene: &SceneWithReference,
    emission_on_hit: EmissionOnHit,
    rays: u32,
) -> Result<Pixels, WhyNot> {
    let lights = lights(&scene.description)?;
    if lights.len() > MAX_LIGHTS {
        return Err(WhyNot::ManyLights(lights.len()));
    }
    let mut sky = scene.scene.environment().map(|environment| Sky::new(environment, &scene.description));
    Pixels::integrate(&scene.scene, rays, |ray| {
        let Some(hit) = scene.scene.intersect(ray) else {
            return Ok(sky.as_ref().map_or([0.0; 3], |sky| sky.seen(ray.direction)));
        };
        let emission = hit.emission().filter(|_| emission_on_hit == EmissionOnHit::On);
        let emitted = emission.map_or([0.0; 3], |emission| emission.radiance.to_array().map(f64::from));
        // The BSDF of a diffuse surface is constant: f = ρ / π.
        let reflected = hit.bsdf().eval(hit.normal).to_array().map(f64::from);
        let mut radiance = emitted;
        if reflected != [0.0; 3] {
            for light in &lights {
                let irradiance = light.irradiance(scene, &hit)?;
                (0..3).for_each(|channel| radiance[channel] += reflected[channel] * irradiance[channel]);
            }
            if let Some(sky) = &mut sky {
                let irradiance = sky.irradiance(&hit)?;
                (0..3).for_each(|channel| radiance[channel] += reflected[channel] * irradiance[channel]);
            }
        }
        Ok(radiance)
    })
}

fn lights(description: &SceneDescription) -> Result<Vec<DirectLight>, WhyNot> {
    let mut lights = Vec::new();
    for light in &description.lights {
        lights.push(match *light {
            LightDescription::Point { position, power } => {
                let intensity = power.to_array().map(|power| f64::from(power) / (4.0 * PI));
                DirectLight::Point { position, intensity }
            }
            LightDescription::Triangle { vertices, radiance } => DirectLight::Triangle {
                corners: vertices.map(Vec3::as_dvec3),
                radiance: radiance.to_array().map(f64::from),
            },
            LightDescription::Spot { .. } => return Err(WhyNot::SpotLight),
        });
    }
    for mesh in &description.meshes {
        for triangle in &mesh.triangles {
            let radiance = description.materials[triangle.material as usize].emission;
            if !radiance.is_black() {
                let corners = triangle.positions.map(|corner| mesh.positions[corner as usize].as_dvec3());
                lights.push(DirectLight::Triangle { corners, radiance: radiance.to_array().map(f64::from) });
            }
        }
    }
    Ok(lights)
}

impl DirectLight {
    fn irradiance(&self, scene: &SceneWithReference, hit: &Hit<'_>) -> Result<[f64; 3], WhyNot> {
        let (point, normal) = (hit.point.as_dvec3(), hit.normal.as_dvec3());
        match self {
            Self::Point { position, intensity } => {
                let to_light = position.as_dvec3() - point;
                let cos = normal.dot(to_light.normalize());
                if cos <= 0.0 || scene.scene.occluded(hit, *position) {
                    return Ok([0.0; 3]);
                }
                Ok(intensity.map(|intensity| intensity * cos / to_light.length_squared()))
            }
            Self::Triangle { corners, radiance } => {
                let [a, b, c] = *corners;
                let faces = (b - a).cross(c - a).dot(point - a) > 0.0;
                let form = polygon::irradiance(point, normal, corners);
                if !faces || form <= 0.0 {
                    return Ok([0.0; 3]);
                }
                let inside = (a + b + c) / 3.0;
                for place in
                    [inside, 0.98 * a + 0.02 * inside, 0.98 * b + 0.02 * inside, 0.98 * c + 0.02 * inside]
                {
                    let above = normal.dot(place - point) > 0.0;
                    if above && scene.scene.occluded(hit, place.as_vec3()) {
                        return Err(WhyNot::PartlyHidden);
                    }
                }
                Ok(radiance.map(|radiance| radiance * form))
            }
        }
    }
}
