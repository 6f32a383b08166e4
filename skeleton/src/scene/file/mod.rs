//! Scene files: the reference of the format.
//!
//! # The scene file
//!
//! YAML, at most 4 MiB. A key that is not listed here is an error.
//!
//! ```yaml
//! meshes:                       # may be empty: []
//!   - "cornell_box.obj"
//!   - file: "bunny.obj"
//!     transform:                # optional; applied in the order given
//!       - !scale 2              # or !scale [1, 2, 3]
//!       - !rotate { axis: [0, 1, 0], degrees: 30 }
//!       - !translate [0, 1, 0]
//!       - !matrix [1,0,0,0,  0,1,0,0,  0,0,1,0,  0,0,0,1]
//! camera: !perspective_camera { eye: [0, 1, 4], center: [0, 1, 0], up: [0, 1, 0], fov: 40 }
//! lights:                       # optional
//!   - !point_light { position: [0, 2, 0], color: [10, 10, 10] }
//!   - !spot_light { position: [0, 2, 0], direction: [0, -1, 0], inner: 20, outer: 30, color: [10, 10, 10] }
//!   - !triangle_light { v0: [0, 2, 0], v1: [1, 2, 0], v2: [0, 2, 1], color: [5, 5, 5] }
//! environment: { file: "sky.exr", rotate: { axis: [0, 1, 0], degrees: 30 }, scale: 2 }     # optional; or { color: [1, 1, 1] }
//! defaults: { width: 512, height: 412, max_bounces: 8 }     # optional, each of the three too
//! ```
//!
//! - **`meshes`**: OBJ files. `!rotate` rotates counter-clockwise about the axis, seen from its tip. `!matrix` is an affine
//!   matrix for column vectors, in row-major order; its last row must be 0, 0, 0, 1. Reflections keep the orientation of
//!   closed meshes; singular transforms are an error.
//! - **`camera`**: `fov` is the horizontal field of view in degrees, in (0, 180). `eye` and `center` must differ, and `up`
//!   must not be parallel to the view direction.
//! - **`lights`**: `color` is the power in watts of a `!point_light` and a `!spot_light`, and the radiance of a
//!   `!triangle_light`, whose front is the side from which its vertices are counter-clockwise. `inner` and `outer` are angles
//!   from the axis in degrees, 0 ≤ inner ≤ outer, 0 < outer ≤ 180.
//! - **`environment`**: light from outside of the scene: a constant radiance `color`, or an equirectangular map in a `file`,
//!   OpenEXR or Radiance HDR, of at most 2²⁵ texels. `rotate` (as in a `transform`) and the factor `scale` are optional.
//!   [`Environment`](crate::environment::Environment) states the orientation of the map.
//! - **`defaults`**: `width` and `height` from 1 to 65536.
//!
//! File names are relative to the file that contains them; both `/` and `\` separate folders. Text is UTF-8, with or
//! without a byte order mark, with the line endings of any system.
//!
//! # OBJ files
//!
//! - `v`, `vt`, `vn`, `f`, `mtllib` and `usemtl` are read. Vertex weights are applied, vertex colours ignored. `o`, `g` and
//!   `s` have no effect; lines, points and free-form surfaces are ignored with a warning. Anything else is an error. A `\` at
//!   the end of a line continues it.
//! - Polygons are triangulated as fans around their first vertex, so they should be convex.
//! - Indices start at 1; negative indices count backwards from the current line. All corners of a face must have the same
//!   form (`v`, `v/vt`, `v//vn` or `v/vt/vn`). Triangles without normals, or with a normal of length zero, are shaded flat.
//! - A material that no library defines is an error. Faces before any `usemtl`, and all faces of a file without `mtllib`, get
//!   a grey diffuse material (albedo 0.5), with a warning.
//!
//! # MTL files
//!
//! | statement | meaning | if missing |
//! |---|---|---|
//! | `Kd r g b` | diffuse albedo | white with a `map_Kd`, else black |
//! | `map_Kd image` | texture, multiplied by `Kd`; options are ignored with a warning | no texture |
//! | `Ks r g b` | specular reflectance | white for glass and for `illum 5`, else black |
//! | `Ns n` | exponent of the Phong lobe | 1, with a warning |
//! | `Ke r g b` | radiance emitted from the front | black |
//! | `Ni n` | index of refraction | 1.5, with a warning |
//! | `Tf r g b` | factor on light transmitted by glass | white |
//! | `illum n` | 5: mirror `Ks`; 3: diffuse `Kd` and mirror `Ks`; 4, 6, 7, 9: glass with `Ni`, `Ks`, `Tf`; all others: diffuse `Kd` and Phong lobe `Ks`, `Ns` | diffuse and Phong lobe |
//!
//! A colour can be given as one number for all channels. Values must not be negative. Materials conserve energy: factors of
//! mirrors and glass are limited to 1, and if the sum of `Kd` (times the brightest texel) and `Ks` exceeds 1 in a channel,
//! both are divided by the largest sum, with a warning. Other statements are ignored, with a warning if they would change
//! the image.
//!
//! # Images
//!
//! PNG, JPEG, BMP and TGA of at most 16384 × 16384 pixels, converted to 8-bit RGB without alpha. Values are interpreted as
//! sRGB.

