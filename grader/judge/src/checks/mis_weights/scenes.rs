//! Scripted scenes in which the radiance of a path reveals one MIS weight.
//!
//! N equal triangle lights stand around the normal of the last vertex. Each has two points, mirrored about the plane
//! through that normal and the center of the light, so that both have the same distance and the same cosines. Light
//! samples go to the one, BSDF samples to the other. A small black triangle occludes one of them. The geometry is
//! real; only densities and the value of the BSDF are scripted.
//!
//! The point and the direction whose weight is measured have the densities of the configuration. All others, such as
//! those of the technique that does not arrive, of the direction to the viewer, or of a light point that is sampled
//! again, have different ones: a weight must not depend on them.

use std::f32::consts::TAU;

use arty::math::{Frame, Rgb, Vec3, direction_and_distance};
use arty::ray::Ray;
use arty::sampler::Sampler;
use arty::scene::{LightDescription, Scene, SceneDescription};
use host::protocol::{ScriptedBsdf, ScriptedLight, ScriptedScene};

use crate::scenes;

/// The range from which a configuration is drawn.
#[derive(Clone, Copy, Debug)]
pub(in crate::checks) struct ConfigurationRange {
    /// Number of vertices of the path before the light.
    pub(in crate::checks) vertices: usize,
    /// Natural logarithms of the minimum and maximum density per solid angle.
    pub(in crate::checks) densities: [f32; 2],
    /// Distances lie between e^−`distances` and e^`distances`.
    pub(in crate::checks) distances: f32,
    /// Minimum cosine.
    pub(in crate::checks) min_cos: f32,
    /// True if lights differ in radiance, and only one of them is visible.
    pub(in crate::checks) unequal: bool,
}

/// Two scenes that differ in the technique that reaches the light.
#[derive(Clone, Debug)]
pub(in crate::checks) struct Configuration {
    /// Only light samples arrive.
    pub(in crate::checks) light_side: ScriptedScene,
    /// Only the BSDF sample of the last vertex arrives.
    pub(in crate::checks) bsdf_side: ScriptedScene,
    /// Density of the light sample per solid angle, including a selection probability of 1 / `lights`.
    pub(in crate::checks) p_light: f64,
    /// Density of the BSDF sample per solid angle.
    pub(in crate::checks) p_bsdf: f64,
    /// Distance from the last vertex to the light.
    pub(in crate::checks) distance: f64,
    /// Cosine at the light.
    pub(in crate::checks) cos_light: f64,
    /// Number of lights.
    pub(in crate::checks) lights: usize,
    /// Number of lights that light samples reach.
    pub(in crate::checks) visible_lights: usize,
    /// 1 / (density of the light sample per area, given the light).
    pub(in crate::checks) area: f64,
    /// Contribution of the path at weight 1 and density 1: throughput · f · L · cos.
    pub(in crate::checks) contribution: f64,
}

/// Distance of light points from the center of their light, relative to the distance of the light.
const HALF: f32 = 0.05;

/// Relative radiance of unequal lights.
const RADIANCES: [f32; 3] = [1.0, 2.0, 4.0];

/// The greater of the two densities is at least this: where both are small, a path contributes little, and a small
/// constant added to denominators shows.
const MIN_GREATER_DENSITY: f32 = 0.3;

/// Maximum number of lights in a configuration: more than a path with one vertex has hit points.
pub(super) const MAX_LIGHTS: usize = 5;

/// Draws configurations until one is valid: exactly the intended technique reaches the light, as rays confirm.
pub(in crate::checks) fn draw(range: ConfigurationRange, random: &mut Sampler) -> Configuration {
    loop {
        let configuration = attempt(range, random);
        let open = |scripted: &ScriptedScene| open_ways(scripted, range.vertices);
        if open(&configuration.light_side) == Some((configuration.visible_lights, false))
            && open(&configuration.bsdf_side) == Some((0, true))
        {
            return configuration;
        }
    }
}

