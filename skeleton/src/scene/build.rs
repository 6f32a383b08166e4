//! Building a scene from its description.

use super::closed::encloses;
use super::{
    Attributes, EnvironmentDescription, Features, LightDescription, Material, Mesh, MeshTriangle, NONE,
    Scene, SceneDescription, Specular, Surface, Triangle,
};
use crate::accel::Accel;
use crate::environment::Environment;
use crate::light::{Light, PointLight, Shape, SpotLight, TriangleLight};
use crate::math::{Rgb, Vec3};

impl Scene {
    /// Builds the acceleration structure and the lights.
    ///
    /// Emissive triangles of meshes become lights after those of the description, in the order of the meshes. Triangles
    /// without an area are ignored, with a warning.
    pub fn new(description: &SceneDescription) -> Self {
        let mut builder = Builder::default();
        for light in &description.lights {
            builder.add_light(light);
        }
        builder.surfaces.extend(description.materials.iter().map(|material| Surface {
            diffuse: material.diffuse,
            diffuse_map: material.diffuse_map,
            // A black lobe would only waste samples.
            specular: if material.specular.is_black() { Specular::None } else { material.specular },
            script: None,
        }));
        for mesh in &description.meshes {
            for triangle in &mesh.triangles {
                builder.add_triangle(mesh, triangle, &description.materials[triangle.material as usize]);
            }
        }
        builder.finish(description)
    }
}

#[derive(Default)]
struct Builder {
    triangles: Vec<Triangle>,
    attributes: Vec<Attributes>,
    surfaces: Vec<Surface>,
    lights: Vec<Light>,
    /// Index of the first material: after the surface shared by all triangle lights, if there are any.
    first_material: u32,
    degenerate: usize,
}

impl Builder {
    fn add_light(&mut self, light: &LightDescription) {
        match *light {
            LightDescription::Point { position, power } => {
                self.push_light(Shape::Point(PointLight::new(position, power)));
            }
            LightDescription::Spot { position, direction, inner, outer, power } => {
                self.push_light(Shape::Spot(SpotLight::new(position, direction, inner, outer, power)));
            }
            LightDescription::Triangle { vertices, radiance } => {
                let (Some(normal), Some(light)) =
                    (front_normal(vertices), TriangleLight::new(vertices, radiance))
                else {
                    self.degenerate += 1;
                    return;
                };
                if self.first_material == 0 {
                    self.surfaces.push(Surface {
                        diffuse: Rgb::BLACK,
                        diffuse_map: None,
                        specular: Specular::None,
                        script: None,
                    });
                    self.first_material = 1;
                }
                let light = self.push_light(Shape::Triangle(light));
                self.triangles.push(Triangle {
                    vertices,
                    normal,
                    surface: 0,
                    light,
                    back_light: NONE,
                    attributes: NONE,
                });
            }
        }
    }

    fn add_triangle(&mut self, mesh: &Mesh, triangle: &MeshTriangle, material: &Material) {
        let vertices = triangle.positions.map(|index| mesh.positions[index as usize]);
        let Some(normal) = front_normal(vertices) else {
            self.degenerate += 1;
            return;
        };
        let light = if material.emission.is_black() {
            NONE
        } else if let Some(light) = TriangleLight::new(vertices, material.emission) {
            self.push_light(Shape::Triangle(light))
        } else {
            self.degenerate += 1;
            return;
        };
        let normals = triangle.normals.map(|indices| indices.map(|index| mesh.normals[index as usize]));
        // Texture coordinates are needed for textures only.
        let uvs = triangle.uvs.filter(|_| material.diffuse_map.is_some());
        let uvs = uvs.map(|indices| indices.map(|index| mesh.uvs[index as usize]));
        let attributes = if normals.is_some() || uvs.is_some() {
            self.attributes.push(Attributes { normals, uvs });
            self.attributes.len() as u32 - 1
        } else {
            NONE
        };
        let surface = self.first_material + triangle.material;
        self.triangles.push(Triangle { vertices, normal, surface, light, back_light: NONE, attributes });
    }

    fn push_light(&mut self, shape: Shape) -> u32 {
        let index = self.lights.len();
        self.lights.push(Light::new(index, shape));
        index as u32
    }

    fn finish(mut self, description: &SceneDescription) -> Scene {
        let corners: Vec<[Vec3; 3]> = self.triangles.iter().map(|triangle| triangle.vertices).collect();
        let (accel, closed) =
            rayon::join(|| Accel::build(&corners), || encloses(&self.opaque(), description.camera.eye));
        self.settle_duplicates(accel.duplicates());
        let features =
            Features { environment: description.environment.is_some(), ..self.features(&accel, closed) };
        let mut warnings = Vec::new();
        if self.degenerate > 0 {
            warnings.push(format!("triangles without an area are ignored: {}", self.degenerate));
        }
        warnings.extend(precision_warning(&corners));
        let duplicates = accel.stats().duplicates;
        if duplicates > 0 {
            warnings.push(format!(
                "triangles with the same three vertices as an earlier one are ignored: {duplicates}"
            ));
        }
        Scene {
            accel,
            triangles: self.triangles,
            attributes: self.attributes,
            surfaces: self.surfaces,
            textures: description.textures.clone(),
            lights: self.lights,
            environment: description.environment.as_ref().map(surround),
            camera: description.camera,
            defaults: description.defaults,
            features,
            warnings,
        }
    }