mod checks;
mod environment;
mod keys;
mod materials;
mod mtl;
mod obj;
#[cfg(feature = "schema")]
mod schema;
mod text;
mod texture;
mod transform;
mod warnings;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use self::environment::EnvironmentEntry;
use self::keys::SceneFile;
use self::materials::Materials;
#[cfg(feature = "schema")]
pub use self::schema::{check, schema};
use self::text::relative_to;
use self::transform::Placement;
use self::warnings::Warnings;
use super::SceneDescription;
use crate::diagnostic::Diagnostic;
use crate::input::Reference;
use crate::yaml;

/// A scene that was read, with warnings about its files.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The description of the scene.
    pub description: SceneDescription,
    /// Warnings about probably unintended input; each is given once.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a scene file and all files it refers to.
///
/// # Errors
/// The first error found: the file (not necessarily `path`), the line if the error is in a single one, and what was
/// expected.
pub fn load(path: &Path) -> Result<Loaded, Diagnostic> {
    let (scene, text) = yaml::read::<SceneFile>(path)?;
    let mut materials = Materials::default();
    let mut warnings = Warnings::default();
    let mut meshes = Vec::with_capacity(scene.meshes.len());
    // A scene may use the same file thousands of times, so its line is looked up once.
    let mut lines = HashMap::new();
    for mesh in &scene.meshes {
        let file = file_named(&mesh.file, path, &text)?;
        let line = *lines.entry(&mesh.file).or_insert_with(|| line_that_names(&mesh.file, &text));
        let named = Reference { file: path.to_owned(), line };
        let placement = Placement::new(mesh.transform);
        meshes.push(obj::read(&file, &named, &placement, &mut materials, &mut warnings)?);
    }
    let (materials, textures) = materials.into_parts();
    let environment = match scene.environment {
        None => None,
        Some(EnvironmentEntry::Constant(radiance)) => Some(environment::constant(radiance)),
        Some(EnvironmentEntry::Map { file: name, rotation, scale }) => {
            let file = file_named(&name, path, &text)?;
            let named = Reference { file: path.to_owned(), line: line_that_names(&name, &text) };
            Some(environment::read(&file, &named, rotation, scale)?)
        }
    };
    let description = SceneDescription {
        camera: scene.camera,
        meshes,
        materials,
        textures,
        lights: scene.lights,
        defaults: scene.defaults,
        environment,
    };
    Ok(Loaded { description, warnings: warnings.into_vec() })
}

/// The file that a scene file calls `name`.
fn file_named(name: &str, scene: &Path, text: &str) -> Result<PathBuf, Diagnostic> {
    if name.contains(char::is_control) {
        return Err(escaped(scene, name, text));
    }
    Ok(relative_to(scene, name))
}

/// The error for a name with a control character: in double quotes, `\t` of a Windows path is a tab.
fn escaped(path: &Path, file: &str, text: &str) -> Diagnostic {
    let may_name_it = |line: &str| line.contains('"') && line.contains('\\');
    let line = text.lines().position(may_name_it).map(|index| index + 1);
    let message = format!(
        "the file name `{file}` contains a tab or another control character: in double quotes, `\\` begins an escape; \
         write `/`, or use single quotes"
    );
    Diagnostic { file: path.to_owned(), line, message }
}

/// The line of a scene file that names `file`.
///
/// The parser does not provide positions, so this searches the text. A name written with escapes is not found.
fn line_that_names(file: &str, text: &str) -> Option<usize> {
    let names_it = |line: &str| !line.trim_start().starts_with('#') && line.contains(file);
    text.lines().position(names_it).map(|index| index + 1)
}