fn attempt(range: ConfigurationRange, random: &mut Sampler) -> Configuration {
    let mut between = |low: f32, high: f32| low + (high - low) * random.next_1d();
    let equal_lights = [1, 2, MAX_LIGHTS][between(0.0, 3.0) as usize % 3];
    let lights = if range.unequal { RADIANCES.len() } else { equal_lights };
    let d = between(-range.distances, range.distances).exp();
    let cos_light = between(range.min_cos.ln(), 0.0).exp();
    let cos = between(range.min_cos.ln(), 0.85f32.ln()).exp();
    let [low, high] = range.densities;
    let (wanted_light, pdf) = (between(low, high).exp(), between(low, high).exp());
    let raise = (MIN_GREATER_DENSITY / wanted_light.max(pdf)).max(1.0);
    let (wanted_light, pdf) = (wanted_light * raise, pdf * raise);
    let mut other =
        |density: f32| density * (between(1.0, 1.8) * if between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 }).exp();
    let (other_of_light, other_pdf, pdf_at_viewer) = (other(1.0), other(pdf), other(pdf));
    let target_light = (between(0.0, lights as f32) as usize).min(lights - 1);
    let (turn, tilt) = (between(0.0, TAU), if between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 });
    let frame = Frame::around(unit(between(-1.0, 1.0), between(0.0, TAU)));
    let centre = d * Vec3::new(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0));
    let to_world = |local: Vec3| centre + frame.to_world(d * local);

    // In the frame of the last vertex, in units of d.
    let stretch = (1.0 + HALF * HALF).sqrt();
    let radius = 1.0 / stretch;
    let (cos_polar, cos_tilt) = ((cos * stretch).min(1.0), (cos_light * stretch).min(1.0));
    let (sin_polar, sin_tilt) = ((1.0 - cos_polar * cos_polar).sqrt(), (1.0 - cos_tilt * cos_tilt).sqrt());
    let place = |light: usize| {
        let (sin, cos) = (turn + TAU * light as f32 / lights as f32).sin_cos();
        let outward = Vec3::new(sin_polar * cos, sin_polar * sin, cos_polar);
        let downward = Vec3::new(cos_polar * cos, cos_polar * sin, -sin_polar);
        let along = Vec3::new(-sin, cos, 0.0);
        let normal = -outward * cos_tilt + downward * (sin_tilt * tilt);
        (outward * radius, along * (HALF * radius), normal.cross(along) * (HALF * radius))
    };
    let corners = |light: usize| {
        let (middle, along, across) = place(light);
        [middle - 3.0 * along - across, middle + 3.0 * along - across, middle + 4.0 * across].map(to_world)
    };
    let sampled: Vec<Vec3> = (0..lights).map(|light| to_world(place(light).0 - place(light).1)).collect();
    let target = to_world(place(target_light).0 + place(target_light).1);

    // From the last vertex back to the camera.
    let back = Vec3::new(0.1, 0.0, 0.995);
    let (sin, cos_turn) = (1.7 * turn).sin_cos();
    let aside = Vec3::new(0.8 * cos_turn, 0.8 * sin, 0.6);
    let last = Vec3::new(-0.8 * sin, 0.8 * cos_turn, 0.6);
    let mirrored = |step: Vec3| Vec3::new(-step.x, -step.y, step.z);
    let mut way = vec![Vec3::ZERO];
    for step in [back, aside, last, mirrored(aside), mirrored(last), aside] {
        way.push(way[way.len() - 1] + 1.5 * step);
    }
    let way: Vec<Vec3> = way.into_iter().take(range.vertices + 1).map(to_world).collect();

    let normal_of_light = front_normal(corners(0));
    let (to_light, distance) = exact_direction(way[0], sampled[0]);
    let cos_light = -normal_of_light.dot(to_light);
    let pdf_area = (f64::from(wanted_light) * lights as f64 * cos_light / (distance * distance)) as f32;
    let p_light = f64::from(pdf_area) * distance * distance / (lights as f64 * cos_light);

    let mut builder = Builder::default();
    let mut bsdfs = Vec::new();
    let radiance = |light: usize| if range.unequal { RADIANCES[light] } else { 1.0 };
    let mut contribution = f64::from(radiance(target_light));
    for vertex in 0..range.vertices {
        let towards = if vertex == 0 { target } else { way[vertex - 1] };
        let normal = if vertex == 0 {
            frame.to_world(Vec3::Z)
        } else {
            (direction_and_distance(way[vertex], towards).0
                + direction_and_distance(way[vertex], way[vertex + 1]).0)
                .normalize()
        };
        let corners = builder.add_around(way[vertex], normal, 0.05 * d);
        let cos = front_normal(corners).dot(exact_direction(way[vertex], towards).0).abs();
        let (pdf, value) = if vertex == 0 {
            // With this value, a path returns 1 with either technique under the balance heuristic.
            (pdf, (p_light + f64::from(pdf)) / cos)
        } else {
            let pdf = between(low.max(-4.0), high.min(4.0)).exp();
            (pdf, f64::from(pdf) / cos)
        };
        let f = value as f32;
        contribution *= f64::from(f) * cos / if vertex == 0 { 1.0 } else { f64::from(pdf) };
        let (pdf_at_viewer, pdf_elsewhere) = (3.0 * pdf, 2.0 * pdf);
        bsdfs.push(Some(ScriptedBsdf {
            target: towards,
            f,
            pdf,
            pdf_at_viewer,
            pdf_elsewhere,
            is_delta: false,
        }));
    }
    bsdfs.push(None);
    // Occlude the light samples of earlier vertices.
    for &vertex in &way[1..range.vertices] {
        sampled.iter().for_each(|&point| builder.block(vertex, point, 0.01 * d));
    }
    let mut bsdf_side = builder.clone();
    builder.block(way[0], target, 0.01 * d);
    if range.unequal {
        let others = sampled.iter().enumerate().filter(|(light, _)| *light != target_light);
        others.for_each(|(_, &point)| builder.block(way[0], point, 0.01 * d));
    }
    sampled.iter().for_each(|&point| bsdf_side.block(way[0], point, 0.01 * d));

    let triangles: Vec<([Vec3; 3], f32)> =
        (0..lights).map(|light| (corners(light), radiance(light))).collect();
    let (origin, aim) = (way[range.vertices], way[range.vertices - 1]);
    // Densities of the sampled light points and of those that are hit, of the sampled direction and of others.
    let scripted =
        |builder: Builder, [pdf_area, pdf_area_on_hit]: [f32; 2], [pdf, pdf_elsewhere]: [f32; 2]| {
            let script = |&point: &Vec3| Some(ScriptedLight { point, pdf_area, pdf_area_on_hit });
            let mut bsdfs = bsdfs.clone();
            bsdfs[0] = bsdfs[0].map(|bsdf| ScriptedBsdf { pdf, pdf_at_viewer, pdf_elsewhere, ..bsdf });
            ScriptedScene {
                scene: builder.finish(range.vertices, &triangles),
                bsdfs,
                lights: sampled.iter().map(script).collect(),
                origin,
                direction: direction_and_distance(origin, aim).0,
            }
        };
    let other_area = pdf_area * other_of_light;
    Configuration {
        light_side: scripted(builder, [pdf_area, other_area], [other_pdf, pdf]),
        bsdf_side: scripted(bsdf_side, [other_area, pdf_area], [pdf, other_pdf]),
        p_light,
        p_bsdf: f64::from(pdf),
        distance,
        cos_light,
        lights,
        visible_lights: if range.unequal { 1 } else { lights },
        area: 1.0 / f64::from(pdf_area),
        contribution,
    }
}

