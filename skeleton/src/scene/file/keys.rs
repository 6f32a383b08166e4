//! The keys of a scene file, and validation of their values.

use std::fmt;

use glam::{DAffine3, Vec3};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

use super::checks::{Colour, Number, Vector, bounces, field_of_view, mapping, pixels};
use super::environment::EnvironmentEntry;
use super::transform::{Step, compose};
use crate::scene::{CameraDescription, Defaults, LightDescription};

/// The contents of a scene file, without the files it refers to.
pub(super) struct SceneFile {
    pub(super) meshes: Vec<MeshEntry>,
    pub(super) camera: CameraDescription,
    pub(super) lights: Vec<LightDescription>,
    pub(super) environment: Option<EnvironmentEntry>,
    pub(super) defaults: Defaults,
}

/// One entry of `meshes`.
pub(super) struct MeshEntry {
    /// The file name as written, relative to the scene file.
    pub(super) file: String,
    /// Invertible.
    pub(super) transform: DAffine3,
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Scene"))]
#[serde(deny_unknown_fields)]
struct SceneKeys {
    /// OBJ files; may be empty.
    meshes: Vec<MeshEntry>,
    /// The camera: `!perspective_camera`.
    camera: Camera,
    /// Lights without a mesh: `!point_light`, `!spot_light`, `!triangle_light`.
    lights: Option<Vec<Light>>,
    /// Light from outside of the scene.
    environment: Option<EnvironmentEntry>,
    /// Size of the image and maximum number of bounces.
    defaults: Option<DefaultsKeys>,
}

impl<'de> Deserialize<'de> for SceneFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a mapping with the keys `meshes`, `camera`, `lights`, `environment` and `defaults`";
        mapping::<_, SceneKeys, _>(deserializer, expected)
    }
}

impl TryFrom<SceneKeys> for SceneFile {
    type Error = String;
    fn try_from(keys: SceneKeys) -> Result<Self, String> {
        let Camera::Perspective(PerspectiveCamera(camera)) = keys.camera;
        let lights = keys.lights.unwrap_or_default().into_iter().map(Light::description).collect();
        let defaults = keys.defaults.map_or_else(Defaults::default, |defaults| Defaults {
            width: defaults.width,
            height: defaults.height,
            max_bounces: defaults.max_bounces,
        });
        Ok(Self { meshes: keys.meshes, camera, lights, environment: keys.environment, defaults })
    }
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Mesh"))]
#[serde(deny_unknown_fields)]
struct MeshKeys {
    /// Name of an OBJ file, relative to this file.
    file: String,
    /// Applied in this order: `!scale`, `!rotate`, `!translate`, `!matrix`.
    transform: Option<Vec<Step>>,
}

impl<'de> Deserialize<'de> for MeshEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct MeshVisitor;
        impl<'de> Visitor<'de> for MeshVisitor {
            type Value = MeshEntry;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of an OBJ file, or a mapping with the keys `file` and `transform`")
            }
            fn visit_str<E: Error>(self, file: &str) -> Result<MeshEntry, E> {
                Ok(MeshEntry { file: file.to_owned(), transform: DAffine3::IDENTITY })
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<MeshEntry, A::Error> {
                let keys = MeshKeys::deserialize(MapAccessDeserializer::new(map))?;
                let transform = compose(&keys.transform.unwrap_or_default()).map_err(A::Error::custom)?;
                Ok(MeshEntry { file: keys.file, transform })
            }
        }
        deserializer.deserialize_any(MeshVisitor)
    }
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(untagged))]
enum Camera {
    #[serde(rename = "perspective_camera")]
    Perspective(PerspectiveCamera),
}

struct PerspectiveCamera(CameraDescription);

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct CameraKeys {
    /// Position of the pinhole.
    eye: Vector,
    /// The point shown in the centre of the image.
    center: Vector,
    /// The up direction.
    up: Vector,
    /// Horizontal field of view in degrees.
    #[serde(deserialize_with = "field_of_view")]
    #[cfg_attr(feature = "schema", schemars(with = "super::schema::FieldOfView"))]
    fov: f32,
}

impl<'de> Deserialize<'de> for PerspectiveCamera {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a mapping with the keys `eye`, `center`, `up` and `fov`";
        mapping::<_, CameraKeys, _>(deserializer, expected)
    }
}

impl TryFrom<CameraKeys> for PerspectiveCamera {
    type Error = String;
    fn try_from(keys: CameraKeys) -> Result<Self, String> {
        let (eye, center, up) = (keys.eye.single(), keys.center.single(), keys.up.single());
        let view = (center.as_dvec3() - eye.as_dvec3())
            .try_normalize()
            .ok_or("`eye` and `center` must not be the same point")?;
        let upwards = up.as_dvec3().try_normalize().ok_or("`up` must not be zero")?;
        // The sine of the angle between them. Below this, rounding would determine the roll of the camera.
        if view.cross(upwards).length() < 1e-5 {
            return Err("`up` must not be parallel to the direction from `eye` to `center`".into());
        }
        Ok(Self(CameraDescription { eye, center, up, fov: keys.fov }))
    }
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(untagged))]
enum Light {
    #[serde(rename = "point_light")]
    Point(PointLight),
    #[serde(rename = "spot_light")]
    Spot(SpotLight),
    #[serde(rename = "triangle_light")]
    Triangle(TriangleLight),
}

