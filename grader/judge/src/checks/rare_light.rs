//! How often BSDF sampling finds a light, which limits what its images can tell.
//!
//! Where one bounce in a thousand hits a light, an image of a few samples per pixel is black in most pixels and very bright
//! in some. Its mean is right, but no statistic of these samples can say so: the few bright ones that decide are missing
//! from the estimate of the variance, too. A check of such an image would call the solution wrong.

use arty::integrator::Technique;
use arty::sampler::Sampler;
use arty::scene::Scene;
use verdict::check::WhyNot;
use verdict::rubric::CheckSpec;

/// Minimum share of bounces that hit a light.
const NEEDED: f64 = 0.02;

/// Width and height in pixels, and camera rays per pixel, of the measurement.
const SIZE: u32 = 16;
const RAYS: u64 = 8;

/// Refuses checks of the mean of BSDF sampling in scenes where it rarely finds a light.
///
/// # Errors
/// The share of bounces that hit a light, if it is too small.
pub(super) fn require(scene: &Scene, spec: &CheckSpec) -> Result<(), WhyNot> {
    if spec.technique != Technique::Bsdf || spec.max_bounces == 0 {
        return Ok(());
    }
    let share = share_of_lit_bounces(scene);
    if share < NEEDED { Err(WhyNot::BsdfFindsLittle { share, needed: NEEDED }) } else { Ok(()) }
}

/// The share of BSDF samples at what the camera sees that hit a light.
fn share_of_lit_bounces(place: &Scene) -> f64 {
    let camera = place.camera(SIZE, SIZE);
    let (mut bounces, mut lit) = (0_u32, 0_u32);
    for (pixel, ray) in (0..SIZE * SIZE).flat_map(|pixel| (0..RAYS).map(move |ray| (pixel, ray))) {
        let (x, y) = (pixel % SIZE, pixel / SIZE);
        let mut sampler = Sampler::new(1, (x, y), ray);
        let seen = place.intersect(&camera.ray(x, y, sampler.next_2d()));
        let Some(next) = seen.and_then(|hit| Some(hit.spawn(hit.bsdf().sample(&mut sampler)?.wi))) else {
            continue;
        };
        bounces += 1;
        let found = match place.intersect(&next) {
            Some(hit) => hit.emission().map(|light| light.radiance),
            None => place.environment().map(|environment| environment.radiance(next.direction)),
        };
        lit += u32::from(found.is_some_and(|radiance| !radiance.is_black()));
    }
    f64::from(lit) / f64::from(bounces.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    use harness::workspace::Workspace;
    use verdict::check::CheckKind;

    fn refused(name: &str, technique: Technique, max_bounces: u32) -> bool {
        let file = Workspace::find().expect("the tests run inside the checkout").scene_file(name);
        let scene = Scene::new(&arty::scene::file::load(&file).expect("it is there").description);
        require(&scene, &CheckSpec::new(CheckKind::MeanBias, technique, max_bounces)).is_err()
    }

    #[test]
    fn a_small_light_is_refused_for_bsdf_sampling_alone() {
        assert!(refused("cornell_box", Technique::Bsdf, 1));
        assert!(!refused("cornell_box", Technique::Bsdf, 0), "emission only");
        assert!(!refused("cornell_box", Technique::Mis, 1));
        for name in ["glossy_plane", "furnace_cap", "furnace_glossy", "parallel_planes"] {
            assert!(!refused(name, Technique::Bsdf, 1), "{name}");
        }
    }
}
