//! Scene descriptions: plain data as read from files.
//!
//! A description contains everything that a [`Scene`](super::Scene) is built from. It can be sent to another process, and
//! its [hash](SceneDescription::hash) identifies the scene independently of how its files are written.

use glam::{Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::camera::CameraDescription;
use crate::math::Rgb;

/// A scene as data. Lengths are in scene units, positions in world space.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SceneDescription {
    /// The camera.
    pub camera: CameraDescription,
    /// All surfaces except triangle lights.
    pub meshes: Vec<Mesh>,
    /// Materials, referred to by [`MeshTriangle::material`].
    pub materials: Vec<Material>,
    /// Textures, referred to by [`Material::diffuse_map`].
    pub textures: Vec<Texture>,
    /// Explicit lights. Triangles with an emissive material are lights, too.
    pub lights: Vec<LightDescription>,
    /// Default render settings.
    pub defaults: Defaults,
    /// Light from outside of the scene; `None` if there is none.
    pub environment: Option<EnvironmentDescription>,
}

/// Triangles with shared vertex data.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Mesh {
    /// Vertex positions, already in world space.
    pub positions: Vec<Vec3>,
    /// Shading normals, unit length, in world space.
    pub normals: Vec<Vec3>,
    /// Texture coordinates; (0, 0) is the lower left corner of a texture.
    pub uvs: Vec<Vec2>,
    /// The triangles.
    pub triangles: Vec<MeshTriangle>,
}

/// One triangle of a [`Mesh`]. Its front is the side from which its vertices run counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MeshTriangle {
    /// Indices into [`Mesh::positions`].
    pub positions: [u32; 3],
    /// Indices into [`Mesh::normals`]; `None` for flat shading.
    pub normals: Option<[u32; 3]>,
    /// Indices into [`Mesh::uvs`]; `None` without texture coordinates.
    pub uvs: Option<[u32; 3]>,
    /// Index into [`SceneDescription::materials`].
    pub material: u32,
}

/// A material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The name in the file, for messages.
    pub name: String,
    /// Diffuse albedo (Kd), in [0, 1]; multiplied by the texture if there is one.
    pub diffuse: Rgb,
    /// Index into [`SceneDescription::textures`] (map_Kd).
    pub diffuse_map: Option<u32>,
    /// The specular lobe.
    pub specular: Specular,
    /// Radiance emitted from the front (Ke); black for all but lights.
    pub emission: Rgb,
}

/// The specular lobe of a material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Specular {
    /// None: the material is purely diffuse.
    None,
    /// Modified Phong lobe.
    Phong {
        /// Maximum fraction of light reflected by the lobe (Ks).
        reflectance: Rgb,
        /// Exponent n of the cosine (Ns); larger values give narrower lobes.
        exponent: f32,
    },
    /// A perfect mirror (illum 3 and 5).
    Mirror {
        /// Fraction of light reflected (Ks).
        reflectance: Rgb,
    },
    /// Smooth glass (illum 7 and 4, 6, 9).
    Glass {
        /// Index of refraction inside, relative to that outside, where the front is (Ni).
        index: f32,
        /// Factor on reflected light (Ks).
        reflectance: Rgb,
        /// Factor on transmitted light (Tf).
        transmittance: Rgb,
    },
}

impl Specular {
    /// True if it neither reflects nor transmits light.
    pub(crate) fn is_black(&self) -> bool {
        match self {
            Self::None => true,
            Self::Phong { reflectance, .. } | Self::Mirror { reflectance } => reflectance.is_black(),
            Self::Glass { reflectance, transmittance, .. } => {
                reflectance.is_black() && transmittance.is_black()
            }
        }
    }
}

/// An 8-bit image that is repeated in both directions.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Texture {
    /// Columns; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// sRGB values, row by row from the top; `width · height` texels.
    pub texels: Vec<[u8; 3]>,
}

/// An explicit light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LightDescription {
    /// A point light: constant intensity in all directions.
    Point {
        /// The position.
        position: Vec3,
        /// Total power Φ in watts, per channel.
        power: Rgb,
    },
    /// A spot light: a point light limited to a cone.
    Spot {
        /// The apex of the cone.
        position: Vec3,
        /// The axis of the cone; any length but zero.
        direction: Vec3,
        /// Angle from the axis within which the intensity is constant, in degrees.
        inner: f32,
        /// Angle from the axis beyond which it is zero, in degrees; `inner <= outer <= 180`, `0 < outer`.
        outer: f32,
        /// Total power Φ in watts, per channel.
        power: Rgb,
    },
    /// A triangle light: emits from its front and reflects nothing.
    Triangle {
        /// The vertices, counter-clockwise seen from the front.
        vertices: [Vec3; 3],
        /// Emitted radiance.
        radiance: Rgb,
    },
}

/// An equirectangular map around the scene. [`Environment`](crate::environment::Environment) states its orientation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnvironmentDescription {
    /// Columns; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// Radiance, finite and not negative, row by row from the top; `width · height` texels.
    pub texels: Vec<Rgb>,
    /// Rotation from the map to world space: a unit quaternion.
    pub rotation: Quat,
}

/// Default render settings of a scene; `None` if the file does not set them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Defaults {
    /// Image width in pixels.
    pub width: Option<u32>,
    /// Image height in pixels.
    pub height: Option<u32>,
    /// Maximum number of bounces.
    pub max_bounces: Option<u32>,
}

impl SceneDescription {
    /// BLAKE3 hash of the content, in hexadecimal. It does not depend on how the files are written.
    ///
    /// A scene without an environment has the hash that it had before scenes could have one.
    pub fn hash(&self) -> String {
        struct HashWriter(blake3::Hasher);
        impl std::io::Write for HashWriter {
            fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
                self.0.update(bytes);
                Ok(bytes.len())
            }
            fn flush(&mut self) -> std::io::Result<()> {
                Ok(())
            }
        }
        let writer = HashWriter(blake3::Hasher::new());
        let Self { camera, meshes, materials, textures, lights, defaults, environment } = self;
        let inside = (camera, meshes, materials, textures, lights, defaults);
        let mut writer = postcard::to_io(&inside, writer).expect("a hasher takes everything");
        if let Some(environment) = environment {
            writer = postcard::to_io(environment, writer).expect("a hasher takes everything");
        }
        writer.0.finalize().to_hex().to_string()
    }
}
