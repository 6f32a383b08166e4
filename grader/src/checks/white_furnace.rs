//! **white-furnace**: inside of a closed surface that emits the same radiance L_e everywhere and reflects a share ρ
//! diffusely, the radiance after up to k bounces is the same in every direction:
//!
//! L = L_e (1 + ρ + … + ρᵏ)
//!
//! No reference has a say in that; only the noise that is normal comes from one.

use arty::scene::Specular;

use super::JudgedScene;
use crate::error::{Error, Result};
use crate::rubric::CheckSpec;
use crate::statistics::bias::Expected;

/// The closed form for the scene's furnace.
pub(super) fn expected(spec: &CheckSpec, judged: &JudgedScene) -> Result<Expected> {
    let Some(furnace) = furnace(judged) else {
        return Err(Error::Input(format!(
            "white-furnace needs a closed scene of one diffuse emitting material around the camera, and `{}` is none",
            spec.scene
        )));
    };
    let exact = std::array::from_fn(|channel| furnace.radiance(channel, spec.max_bounces));
    let mut expected = super::mean_bias::expected(spec, &judged.reference)?;
    expected.mean.fill(exact);
    expected.variance_of_mean.fill([0.0; 3]);
    Ok(expected)
}

struct Furnace {
    emission: [f32; 3],
    albedo: [f32; 3],
}

impl Furnace {
    fn radiance(&self, channel: usize, max_bounces: u32) -> f64 {
        let (emission, albedo) = (f64::from(self.emission[channel]), f64::from(self.albedo[channel]));
        (0..=max_bounces).map(|bounce| emission * albedo.powi(bounce as i32)).sum()
    }
}

/// True if the scene is a furnace.
pub fn is_furnace(judged: &JudgedScene) -> bool {
    furnace(judged).is_some()
}

/// The furnace's material, if all surfaces have it and the camera is enclosed.
fn furnace(judged: &JudgedScene) -> Option<Furnace> {
    let JudgedScene { description, scene, .. } = judged;
    let mut materials =
        description.meshes.iter().flat_map(|mesh| &mesh.triangles).map(|triangle| triangle.material);
    let first = materials.next()?;
    let material = description.materials.get(first as usize)?;
    let uniform = scene.features().closed
        && materials.all(|other| other == first)
        && description.lights.is_empty()
        && material.specular == Specular::None
        && material.diffuse_map.is_none()
        && !material.emission.is_black();
    uniform.then(|| Furnace { emission: material.emission.to_array(), albedo: material.diffuse.to_array() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_approaches_its_limit() {
        let furnace = Furnace { emission: [0.5, 1.0, 0.0], albedo: [0.5, 0.0, 0.9] };
        assert_eq!(furnace.radiance(0, 0), 0.5);
        assert_eq!(furnace.radiance(0, 1), 0.75);
        assert!((furnace.radiance(0, 60) - 1.0).abs() < 1e-12, "L_e / (1 - ρ)");
        assert_eq!(furnace.radiance(1, 8), 1.0);
        assert_eq!(furnace.radiance(2, 8), 0.0);
    }
}