impl Light {
    fn description(self) -> LightDescription {
        match self {
            Self::Point(PointLight(light))
            | Self::Spot(SpotLight(light))
            | Self::Triangle(TriangleLight(light)) => light,
        }
    }
}

struct PointLight(LightDescription);

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct PointLightKeys {
    /// The position.
    position: Vector,
    /// Power in watts.
    color: Colour,
}

impl<'de> Deserialize<'de> for PointLight {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        mapping::<_, PointLightKeys, _>(deserializer, "a mapping with the keys `position` and `color`")
    }
}

impl TryFrom<PointLightKeys> for PointLight {
    type Error = String;
    fn try_from(keys: PointLightKeys) -> Result<Self, String> {
        Ok(Self(LightDescription::Point { position: keys.position.single(), power: keys.color.into() }))
    }
}

struct SpotLight(LightDescription);

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct SpotLightKeys {
    /// The position.
    position: Vector,
    /// The axis of the cone.
    direction: Vector,
    /// Angle from the axis up to which the intensity is constant, in degrees.
    #[cfg_attr(feature = "schema", schemars(with = "super::schema::InnerAngle"))]
    inner: Number,
    /// Angle from the axis beyond which it is zero, in degrees.
    #[cfg_attr(feature = "schema", schemars(with = "super::schema::OuterAngle"))]
    outer: Number,
    /// Power in watts.
    color: Colour,
}

impl<'de> Deserialize<'de> for SpotLight {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a mapping with the keys `position`, `direction`, `inner`, `outer` and `color`";
        mapping::<_, SpotLightKeys, _>(deserializer, expected)
    }
}

impl TryFrom<SpotLightKeys> for SpotLight {
    type Error = String;
    fn try_from(keys: SpotLightKeys) -> Result<Self, String> {
        let direction = keys.direction.single();
        if direction == Vec3::ZERO {
            return Err("`direction` must not be zero".into());
        }
        let (inner, outer) = (keys.inner.get() as f32, keys.outer.get() as f32);
        if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= 180.0) {
            return Err(format!(
                "`inner` is {inner} and `outer` is {outer}; they must satisfy 0 <= inner <= outer and 0 < outer <= 180 \
                 (degrees from the axis)"
            ));
        }
        let (position, power) = (keys.position.single(), keys.color.into());
        Ok(Self(LightDescription::Spot { position, direction, inner, outer, power }))
    }
}

struct TriangleLight(LightDescription);

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct TriangleLightKeys {
    v0: Vector,
    v1: Vector,
    v2: Vector,
    /// Radiance emitted from the front, where the vertices are counter-clockwise.
    color: Colour,
}

impl<'de> Deserialize<'de> for TriangleLight {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a mapping with the keys `v0`, `v1`, `v2` and `color`";
        mapping::<_, TriangleLightKeys, _>(deserializer, expected)
    }
}

impl TryFrom<TriangleLightKeys> for TriangleLight {
    type Error = String;
    fn try_from(keys: TriangleLightKeys) -> Result<Self, String> {
        let vertices = [keys.v0.single(), keys.v1.single(), keys.v2.single()];
        let [a, b, c] = vertices.map(|vertex| vertex.as_dvec3());
        let (ab, ac) = (b - a, c - a);
        // For collinear vertices the area may not be exactly zero, due to rounding.
        if ab.cross(ac).length() <= 1e-7 * ab.length() * ac.length() || b == c {
            return Err("the triangle has no area: `v0`, `v1` and `v2` are collinear".into());
        }
        Ok(Self(LightDescription::Triangle { vertices, radiance: keys.color.into() }))
    }
}

#[derive(Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Defaults"))]
#[serde(deny_unknown_fields)]
struct DefaultsKeys {
    /// Width in pixels.
    #[serde(default, deserialize_with = "pixels")]
    #[cfg_attr(feature = "schema", schemars(with = "super::schema::Pixels"))]
    width: Option<u32>,
    /// Height in pixels.
    #[serde(default, deserialize_with = "pixels")]
    #[cfg_attr(feature = "schema", schemars(with = "super::schema::Pixels"))]
    height: Option<u32>,
    /// Maximum number of bounces.
    #[serde(default, deserialize_with = "bounces")]
    #[cfg_attr(feature = "schema", schemars(with = "super::schema::Bounces"))]
    max_bounces: Option<u32>,
}

/// The schemas of types that are read as mappings of these keys.
#[cfg(feature = "schema")]
mod schemas {
    use super::super::schema::has_schema_of;
    use super::*;

    has_schema_of!(SceneFile, SceneKeys);
    has_schema_of!(PerspectiveCamera, CameraKeys);
    has_schema_of!(PointLight, PointLightKeys);
    has_schema_of!(SpotLight, SpotLightKeys);
    has_schema_of!(TriangleLight, TriangleLightKeys);
    has_schema_of!(MeshEntry, super::super::schema::Either<super::super::schema::MeshFile, MeshKeys>);
}
