//! Scripted chains: the camera, up to a dozen small surfaces, and a light.
//!
//! All points of a path lie on a helix, where no surface is between two others. Each surface samples the direction to
//! the next point. The light is bright for light samples of the last surface only, so that a path has one light sample
//! and one hit that contribute. Geometry is real: whatever a submission computes from positions and normals is right.

use std::f32::consts::PI;

use arty::math::{Rgb, Vec3};
use arty::scene::{LightDescription, Mesh, MeshTriangle, SceneDescription};
use glam::DVec3;
use host::protocol::{AuditBsdf, AuditLight, AuditSampling, AuditScene};
use verdict::audit::{PathEnd, SurfaceKind};

use crate::scenes;

#[cfg(test)]
mod tests;

/// A chain of surfaces with a light at its end.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// The surfaces, from the camera on.
    pub(super) surfaces: Vec<Surface>,
    /// What the last surface's sampled direction ends at.
    pub(super) end: PathEnd,
    /// Radiance of an area light, intensity of a point light.
    pub(super) emitted: Rgb,
    /// Distance of the light relative to the basic one.
    pub(super) distance: f32,
    /// Cosine at the light, of the point that is hit.
    pub(super) cos_light: f32,
    /// Side to which the light is turned: 1, or −1, where it faces away from the first of three surfaces.
    pub(super) turn: f32,
    /// Distance of the sampled light point from the one that is hit, relative to the distance of the light.
    pub(super) apart: f32,
    /// Density per area of the sampled light point.
    pub(super) pdf_area: f32,
    /// Density per area of the light point that is hit.
    pub(super) pdf_area_on_hit: f32,
    /// Emission of further equal lights that no light sample finds, relative to that of the light.
    pub(super) dark_lights: Vec<f32>,
    /// Index of the light among all lights.
    pub(super) index: usize,
    /// Where something black stands between the last surface and the light: fractions of the distance.
    pub(super) blocked: Vec<f32>,
    /// Scale of the scene.
    pub(super) scale: f32,
}

/// A surface of a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub(super) kind: SurfaceKind,
    /// Throughput of the sampled direction, f · cos / pdf.
    pub(super) throughput: Rgb,
    /// Density of the sampled direction.
    pub(super) pdf: f32,
    /// Value and density in all directions but the sampled one and that to the viewer.
    pub(super) elsewhere: (Rgb, f32),
    /// Value and density in the direction to the viewer.
    pub(super) at_viewer: (Rgb, f32),
    /// Factor on the value of the sampled direction beyond what `throughput` says.
    pub(super) value: f32,
    /// Factor on its density beyond `pdf`.
    pub(super) density: f32,
    /// How far the shading normal leans from the next point to the last one, 0.7 by default.
    pub(super) lean: f32,
    /// How far the geometric normal leans from the next point to the last one.
    pub(super) geometric_lean: f32,
    /// True if sampling returns nothing.
    pub(super) samples_nothing: bool,
    /// True if the next point is below its horizon.
    pub(super) faces_away: bool,
    /// Radiance that the surface itself emits.
    pub(super) emits: f32,
}

/// Lengths and cosines of a chain's last segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// Distance from the last surface.
    pub(super) distance: f64,
    /// Cosine at the last surface, with the shading normal.
    pub(super) cos: f64,
    /// Cosine at the last surface, with the geometric normal.
    pub(super) geometric_cos: f64,
    /// Cosine at the light.
    pub(super) cos_light: f64,
}

/// Radius of a surface, in scene units.
const RADIUS: f64 = 0.03;

impl Surface {
    /// A surface of this kind that passes on all light.
    pub(super) fn new(kind: SurfaceKind) -> Self {
        let pdf = match kind {
            SurfaceKind::Diffuse => 0.25,
            SurfaceKind::Glossy => 8.0,
            SurfaceKind::Mirror => 1.0,
            SurfaceKind::Glass | SurfaceKind::Coated => 0.5,
        };
        Self {
            kind,
            throughput: Rgb::WHITE,
            pdf,
            elsewhere: (Rgb::gray(0.5), 0.4),
            at_viewer: (Rgb::gray(0.7), 0.9),
            value: 1.0,
            density: 1.0,
            lean: 0.7,
            geometric_lean: 0.7,
            samples_nothing: false,
            faces_away: false,
            emits: 0.0,
        }
    }
}

