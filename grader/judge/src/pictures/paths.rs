//! Paths of one pixel as lines over the picture, from recorded calls.
//!
//! Nothing is known about the code that made the calls: it may skip some, repeat them, or make them in another order.

use arty::camera::Camera;
use arty::integrator::Settings;
use glam::Vec3;
use harness::host_process::HostProcess;
use harness::job::apart;
use host::protocol::{Call, ReplayJob};
use verdict::error::Result;
use verdict::pictures::{DrawnPath, PathLine, Picture, PixelPaths, RayKind};

/// Maximum number of lines of a path.
const MAX_LINES: usize = 128;

/// Computes the samples of a pixel that a picture averages once more, and records them. `None` if the submission fails.
///
/// # Errors
/// If the grader itself fails.
pub(super) fn record(
    process: &mut HostProcess,
    scene: u32,
    settings: Settings,
    picture: &Picture,
    camera: &Camera,
    pixel: [u32; 2],
) -> Result<Option<PixelPaths>> {
    let size = [picture.width as u32, picture.height as u32];
    let mut samples = Vec::new();
    for &seed in &picture.seeds {
        for sample in 0..picture.samples {
            let job = ReplayJob { scene, settings, size, seed, pixel, sample };
            let Ok(replayed) = apart(process.replay(job))? else { return Ok(None) };
            samples.push(DrawnPath { radiance: replayed.radiance, lines: lines(&replayed.calls, camera) });
        }
    }
    Ok(Some(PixelPaths { pixel, samples }))
}

/// The rays of a path as they appear in the picture, without the first one.
fn lines(calls: &[Call], camera: &Camera) -> Vec<PathLine> {
    let mut walk = Walk { camera, lines: Vec::new(), here: None, bounce: None, open: None, length: 1.0 };
    calls.iter().for_each(|call| walk.take(call));
    walk.close_sample();
    walk.lines.truncate(MAX_LINES);
    walk.lines
}

/// A point on a light that was sampled, and no shadow ray is known yet.
struct OpenSample {
    from: Vec3,
    point: Vec3,
    light: Option<f32>,
}

struct Walk<'a> {
    camera: &'a Camera,
    lines: Vec<PathLine>,
    /// The last hit point of the path.
    here: Option<Vec3>,
    /// Direction of the last BSDF sample.
    bounce: Option<Vec3>,
    open: Option<OpenSample>,
    /// Length of rays that hit nothing.
    length: f32,
}

impl Walk<'_> {
    fn take(&mut self, call: &Call) {
        match call.function.as_str() {
            "Scene::intersect" => self.intersect(call),
            "Light::sample_direct" => {
                self.close_sample();
                if let (Some(from), Some(point)) = (vector(&call.given, "from"), vector(&call.got, "point")) {
                    self.open = Some(OpenSample { from, point, light: number(&call.given, "light") });
                }
            }
            "Scene::occluded" => {
                if let (Some(from), Some(point)) = (vector(&call.given, "from"), vector(&call.given, "point"))
                {
                    self.shadow_ray(from, point, number(&call.got, "occluded") == Some(0.0));
                }
            }
            "Scene::occluded_towards" => {
                if let (Some(from), Some(to)) =
                    (vector(&call.given, "from"), vector(&call.given, "direction"))
                {
                    let arrives = number(&call.got, "occluded") == Some(0.0);
                    self.shadow_ray(from, from + self.length * to, arrives);
                }
            }
            "Bsdf::sample" => self.bounce = vector(&call.got, "wi"),
            _ => {}
        }
    }

    fn intersect(&mut self, call: &Call) {
        let (Some(origin), Some(direction)) =
            (vector(&call.given, "origin"), vector(&call.given, "direction"))
        else {
            return;
        };
        let hit = vector(&call.got, "point");
        let Some(here) = self.here else {
            if let Some(hit) = hit {
                self.length = 0.3 * origin.distance(hit);
            }
            self.here = hit;
            return;
        };
        if self.bounce.is_some_and(|bounce| bounce.dot(direction) > 0.99999) {
            self.close_sample();
            self.line(RayKind::Bounce, here, hit.unwrap_or(origin + self.length * direction));
            (self.here, self.bounce) = (hit.or(self.here), None);
        } else if let Some(OpenSample { from, point, light }) = self.open.take() {
            // A shadow ray that looks at what it hits.
            let arrives = light.is_some() && number(&call.got, "light") == light;
            self.shadow_ray(from, point, arrives);
        }
    }

    fn shadow_ray(&mut self, from: Vec3, to: Vec3, arrives: bool) {
        self.open = None;
        self.line(if arrives { RayKind::Arrives } else { RayKind::Blocked }, from, to);
    }

    /// A light sample that no shadow ray belongs to.
    fn close_sample(&mut self) {
        if let Some(OpenSample { from, point, .. }) = self.open.take() {
            self.line(RayKind::Untested, from, point);
        }
    }

    /// Adds the part of a segment that is in front of the camera.
    fn line(&mut self, kind: RayKind, from: Vec3, to: Vec3) {
        let depth = |point: Vec3| self.camera.project(point).z;
        let (a, b) = (depth(from), depth(to));
        let near = 1e-2 * a.max(b);
        if near.is_nan() || near <= 0.0 {
            return;
        }
        let cut = |point: Vec3, at: f32, other: Vec3, other_at: f32| {
            if at >= near { point } else { point.lerp(other, (near - at) / (other_at - at)) }
        };
        let place = |point: Vec3| self.camera.project(point).truncate();
        let (from, to) = (place(cut(from, a, to, b)), place(cut(to, b, from, a)));
        if from.is_finite() && to.is_finite() {
            self.lines.push(PathLine { kind, from: from.to_array(), to: to.to_array() });
        }
    }
}