/// A unit vector with the given height and azimuth.
fn unit(z: f32, azimuth: f32) -> Vec3 {
    let radius = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
}

fn front_normal(corners: [Vec3; 3]) -> glam::DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize()
}

fn exact_direction(from: Vec3, to: Vec3) -> (glam::DVec3, f64) {
    let difference = to.as_dvec3() - from.as_dvec3();
    (difference.normalize(), difference.length())
}

/// The number of lights whose sampled point is visible from the last vertex, and whether its BSDF sample hits a light.
/// `None` if the path does not reach the last vertex, or if another vertex sees a light.
fn open_ways(scripted: &ScriptedScene, vertices: usize) -> Option<(usize, bool)> {
    let scene = Scene::new(&scripted.scene);
    let mut ray = Ray::new(scripted.origin, scripted.direction);
    for vertex in (0..vertices).rev() {
        let hit = scene.intersect(&ray)?;
        let target = scripted.bsdfs[vertex]?.target;
        let seen =
            scripted.lights.iter().flatten().filter(|light| !scene.occluded(&hit, light.point)).count();
        ray = hit.spawn(direction_and_distance(hit.point, target).0);
        if vertex == 0 {
            return Some((seen, scene.intersect(&ray).is_some_and(|next| next.emission().is_some())));
        }
        let next = scene.intersect(&ray)?;
        if seen > 0 || (next.point - target).length() > 1e-3 * (target - hit.point).length() {
            return None;
        }
    }
    None
}