impl Chain {
    /// A chain of surfaces with densities of order one and an area light at its end. Light samples and hits find the same
    /// light point.
    pub(super) fn new(kinds: &[SurfaceKind], end: PathEnd) -> Self {
        Self {
            surfaces: kinds.iter().copied().map(Surface::new).collect(),
            end,
            emitted: Rgb::WHITE,
            distance: 1.0,
            cos_light: 0.8,
            turn: 1.0,
            apart: 0.0,
            pdf_area: 0.3,
            pdf_area_on_hit: 0.3,
            dark_lights: Vec::new(),
            index: 0,
            blocked: Vec::new(),
            scale: 1.0,
        }
    }

    /// The surface at a hit point, counted from 1.
    pub(super) fn at(&mut self, hit: usize) -> &mut Surface {
        &mut self.surfaces[hit - 1]
    }

    /// The surface before the light.
    pub(super) fn last(&mut self) -> &mut Surface {
        self.surfaces.last_mut().expect("the chain has surfaces")
    }

    /// The point with this index: 0 is the camera.
    fn point(&self, index: usize) -> DVec3 {
        let last = self.surfaces.len() + 1;
        let on_helix = |index: usize| {
            let turn = 1.9 * index as f64;
            f64::from(self.scale) * DVec3::new(turn.cos(), turn.sin(), 0.35 * index as f64)
        };
        if index < last || last == 1 {
            return on_helix(index);
        }
        let from = on_helix(last - 1);
        from + f64::from(self.distance) * (on_helix(last) - from)
    }

    /// The normal of a surface that leans towards the last point.
    fn normal(&self, index: usize, lean: f32) -> DVec3 {
        let here = self.point(index);
        let (wo, wi) =
            ((self.point(index - 1) - here).normalize(), (self.point(index + 1) - here).normalize());
        let surface = &self.surfaces[index - 1];
        let side = if surface.kind == SurfaceKind::Glass || surface.faces_away { -wi } else { wi };
        (wo * f64::from(lean) + side).normalize()
    }

    /// Axes of the light: its normal, and the direction in which its points lie.
    fn light_axes(&self) -> (DVec3, DVec3) {
        let count = self.surfaces.len();
        let towards = (self.point(count + 1) - self.point(count)).normalize();
        let along = towards.cross(DVec3::new(0.3, 0.2, 0.9)).normalize();
        let cos = f64::from(self.cos_light);
        let aside = towards.cross(along) * f64::from(self.turn);
        let normal = -towards * cos + aside * (1.0 - cos * cos).max(0.0).sqrt();
        (normal, along)
    }

    fn unit_of_light(&self) -> f64 {
        let count = self.surfaces.len();
        let distance = (self.point(count + 1) - self.point(count)).length();
        distance * if self.apart > 0.0 { f64::from(self.apart) } else { 0.1 }
    }

    fn sampled_point(&self) -> DVec3 {
        let hit = self.point(self.surfaces.len() + 1);
        if self.apart > 0.0 { hit + self.light_axes().1 * self.unit_of_light() } else { hit }
    }

    /// Corners of a triangle light; number 0 is the one that the path hits.
    fn light(&self, number: usize) -> [Vec3; 3] {
        let (normal, along) = self.light_axes();
        let (unit, across) = (self.unit_of_light(), normal.cross(along));
        let centre = self.point(self.surfaces.len() + 1)
            + along * unit * (if self.apart > 0.0 { 0.5 } else { 0.0 } - 2.1 * number as f64);
        [
            centre - along * unit - across * (0.3 * unit),
            centre + along * unit - across * (0.3 * unit),
            centre + across * (0.6 * unit),
        ]
        .map(|corner| corner.as_vec3())
    }