fn find<'a>(values: &'a [(String, Vec<f32>)], name: &str) -> Option<&'a [f32]> {
    values.iter().find(|(other, _)| other == name).map(|(_, numbers)| numbers.as_slice())
}

fn number(values: &[(String, Vec<f32>)], name: &str) -> Option<f32> {
    find(values, name)?.first().copied()
}

fn vector(values: &[(String, Vec<f32>)], name: &str) -> Option<Vec3> {
    let numbers: [f32; 3] = find(values, name)?.try_into().ok()?;
    Some(Vec3::from_array(numbers)).filter(|vector| vector.is_finite())
}

#[cfg(test)]
mod tests {
    use arty::camera::CameraDescription;

    use super::*;

    type Values<'a> = &'a [(&'a str, &'a [f32])];

    fn call(function: &str, given: Values<'_>, got: Values<'_>) -> Call {
        let values = |list: Values<'_>| {
            list.iter().map(|(name, numbers)| ((*name).to_owned(), numbers.to_vec())).collect()
        };
        Call { function: function.to_owned(), given: values(given), got: values(got) }
    }

    const EYE: [f32; 3] = [0.0, 0.0, 4.0];
    const FLOOR: [f32; 3] = [0.0, 0.0, 0.0];
    const LIGHT: [f32; 3] = [1.0, 0.0, 0.0];

    fn camera() -> Camera {
        let [eye, center, up] = [Vec3::from_array(EYE), Vec3::ZERO, Vec3::Y];
        Camera::new(&CameraDescription { eye, center, up, fov: 90.0 }, 8, 8)
    }

    fn first() -> Call {
        call("Scene::intersect", &[("origin", &EYE), ("direction", &[0.0, 0.0, -1.0])], &[("point", &FLOOR)])
    }

    fn sample() -> Call {
        call("Light::sample_direct", &[("light", &[2.0]), ("from", &FLOOR)], &[("point", &LIGHT)])
    }

    fn kinds(calls: &[Call]) -> Vec<RayKind> {
        lines(calls, &camera()).iter().map(|line| line.kind).collect()
    }

    #[test]
    fn a_shadow_ray_is_drawn_from_the_hit_point_to_the_light() {
        let occluded = |value: f32| {
            call("Scene::occluded", &[("from", &FLOOR), ("point", &LIGHT)], &[("occluded", &[value])])
        };
        let drawn = lines(&[first(), sample(), occluded(0.0)], &camera());
        // At distance 4 the picture of 8 pixels shows 8 units.
        assert_eq!(drawn, [PathLine { kind: RayKind::Arrives, from: [4.0, 4.0], to: [5.0, 4.0] }]);
        assert_eq!(kinds(&[first(), sample(), occluded(1.0)]), [RayKind::Blocked]);
        assert_eq!(kinds(&[first(), sample()]), [RayKind::Untested]);
        assert_eq!(
            kinds(&[first(), sample(), sample(), occluded(0.0)]),
            [RayKind::Untested, RayKind::Arrives]
        );
    }

    #[test]
    fn a_ray_along_the_bsdf_sample_is_the_paths_and_any_other_a_shadow_ray() {
        let along = |direction: &[f32], light: f32| {
            let given: Values<'_> = &[("origin", &FLOOR), ("direction", direction)];
            call("Scene::intersect", given, &[("point", &LIGHT), ("light", &[light])])
        };
        let bounce = call("Bsdf::sample", &[], &[("wi", &[0.0, 1.0, 0.0])]);
        let up = along(&[0.0, 1.0, 0.0], 7.0);
        let right = |light| along(&[1.0, 0.0, 0.0], light);
        assert_eq!(
            kinds(&[first(), sample(), right(2.0), bounce.clone(), up.clone()]),
            [RayKind::Arrives, RayKind::Bounce]
        );
        assert_eq!(kinds(&[first(), sample(), right(7.0)]), [RayKind::Blocked]);
        assert_eq!(kinds(&[first(), bounce.clone(), up.clone()]), [RayKind::Bounce]);
        // The shadow ray may come after the BSDF sample.
        assert_eq!(kinds(&[first(), sample(), bounce, right(2.0), up]), [RayKind::Arrives, RayKind::Bounce]);
    }

    #[test]
    fn what_is_behind_the_camera_or_not_finite_is_not_drawn() {
        let to = |point: &[f32]| {
            call("Scene::occluded", &[("from", &FLOOR), ("point", point)], &[("occluded", &[0.0])])
        };
        let behind = lines(&[first(), to(&[1.0, 0.0, 40.0])], &camera());
        assert!(behind.len() == 1 && behind[0].to[0] > 8.0 && behind[0].to[0] < 1e4, "{behind:?}");
        let eye_behind = call(
            "Scene::occluded",
            &[("from", &[0.0, 0.0, 5.0]), ("point", &[0.0, 0.0, 9.0])],
            &[("occluded", &[0.0])],
        );
        assert_eq!(kinds(&[first(), eye_behind, to(&[f32::NAN, 0.0, 0.0]), to(&[0.0])]), []);
    }

    #[test]
    fn a_path_has_a_limited_number_of_lines() {
        let calls: Vec<Call> = std::iter::once(first()).chain(std::iter::repeat_n(sample(), 500)).collect();
        assert_eq!(lines(&calls, &camera()).len(), MAX_LINES);
    }
}
