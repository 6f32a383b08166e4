//! Hit points.

use super::{Attributes, NONE, Scene, Specular, Surface, Triangle, recorded};
use crate::accel::{TriangleHit, offset_origin, point_on};
use crate::bsdf::{Bsdf, Glass, Lobe, LocalGeometry, Phong, ScriptedLobe};
use crate::light::{Emission, Light, recorded_emission};
use crate::math::{Rgb, Vec2, Vec3};
use crate::probe;
use crate::ray::Ray;

/// The point where a ray hits a surface. All vectors are in world space; the viewer is at the origin of the ray.
#[derive(Clone, Copy)]
pub struct Hit<'a> {
    /// The hit point.
    pub point: Vec3,
    /// Shading normal, interpolated if the mesh has normals: a unit vector on the viewer's side.
    pub normal: Vec3,
    /// Geometric normal of the triangle: a unit vector on the viewer's side.
    pub geometric_normal: Vec3,
    /// Direction to the viewer: a unit vector pointing away from the surface.
    pub wo: Vec3,
    pub(super) scene: &'a Scene,
    pub(super) triangle: &'a Triangle,
    /// The index of the triangle.
    pub(super) primitive: u32,
    barycentrics: [f32; 2],
    /// True if the ray has hit the front of the triangle.
    front: bool,
}

impl Attributes {
    /// The interpolated normal on the viewer's side. The geometric normal if the triangle has no vertex normals, or if the
    /// viewer is below the interpolated horizon.
    #[inline(never)]
    fn normal(&self, [v, w]: [f32; 2], geometric_normal: Vec3, wo: Vec3) -> Vec3 {
        let Some([a, b, c]) = self.normals else { return geometric_normal };
        let normal = ((1.0 - v - w) * a + v * b + w * c).normalize_or_zero();
        let normal = if normal.dot(geometric_normal) < 0.0 { -normal } else { normal };
        if normal.dot(wo) > 0.0 { normal } else { geometric_normal }
    }
}

impl<'a> Hit<'a> {
    #[inline]
    pub(super) fn new(scene: &'a Scene, ray: &Ray, hit: TriangleHit) -> Self {
        let triangle = &scene.triangles[hit.primitive as usize];
        let wo = -ray.direction;
        let front = triangle.normal.dot(wo) >= 0.0;
        let geometric_normal = if front { triangle.normal } else { -triangle.normal };
        let normal = match triangle.attributes {
            NONE => geometric_normal,
            attributes => {
                scene.attributes[attributes as usize].normal(hit.barycentrics, geometric_normal, wo)
            }
        };
        Self {
            point: point_on(&triangle.vertices, hit.barycentrics),
            normal,
            geometric_normal,
            wo,
            scene,
            triangle,
            primitive: hit.primitive,
            barycentrics: hit.barycentrics,
            front,
        }
    }

    /// The light at this point and what it emits towards the viewer. `None` if the surface is not a light, or if the ray hit
    /// the back of one.
    #[inline]
    pub fn emission(&self) -> Option<Emission<'a>> {
        let emission = self.light()?.emission(self.wo)?;
        probe::record(|| recorded_emission(self.point, &emission));
        Some(emission)
    }

    /// The light that was hit from its front, if any.
    #[inline]
    pub(super) fn light(&self) -> Option<&'a Light> {
        let light = if self.front { self.triangle.light } else { self.triangle.back_light };
        (light != NONE).then(|| &self.scene.lights[light as usize])
    }

    /// The BSDF of the surface at this point.
    #[inline]
    pub fn bsdf(&self) -> Bsdf {
        let geometry =
            LocalGeometry { normal: self.normal, geometric_normal: self.geometric_normal, wo: self.wo };
        let surface = self.surface();
        if let Some(script) = surface.script {
            return Bsdf::single(geometry, Lobe::Scripted(ScriptedLobe::new(script, self.point)));
        }
        match surface.specular {
            Specular::None => Bsdf::single(geometry, Lobe::Diffuse { albedo: self.diffuse_albedo() }),
            _ => self.specular_bsdf(geometry, surface),
        }
    }

    #[inline(never)]
    fn specular_bsdf(&self, geometry: LocalGeometry, surface: &Surface) -> Bsdf {
        let albedo = self.diffuse_albedo();
        let diffuse = Lobe::Diffuse { albedo };
        let (lobe, reflectance) = match surface.specular {
            Specular::None => return Bsdf::single(geometry, diffuse),
            Specular::Phong { reflectance, exponent } => {
                (Lobe::Phong(Phong { reflectance, exponent }), reflectance)
            }
            Specular::Mirror { reflectance } => (Lobe::Mirror { reflectance }, reflectance),
            Specular::Glass { index, reflectance, transmittance } => {
                let ratio = if self.front { 1.0 / index } else { index };
                (Lobe::Glass(Glass { ratio, reflectance, transmittance }), transmittance)
            }
        };
        if albedo.is_black() {
            return Bsdf::single(geometry, lobe);
        }
        // Selection probability roughly proportional to the reflectance.
        let (kd, ks) = (albedo.luminance(), reflectance.luminance());
        Bsdf::mixture(geometry, diffuse, lobe, (kd / (kd + ks)).clamp(0.05, 0.95))
    }

    #[inline]
    fn surface(&self) -> &'a Surface {
        &self.scene.surfaces[self.triangle.surface as usize]
    }

    /// The diffuse albedo at this point, including the texture.
    #[inline]
    pub(crate) fn diffuse_albedo(&self) -> Rgb {
        let surface = self.surface();
        match surface.diffuse_map {
            None => surface.diffuse,
            Some(map) => surface.diffuse * self.texel(map),
        }
    }

    /// The value of a texture at this point.
    #[inline(never)]
    fn texel(&self, map: u32) -> Rgb {
        self.scene.textures[map as usize].lookup(self.uv())
    }

    /// Texture coordinates; (0, 0) if the mesh has none.
    fn uv(&self) -> Vec2 {
        let attributes = self.scene.attributes.get(self.triangle.attributes as usize);
        let Some([a, b, c]) = attributes.and_then(|attributes| attributes.uvs) else { return Vec2::ZERO };
        let [v, w] = self.barycentrics;
        (1.0 - v - w) * a + v * b + w * c
    }

    /// Absolute cosine between the shading normal and the unit direction `wi`.
    #[inline]
    pub fn cos(&self, wi: Vec3) -> f32 {
        let cos = self.normal.dot(wi).abs();
        probe::record(|| recorded::cos(wi, cos));
        cos
    }

    /// A ray from this point in the unit direction `wi`, on either side of the surface. It cannot hit the triangle it starts
    /// on. Spawn a new ray for each direction.
    #[inline]
    pub fn spawn(&self, wi: Vec3) -> Ray {
        Ray { exclude: Some(self.primitive), ..Ray::new(self.leave_towards(wi), wi) }
    }

    /// The origin of rays in the given direction, offset from the surface against self-intersection.
    #[inline]
    pub(super) fn leave_towards(&self, direction: Vec3) -> Vec3 {
        offset_origin(self.point, self.geometric_normal, direction)
    }
}
