//! **closed-form**: pictures whose every pixel has a formula. No reference has a say in them; only the noise that is
//! normal comes from one.

mod direct;
mod pixels;
mod planes;
mod polygon;

use arty::scene::{SceneDescription, Specular};

use super::means::{self, Picture};
use super::{Bench, JudgedScene, Stop, mean_bias};
use pixels::{Pixels, RAYS};
use verdict::error::Error;
use verdict::report::CheckResult;
use verdict::rubric::{CheckSpec, Hits};

/// Rays for each pixel that show whether there is a closed form.
const A_FEW: u32 = 2;

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let judged = bench.scene(spec);
    let pixels = answer(judged, spec.max_bounces, spec.hits, RAYS).map_err(|why| {
        Error::Input(format!("closed-form in `{}` with {} bounces: {why}", spec.scene, spec.max_bounces))
    })?;
    let mut expected = mean_bias::expected(spec, &judged.reference)?;
    expected.mean = pixels.mean;
    expected.error = pixels.error;
    means::run(bench, spec, &Picture::of(bench, spec, &[&judged.description], &expected), result)
}

/// Why a scene has no closed form with that many bounces; `None` if it has one.
pub fn why_no_closed_form(judged: &JudgedScene, max_bounces: u32) -> Option<String> {
    answer(judged, max_bounces, Hits::On, A_FEW).err()
}

/// What each pixel should be, or why nobody knows.
fn answer(judged: &JudgedScene, max_bounces: u32, hits: Hits, rays: u32) -> Result<Pixels, String> {
    if !only_flat_diffuse(&judged.description) {
        return Err("there is more than flat, diffuse, plainly coloured surfaces".to_owned());
    }
    if hits == Hits::On
        && let Some(planes) = planes::recognise(&judged.description)
    {
        return planes.picture(&judged.scene, max_bounces, rays);
    }
    if max_bounces != 1 {
        return Err("only light that is scattered once has a closed form".to_owned());
    }
    direct::picture(judged, hits, rays)
}

fn only_flat_diffuse(description: &SceneDescription) -> bool {
    let flat = |mesh: &arty::scene::Mesh| mesh.triangles.iter().all(|triangle| triangle.normals.is_none());
    let plain = |material: &arty::scene::Material| {
        material.specular == Specular::None && material.diffuse_map.is_none()
    };
    description.meshes.iter().all(flat) && description.materials.iter().all(plain)
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::judged;
    use super::*;

    /// The references are rendered, the closed forms are not: they agree to within the noise of the one and the
    /// quadrature of the other. Of 7 · 768 deviates one is beyond 6 in one of 90,000 sets of references.
    #[test]
    fn closed_forms_agree_with_references() {
        for (name, max_bounces) in [
            ("point_plane", 1),
            ("area_plane", 1),
            ("polygon_plane", 1),
            ("four_lights", 1),
            ("three_points", 1),
            ("point_grid", 1),
            ("parallel_planes", 8),
        ] {
            let judged = judged(name);
            let pixels =
                answer(&judged, max_bounces, Hits::On, RAYS).unwrap_or_else(|why| panic!("{name}: {why}"));
            let view = verdict::rubric::View { max_bounces, hits: Hits::On };
            let rendered = &judged.reference.views[&view];
            let brightest = rendered.mean.iter().flatten().fold(0.0, |most: f64, &mean| most.max(mean));
            for (pixel, exact) in pixels.mean.iter().enumerate() {
                for channel in 0..3 {
                    let (exact, seen) = (exact[channel], rendered.mean[pixel][channel]);
                    let noise =
                        rendered.variance_of_mean[pixel][channel].sqrt().hypot(pixels.error[pixel][channel]);
                    assert!(
                        // Where light only just comes over an edge, rounding decides: a ten thousandth of the picture.
                        (exact - seen).abs() <= 6.0 * noise + 2e-3 * exact + 1e-4 * brightest,
                        "{name}, pixel {pixel}: {seen} instead of {exact} (± {noise})"
                    );
                }
            }
        }
    }

    #[test]
    fn other_scenes_have_none_and_say_why() {
        for (name, max_bounces, expected) in [
            ("point_plane", 2, "scattered once"),
            ("cornell_box", 1, "partly hidden"),
            ("cornell_box_glossy", 1, "more than flat, diffuse"),
        ] {
            let why = why_no_closed_form(&judged(name), max_bounces).expect(name);
            assert!(why.contains(expected), "{name}: {why}");
        }
    }
}
