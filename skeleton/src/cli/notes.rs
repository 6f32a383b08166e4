//! Notes and warnings about an image.

use std::path::Path;

use super::Algorithm;
use super::numbers::counted;
use super::plan::Plan;
use super::session::Rendering;
use crate::film::Anomalies;
use crate::integrator::{Settings, Technique};
use crate::sampler::{SamplerKind, Streams};
use crate::scene::Features;

/// What can be told before rendering.
pub(super) fn before(algorithm: &Algorithm, features: &Features) -> Option<String> {
    let Algorithm::PathTracer(Settings { technique, .. }) = algorithm else { return None };
    if !features.has_lights() && !features.environment {
        return Some("the scene has no lights: the image will be black".to_owned());
    }
    if *technique != Technique::Bsdf || features.point_lights == 0 {
        return None;
    }
    let consequence = match features.area_lights {
        0 if !features.environment => "the image will be black".to_owned(),
        _ => format!("{} will be missing", counted(features.point_lights as u64, "point light")),
    };
    Some(format!("BSDF sampling never finds a point light, so {consequence}: use --technique=nee"))
}

/// What can be told from the finished image.
pub(super) fn after(algorithm: &Algorithm, features: &Features, rendering: &Rendering) -> Option<String> {
    if !matches!(algorithm, Algorithm::PathTracer(_)) || before(algorithm, features).is_some() {
        return None;
    }
    let is_black = rendering.film.pixels().iter().all(|pixel| pixel.sum == [0.0; 3]);
    let lights = match features.area_lights + features.point_lights {
        0 => "an environment".to_owned(),
        lights => counted(lights as u64, "light"),
    };
    is_black.then(|| format!("the image is black: no sample found light, although the scene has {lights}"))
}

/// A warning about samples that are not finite or negative.
pub(super) fn anomalies(anomalies: &Anomalies) -> Option<String> {
    let first = anomalies.first.first()?;
    let kinds =
        [(anomalies.non_finite, "NaN or infinite (counted as black)"), (anomalies.negative, "negative")];
    let kinds: Vec<String> = kinds
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, kind)| {
            format!(
                "{} {kind}",
                if count == 1 { "1 sample is".into() } else { format!("{count} samples are") }
            )
        })
        .collect();
    let value = first.value.to_array();
    // Where it stands, so that editors and terminals turn it into a link.
    let since = first.sum.map_or(String::new(), |sum| {
        format!("; the first sum that is NaN or infinite is in {}:{}", sum.file(), sum.line())
    });
    Some(format!(
        "{}; the first is sample {} of pixel ({}, {}): {value:?}{since}",
        kinds.join(", "),
        first.sample,
        first.x,
        first.y
    ))
}

/// The command that follows the path of the first such sample, where there is one: scenes are replayed by name.
pub(super) fn replay(anomalies: &Anomalies, scene: &Path, plan: &Plan) -> Option<String> {
    let first = anomalies.first.first()?;
    let Algorithm::PathTracer(Settings { technique, max_bounces }) = plan.algorithm else { return None };
    let name = scene.file_stem()?.to_str()?;
    let folder = scene.parent()?.file_name()?;
    if folder != "scenes" && folder != "extreme" {
        return None;
    }
    // The grader traces paths with independent numbers only.
    let Plan { width, height, streams: Streams { seed, kind: SamplerKind::Independent }, .. } = plan else {
        return None;
    };
    Some(format!(
        "replay: cargo grader replay --scene={name} --technique={technique} --max-bounces={max_bounces} --seed={seed} \
         --size={width}x{height} --pixel={},{} --sample={}",
        first.x, first.y, first.sample
    ))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::cli::DebugView;
    use crate::film::{Anomaly, Film};
    use crate::math::Rgb;

    fn features(area_lights: usize, point_lights: usize) -> Features {
        Features {
            triangles: 10,
            area_lights,
            point_lights,
            environment: false,
            delta_surfaces: 0,
            glossy_surfaces: 0,
            lit_surfaces: 0,
            textured_surfaces: 0,
            smooth_surfaces: 0,
            closed: false,
            hierarchy: false,
        }
    }

    fn path_tracer(technique: Technique) -> Algorithm {
        Algorithm::PathTracer(Settings { technique, max_bounces: 8 })
    }

    #[test]
    fn bsdf_sampling_with_point_lights_gives_a_note() {
        let bsdf = path_tracer(Technique::Bsdf);
        let note = |area_lights, point_lights| before(&bsdf, &features(area_lights, point_lights));
        assert!(note(0, 1).expect("a note").contains("black: use --technique=nee"));
        assert!(note(2, 1).expect("a note").contains("1 point light will be missing"));
        assert_eq!(note(2, 0), None);
        assert_eq!(before(&path_tracer(Technique::Nee), &features(0, 1)), None);
    }

    #[test]
    fn a_scene_without_lights_gives_a_note() {
        for technique in Technique::ALL {
            let note = before(&path_tracer(technique), &features(0, 0));
            assert!(note.expect("a note").contains("no lights"));
        }
        assert_eq!(before(&Algorithm::Debug(DebugView::Normals), &features(0, 0)), None);
    }

    #[test]
    fn a_black_image_is_noted_once() {
        let film = Film::new(2, 2);
        let black = Rendering { film, elapsed: Duration::from_secs(1), interrupted: false };
        let note = |technique| after(&path_tracer(technique), &features(0, 1), &black);
        assert!(note(Technique::Nee).expect("a note").contains("the scene has 1 light"));
        assert_eq!(note(Technique::Bsdf), None, "this was noted before rendering");
    }

    #[test]
    fn anomalies_are_counted_and_the_first_is_located() {
        assert_eq!(anomalies(&Anomalies::default()), None);
        let first = vec![Anomaly { x: 3, y: 4, sample: 7, value: Rgb::new(f32::NAN, 0.5, -1.0), sum: None }];
        let text = anomalies(&Anomalies { non_finite: 1, negative: 12, first }).expect("a warning");
        assert_eq!(
            text,
            "1 sample is NaN or infinite (counted as black), 12 samples are negative; the first is sample 7 of pixel \
             (3, 4): [NaN, 0.5, -1.0]"
        );
    }
}
