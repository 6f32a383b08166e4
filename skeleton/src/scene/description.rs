//! What a scene is made of, as read: plain data, with nothing worked out yet.
//!
//! A description has everything that [`Scene`](super::Scene) is built from, and nothing else. It can be sent
//! to another process, and its [hash](SceneDescription::hash) says whether two scenes are the same, however
//! their files were written.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::camera::CameraDescription;
use crate::math::Rgb;

/// A whole scene as data. Lengths are in scene units, positions in world space.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SceneDescription {
    /// Where the picture is taken from.
    pub camera: CameraDescription,
    /// All surfaces, but for those of triangle lights.
    pub meshes: Vec<Mesh>,
    /// What [`MeshTriangle::material`] refers to.
    pub materials: Vec<Material>,
    /// What [`Material::diffuse_map`] refers to.
    pub textures: Vec<Texture>,
    /// Lights given by themselves. Emissive materials make more of them.
    pub lights: Vec<LightDescription>,
    /// How the scene wants to be rendered unless told otherwise.
    pub defaults: Defaults,
}

/// Triangles that share their lists of vertices.
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
    /// Indices into [`Mesh::normals`]; without them the triangle is shaded flat.
    pub normals: Option<[u32; 3]>,
    /// Indices into [`Mesh::uvs`].
    pub uvs: Option<[u32; 3]>,
    /// Index into [`SceneDescription::materials`].
    pub material: u32,
}

/// What a surface does with light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Its name in the file, for messages.
    pub name: String,
    /// Diffuse reflectance (Kd), in [0, 1]; multiplied with the map if there is one.
    pub diffuse: Rgb,
    /// Index into [`SceneDescription::textures`] (map_Kd).
    pub diffuse_map: Option<u32>,
    /// What is reflected or let through beside the diffuse part.
    pub specular: Specular,
    /// Radiance emitted from the front (Ke); black for all but lights.
    pub emission: Rgb,
}

/// The part of a material that is not diffuse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Specular {
    /// The material is diffuse only.
    None,
    /// Modified Phong lobe.
    Phong {
        /// Share of the light that the lobe reflects at most (Ks).
        reflectance: Rgb,
        /// Exponent n of the cosine (Ns); the greater, the narrower.
        exponent: f32,
    },
    /// A perfect mirror (illum 3 and 5).
    Mirror {
        /// Share of the light that is reflected (Ks).
        reflectance: Rgb,
    },
    /// Smooth glass (illum 7 and 4, 6, 9).
    Glass {
        /// Index of refraction behind the front, relative to that before it (Ni).
        index: f32,
        /// Factor on what is reflected (Ks).
        reflectance: Rgb,
        /// Factor on what is let through (Tf).
        transmittance: Rgb,
    },
}

impl Specular {
    /// True if it neither reflects nor lets through any light.
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

/// An 8-bit image wrapped over a surface, repeating in both directions.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Texture {
    /// Columns; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// Values with the sRGB transfer curve, row by row from the top, `width · height` of them.
    pub texels: Vec<[u8; 3]>,
}

/// A light that is given by itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LightDescription {
    /// Sends the same intensity in every direction.
    Point {
        /// Where it is.
        position: Vec3,
        /// Total power Φ in watts, per channel.
        power: Rgb,
    },
    /// Sends light into a cone only.
    Spot {
        /// The apex of the cone.
        position: Vec3,
        /// The axis of the cone; any length but zero.
        direction: Vec3,
        /// Angle from the axis up to which the intensity is constant, in degrees.
        inner: f32,
        /// Angle from the axis from which on it is zero, in degrees; `inner <= outer <= 180`, `0 < outer`.
        outer: f32,
        /// Total power Φ in watts, per channel.
        power: Rgb,
    },
    /// A triangle that emits from its front and reflects nothing.
    Triangle {
        /// Its corners, counter-clockwise seen from the front.
        vertices: [Vec3; 3],
        /// Emitted radiance.
        radiance: Rgb,
    },
}

/// Settings that a scene file may suggest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Defaults {
    /// Image width in pixels.
    pub width: Option<u32>,
    /// Image height in pixels.
    pub height: Option<u32>,
    /// Largest number of scattering events of a path.
    pub max_bounces: Option<u32>,
}

impl SceneDescription {
    /// BLAKE3 over the content, in hexadecimal: equal for equal content, whatever the files looked like.
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
        let writer = postcard::to_io(self, writer).expect("a hasher takes everything");
        writer.0.finalize().to_hex().to_string()
    }
}
