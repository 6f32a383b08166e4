//! The JSON schema of scene files, for editors. It does not know tags, and not what the values of several keys have to do
//! with each other.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::path::Path;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

use super::checks::{Colour, NonNegative, Number};
use super::environment::EnvironmentEntry;
use super::keys::SceneFile;
use super::transform::{Matrix, Rotation, RotationKeys, Scale};
use crate::diagnostic::Diagnostic;
use crate::yaml;

/// The schema of a scene file.
pub fn schema() -> Schema {
    schemars::schema_for!(SceneFile)
}

/// Reads a scene file, without the files it refers to.
///
/// # Errors
/// As [`load`](super::load).
pub fn check(path: &Path) -> Result<(), Diagnostic> {
    yaml::read::<SceneFile>(path).map(drop)
}

/// Implements the schema of a type that is read as another one.
macro_rules! has_schema_of {
    ($type:ty, $keys:ty) => {
        impl schemars::JsonSchema for $type {
            fn inline_schema() -> bool {
                true
            }
            fn schema_name() -> std::borrow::Cow<'static, str> {
                <$keys as schemars::JsonSchema>::schema_name()
            }
            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                <$keys as schemars::JsonSchema>::json_schema(generator)
            }
        }
    };
}
pub(super) use has_schema_of;

/// Implements the schema of a type as it stands here.
macro_rules! has_schema {
    ($type:ty, $name:literal, $schema:tt) => {
        impl JsonSchema for $type {
            fn inline_schema() -> bool {
                true
            }
            fn schema_name() -> Cow<'static, str> {
                $name.into()
            }
            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!($schema)
            }
        }
    };
}

/// The name of an OBJ file in the list of meshes.
pub(super) struct MeshFile;
/// The name of an environment's map: any scalar, but not `null`, which is no file.
struct MapFile;
/// One factor of a scaling. Editors read scalars with a tag as texts.
struct Factor;
/// A field of view in degrees.
pub(super) struct FieldOfView;
/// The inner angle of a cone in degrees.
pub(super) struct InnerAngle;
/// The outer angle of a cone in degrees.
pub(super) struct OuterAngle;
/// A number of pixels.
pub(super) struct Pixels;
/// A number of bounces.
pub(super) struct Bounces;

has_schema!(MeshFile, "MeshFile", { "type": "string", "minLength": 1 });
has_schema!(MapFile, "MapFile", { "type": ["string", "number", "boolean"] });
has_schema!(FieldOfView, "FieldOfView", { "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 180 });
has_schema!(InnerAngle, "InnerAngle", { "type": "number", "minimum": 0, "maximum": 180 });
has_schema!(OuterAngle, "OuterAngle", { "type": "number", "exclusiveMinimum": 0, "maximum": 180 });
has_schema!(Pixels, "Pixels", { "type": "integer", "minimum": 1, "maximum": 65536 });
has_schema!(Bounces, "Bounces", { "type": "integer", "minimum": 0, "maximum": 4_294_967_295_u32 });
// The largest number that rounds to a finite one in single precision.
has_schema!(Number, "Number", {
    "type": "number", "exclusiveMinimum": -3.402_823_567_797_336_6e38, "exclusiveMaximum": 3.402_823_567_797_336_6e38
});
has_schema!(NonNegative, "NonNegative", {
    "type": "number", "minimum": 0, "exclusiveMaximum": 3.402_823_567_797_336_6e38
});

has_schema!(Factor, "Factor", { "type": ["number", "string"], "pattern": "^[-+.0-9eE]+$" });
has_schema_of!(Scale, Either<Factor, [Number; 3]>);
has_schema_of!(Rotation, RotationKeys);
has_schema_of!(Matrix, [Number; 16]);
has_schema_of!(EnvironmentEntry, Either<EnvironmentMap, EnvironmentColour>);

/// A value of either of two types, in a schema.
pub(super) struct Either<A, B>(PhantomData<(A, B)>);

impl<A: JsonSchema, B: JsonSchema> JsonSchema for Either<A, B> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("{} or {}", A::schema_name(), B::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (one, other) = (generator.subschema_for::<A>(), generator.subschema_for::<B>());
        json_schema!({ "anyOf": [one, other] })
    }
}

/// The keys of an environment from a file.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "only its schema is used")]
struct EnvironmentMap {
    /// Name of an OpenEXR or Radiance HDR image, relative to this file.
    file: MapFile,
    /// Rotation from the map to world space.
    rotate: Option<Rotation>,
    /// Factor on all radiances.
    scale: Option<NonNegative>,
}

/// The keys of a constant environment.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "only its schema is used")]
struct EnvironmentColour {
    /// Radiance from every direction.
    color: Colour,
}