    fn segment_to(&self, point: DVec3) -> Segment {
        let count = self.surfaces.len();
        let here = self.point(count);
        let wi = (point - here).normalize();
        let cos = |lean: f32| if count == 0 { 1.0 } else { self.normal(count, lean).dot(wi).abs() };
        let (lean, geometric) = self.surfaces.last().map_or((0.0, 0.0), |it| (it.lean, it.geometric_lean));
        Segment {
            distance: (point - here).length(),
            cos: cos(lean),
            geometric_cos: cos(geometric),
            cos_light: -self.light_axes().0.dot(wi),
        }
    }

    /// The segment from the last surface to the light point that is sampled.
    pub(super) fn sampled(&self) -> Segment {
        self.segment_to(self.sampled_point())
    }

    /// The segment from the last surface to the light point that is hit.
    pub(super) fn hit(&self) -> Segment {
        self.segment_to(self.point(self.surfaces.len() + 1))
    }

    /// Throughput up to the last surface.
    pub(super) fn throughput(&self) -> f64 {
        let count = self.surfaces.len().max(1) - 1;
        let of = |it: &Surface| f64::from(it.throughput.r * it.value / it.density);
        self.surfaces[..count].iter().map(of).product()
    }

    /// Density per solid angle of the light sample, without the selection probability.
    pub(super) fn p_light(&self) -> f64 {
        let Segment { distance, cos_light, .. } = self.sampled();
        f64::from(self.pdf_area) * distance * distance / cos_light
    }

    /// The same for the light point that is hit.
    pub(super) fn p_light_on_hit(&self) -> f64 {
        let Segment { distance, cos_light, .. } = self.hit();
        f64::from(self.pdf_area_on_hit) * distance * distance / cos_light
    }

    /// The light sample's contribution without a weight, in the red channel.
    pub(super) fn light_sample(&self) -> f64 {
        let Some(last) = self.surfaces.last() else { return 0.0 };
        if last.kind.is_delta() || self.end == PathEnd::Nothing {
            return 0.0;
        }
        let segment = self.sampled();
        let is_sampled_direction = self.apart == 0.0 && last.kind != SurfaceKind::Coated;
        let f = if is_sampled_direction { self.value_at_target(last) } else { last.elsewhere.0.r };
        let base = self.throughput() * f64::from(f) * f64::from(self.emitted.r) * segment.cos;
        match self.end {
            PathEnd::PointLight => base / (segment.distance * segment.distance),
            _ => base / self.p_light(),
        }
    }