    /// Rays hit only the first of several duplicate triangles. A later one that is a light becomes the back of the first if
    /// it has the opposite orientation. Otherwise it is removed from the lights, or light samples would find a light that no
    /// ray can hit.
    fn settle_duplicates(&mut self, duplicates: &[[u32; 2]]) {
        let mut dropped = vec![false; self.lights.len()];
        for &[later, first] in duplicates {
            let later = &self.triangles[later as usize];
            let (light, normal) = (later.light, later.normal);
            if light == NONE {
                continue;
            }
            let first = &mut self.triangles[first as usize];
            if first.normal.dot(normal) < 0.0 && first.back_light == NONE {
                first.back_light = light;
            } else {
                dropped[light as usize] = true;
            }
        }
        if !dropped.contains(&true) {
            return;
        }
        let mut kept = 0;
        let renumbered: Vec<u32> = dropped
            .iter()
            .map(|&dropped| {
                kept += u32::from(!dropped);
                if dropped { NONE } else { kept - 1 }
            })
            .collect();
        let lights = std::mem::take(&mut self.lights).into_iter().zip(&renumbered);
        self.lights = lights
            .filter(|(_, number)| **number != NONE)
            .map(|(light, &number)| light.renumbered(number as usize))
            .collect();
        for triangle in &mut self.triangles {
            for light in [&mut triangle.light, &mut triangle.back_light] {
                *light = renumbered.get(*light as usize).copied().unwrap_or(NONE);
            }
        }
    }

    /// All triangles except those of glass, through which paths can leave.
    fn opaque(&self) -> Vec<[Vec3; 3]> {
        let is_glass = |triangle: &Triangle| {
            matches!(self.surfaces[triangle.surface as usize].specular, Specular::Glass { .. })
        };
        let opaque = self.triangles.iter().filter(|triangle| !is_glass(triangle));
        opaque.map(|triangle| triangle.vertices).collect()
    }

    fn features(&self, accel: &Accel, closed: bool) -> Features {
        let count = |has: &dyn Fn(&Triangle, &Surface) -> bool| {
            self.triangles
                .iter()
                .filter(|triangle| has(triangle, &self.surfaces[triangle.surface as usize]))
                .count()
        };
        let area_lights = self.lights.iter().filter(|light| light.has_area()).count();
        Features {
            triangles: self.triangles.len(),
            area_lights,
            point_lights: self.lights.len() - area_lights,
            delta_surfaces: count(&|_, surface| {
                matches!(surface.specular, Specular::Mirror { .. } | Specular::Glass { .. })
            }),
            glossy_surfaces: count(&|_, surface| matches!(surface.specular, Specular::Phong { .. })),
            lit_surfaces: count(&|_, surface| {
                !surface.diffuse.is_black() || matches!(surface.specular, Specular::Phong { .. })
            }),
            textured_surfaces: count(&|_, surface| surface.diffuse_map.is_some()),
            smooth_surfaces: count(&|triangle, _| {
                self.attributes.get(triangle.attributes as usize).is_some_and(|it| it.normals.is_some())
            }),
            environment: false,
            closed,
            hierarchy: accel.stats().nodes > 0,
        }
    }
}

fn surround(
    EnvironmentDescription { width, height, texels, rotation }: &EnvironmentDescription,
) -> Environment {
    Environment::new(*width as usize, *height as usize, texels.clone(), *rotation)
}

/// The unit normal of the side from which the vertices are counter-clockwise; `None` for a triangle without an area.
fn front_normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (b - a).cross(c - a).try_normalize().map(|normal| normal.as_vec3())
}

/// A warning if the scene is outside the range of sizes and offsets for which the tests of `accel` show that rays neither
/// leak nor hit the surface they start on.
fn precision_warning(corners: &[[Vec3; 3]]) -> Option<String> {
    let vertices = corners.as_flattened();
    let min = vertices.iter().copied().reduce(Vec3::min)?.as_dvec3();
    let max = vertices.iter().copied().reduce(Vec3::max)?.as_dvec3();
    let size = (max - min).length();
    let offset = (0.5 * (max + min)).length();
    if !(1e-4..=1e5).contains(&size) {
        return Some(format!(
            "the scene has a size of {size:.1e} units; intersections are reliable from 1e-4 to 1e5"
        ));
    }
    (offset > 1e3 * size).then(|| {
        format!(
            "the scene is {:.1e} times its size away from the origin; intersections are reliable up to 1e3",
            offset / size
        )
    })
}