/// Triangles of a scene: those of the path's vertices first, each with its own material, then occluders.
#[derive(Clone, Default)]
struct Builder {
    triangles: Vec<[Vec3; 3]>,
}

impl Builder {
    /// Adds an equilateral triangle around a point.
    fn add_around(&mut self, point: Vec3, normal: Vec3, radius: f32) -> [Vec3; 3] {
        let frame = Frame::around(normal);
        let corner = |i: u8| point + frame.to_world(radius * unit(0.0, TAU * f32::from(i) / 3.0));
        let corners = [corner(0), corner(1), corner(2)];
        self.triangles.push(corners);
        corners
    }

    /// Adds an occluder halfway between two points.
    fn block(&mut self, from: Vec3, to: Vec3, radius: f32) {
        self.add_around(0.5 * (from + to), direction_and_distance(from, to).0, radius);
    }

    fn finish(self, vertices: usize, lights: &[([Vec3; 3], f32)]) -> SceneDescription {
        let mut scene = scenes::empty();
        let corners: Vec<_> =
            self.triangles.iter().map(|triangle| triangle.map(|corner| corner.as_dvec3())).collect();
        let (of_vertices, black) = corners.split_at(vertices);
        for triangle in of_vertices {
            scenes::add(&mut scene, &[*triangle], scenes::grey(0.0, 0.0));
        }
        scenes::add(&mut scene, black, scenes::grey(0.0, 0.0));
        scene.lights = lights
            .iter()
            .map(|&(vertices, radiance)| LightDescription::Triangle {
                vertices,
                radiance: Rgb::gray(radiance),
            })
            .collect();
        scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn configurations_of_every_length_are_drawn_and_mirrored_points_have_equal_distances() {
        let mut random = Sampler::new(1, (0, 0), 0);
        for (vertices, unequal) in [(1, false), (1, true), (2, false), (3, false), (6, false)] {
            for _ in 0..20 {
                let (densities, distances, min_cos) = ([-27.6, 27.6], 3.9, 0.05);
                let range = ConfigurationRange { vertices, densities, distances, min_cos, unequal };
                let configuration = draw(range, &mut random);
                let scripted = &configuration.bsdf_side;
                let hit_point = scripted.bsdfs[0].expect("it is scripted").target;
                let last = if vertices == 1 {
                    let scene = Scene::new(&scripted.scene);
                    scene.intersect(&Ray::new(scripted.origin, scripted.direction)).expect("it hits").point
                } else {
                    scripted.bsdfs[1].expect("it is scripted").target
                };
                let (_, distance) = exact_direction(last, hit_point);
                assert!((distance / configuration.distance - 1.0).abs() < 1e-5);
                assert!(configuration.cos_light > 0.04 && configuration.contribution > 0.0);
            }
        }
    }
}