    /// All channels of what the light sample and the hit contribute, relative to the red one.
    pub(super) fn colors(&self) -> [[f64; 3]; 2] {
        let relative = |color: Rgb| color.to_array().map(|channel| f64::from(channel / color.r));
        let times = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|channel| a[channel] * b[channel]);
        let Some((last, before)) = self.surfaces.split_last() else { return [relative(self.emitted); 2] };
        let common =
            before.iter().fold(relative(self.emitted), |product, it| times(product, relative(it.throughput)));
        [times(common, relative(last.elsewhere.0)), times(common, relative(last.throughput))]
    }

    /// The contribution of the hit without a weight, in the red channel.
    pub(super) fn hit_light(&self) -> f64 {
        if self.end != PathEnd::AreaLight {
            return 0.0;
        }
        let last = self.surfaces.last();
        let of_last = last.map_or(1.0, |it| f64::from(it.throughput.r * it.value / it.density));
        self.throughput() * of_last * f64::from(self.emitted.r)
    }

    /// The value that gives the sampled direction its throughput, as seen with the default lean.
    fn value_at_target(&self, surface: &Surface) -> f32 {
        let index = self.surfaces.iter().position(|it| std::ptr::eq(it, surface)).unwrap_or(0) + 1;
        self.value_of(index).r
    }

    fn value_of(&self, index: usize) -> Rgb {
        let surface = &self.surfaces[index - 1];
        let wi = (self.point(index + 1) - self.point(index)).normalize();
        let cos = self.normal(index, surface.lean).dot(wi).abs() as f32;
        surface.throughput * (surface.pdf * surface.value / cos)
    }

    /// The scene.
    pub(super) fn scene(&self) -> AuditScene {
        let mut scene = scenes::empty();
        let count = self.surfaces.len();
        let mut bsdfs = Vec::new();
        for index in 1..=count {
            let surface = &self.surfaces[index - 1];
            let normals = [surface.geometric_lean, surface.lean].map(|lean| self.normal(index, lean));
            self.add(&mut scene, self.point(index), normals, f64::from(self.scale) * RADIUS, surface.emits);
            bsdfs.push(Some(AuditBsdf {
                target: self.point(index + 1).as_vec3(),
                elsewhere: surface.elsewhere,
                at_target: (self.value_of(index), surface.pdf * surface.density),
                at_viewer: surface.at_viewer,
                sampling: match surface.kind {
                    _ if surface.samples_nothing => AuditSampling::Nothing,
                    SurfaceKind::Mirror | SurfaceKind::Glass => AuditSampling::Delta,
                    SurfaceKind::Coated => AuditSampling::DeltaLobe,
                    SurfaceKind::Diffuse | SurfaceKind::Glossy => AuditSampling::Target,
                },
            }));
        }
        for &fraction in &self.blocked {
            let (from, to) = (self.point(count), self.sampled_point());
            let at = from + (to - from) * f64::from(fraction);
            let size = (0.02 * (to - from).length()).min((to - from).length() * f64::from(fraction.abs()));
            self.add(&mut scene, at, [(from - to).normalize(); 2], size, 0.0);
            bsdfs.push(None);
        }
        let lights = self.add_lights(&mut scene);
        let origin = self.point(0).as_vec3();
        let direction = (self.point(1).as_vec3() - origin).normalize();
        AuditScene { scene, bsdfs, lights, origin, direction }
    }

    fn add_lights(&self, scene: &mut SceneDescription) -> Vec<Option<AuditLight>> {
        let count = self.surfaces.len();
        let script = AuditLight {
            point: self.sampled_point().as_vec3(),
            pdf_area: self.pdf_area,
            pdf_area_on_hit: self.pdf_area_on_hit,
            bright_from: (count > 1).then(|| self.point(count).as_vec3()),
        };
        let nowhere = Some(Vec3::splat(1e6));
        let mut scripts = Vec::new();
        let all = std::iter::once(&1.0).chain(&self.dark_lights);
        for (number, &brightness) in all.enumerate() {
            let emitted = self.emitted * brightness;
            scene.lights.push(match self.end {
                PathEnd::Nothing => return Vec::new(),
                PathEnd::PointLight => LightDescription::Point {
                    position: self.sampled_point().as_vec3() + Vec3::Z * (0.2 * number as f32),
                    power: emitted * (4.0 * PI),
                },
                PathEnd::AreaLight => {
                    LightDescription::Triangle { vertices: self.light(number), radiance: emitted }
                }
            });
            scripts.push(Some(match number {
                0 => script,
                _ => AuditLight { bright_from: nowhere, ..script },
            }));
        }
        scene.lights.swap(0, self.index);
        scripts.swap(0, self.index);
        scripts
    }

    /// Adds a triangle with a geometric and a shading normal, which has a material of its own.
    fn add(
        &self,
        scene: &mut SceneDescription,
        at: DVec3,
        [geometric, shading]: [DVec3; 2],
        radius: f64,
        emits: f32,
    ) {
        let along = geometric.any_orthonormal_vector();
        let across = geometric.cross(along);
        let corner = |turn: f64| (at + (along * turn.cos() + across * turn.sin()) * radius).as_vec3();
        let material = scene.materials.len() as u32;
        scene.materials.push(scenes::grey(0.0, emits));
        scene.meshes.push(Mesh {
            positions: [0.0, 2.1, 4.2].map(corner).to_vec(),
            normals: vec![shading.as_vec3().normalize()],
            uvs: Vec::new(),
            triangles: vec![MeshTriangle {
                positions: [0, 1, 2],
                normals: (geometric != shading).then_some([0; 3]),
                uvs: None,
                material,
            }],
        });
    }
}
