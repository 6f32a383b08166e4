//! Scene files. This page is the reference of the format.
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
//! defaults: { width: 512, height: 412, max_bounces: 8 }     # optional, each of the three too
//! ```
//!
//! - **`meshes`**: OBJ files. `!rotate` turns counter-clockwise seen from the tip of its axis. `!matrix` is for
//!   column vectors, row by row; its last row is 0, 0, 0, 1. A transform that mirrors leaves outsides outside;
//!   one that flattens is an error.
//! - **`camera`**: `fov` is the angle between the left and the right edge of the image in degrees, in (0, 180).
//!   `eye` and `center` differ, and `up` is not parallel to the direction between them.
//! - **`lights`**: `color` is the power in watts of a `!point_light` and a `!spot_light`, and the radiance of a
//!   `!triangle_light`, whose front is the side from which its corners run counter-clockwise. `inner` and
//!   `outer` are angles from the axis in degrees, 0 ≤ inner ≤ outer, 0 < outer ≤ 180.
//! - **`defaults`**: `width` and `height` from 1 to 65536.
//!
//! Names of files are relative to the file in which they stand; `\` separates folders like `/` does. Text is
//! UTF-8, with or without a byte order mark, with line ends of any system.
//!
//! # OBJ files
//!
//! - Read are `v`, `vt`, `vn`, `f`, `mtllib` and `usemtl`. Weights of vertices are applied, their colours
//!   ignored. `o`, `g` and `s` say nothing here; lines, points and free-form surfaces are left out with a
//!   warning. Anything else is an error. A `\` at the end of a line continues it.
//! - Polygons become fans of triangles around their first corner, so they should be convex.
//! - Indices start from 1; negative ones count back from the line that they stand in. The corners of a face
//!   all have the same parts (`v`, `v/vt`, `v//vn` or `v/vt/vn`). A triangle without normals, or with one of
//!   length zero, is shaded flat.
//! - A material that none of the libraries defines is an error. Faces before any `usemtl`, and all faces of a
//!   file without `mtllib`, become grey (diffuse 0.5), with a warning.
//!
//! # MTL files
//!
//! | statement | meaning | if missing |
//! |---|---|---|
//! | `Kd r g b` | diffuse reflectance | white with a `map_Kd`, else black |
//! | `map_Kd image` | texture, multiplied with `Kd`; its options are ignored with a warning | no texture |
//! | `Ks r g b` | specular reflectance | white for glass and for `illum 5`, else black |
//! | `Ns n` | exponent of the Phong lobe | 1, with a warning |
//! | `Ke r g b` | radiance emitted from the front | black |
//! | `Ni n` | index of refraction | 1.5, with a warning |
//! | `Tf r g b` | factor on what glass lets through | white |
//! | `illum n` | 5: mirror `Ks`; 3: diffuse `Kd` and mirror `Ks`; 4, 6, 7, 9: glass with `Ni`, `Ks`, `Tf`; all others: diffuse `Kd` and Phong lobe `Ks`, `Ns` | diffuse and Phong lobe |
//!
//! Colours may be written with one number for all channels. No value may be negative. No material reflects
//! more than it receives: factors of mirrors and glass are limited to 1, and where `Kd` (times the brightest
//! texel) and `Ks` together exceed 1, both are divided by their largest sum, with a warning. Other statements
//! are ignored, with a warning if they would change the image.
//!
//! # Images
//!
//! PNG, JPEG, BMP and TGA of at most 16384 × 16384 pixels. They become 8-bit RGB: 16 bits are reduced, alpha is
//! dropped. Values are taken to have the sRGB transfer curve.

mod checks;
mod keys;
mod materials;
mod mtl;
mod obj;
mod text;
mod texture;
mod transform;
mod warnings;

use std::collections::HashMap;
use std::path::Path;

use self::keys::SceneFile;
use self::materials::Materials;
use self::text::relative_to;
use self::transform::Placement;
use self::warnings::Warnings;
use super::SceneDescription;
use crate::diagnostic::Diagnostic;
use crate::input::Reference;
use crate::yaml;

/// A scene as read, and what there is to say about its files.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub description: SceneDescription,
    /// What is probably not meant, but could be read; each thing once.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a scene file and all files that it names.
///
/// # Errors
/// The first thing found that makes the scene unusable: the file that is wrong (it need not be `path`), the line
/// if one is to blame, and what was expected.
pub fn load(path: &Path) -> Result<Loaded, Diagnostic> {
    let (scene, text) = yaml::read::<SceneFile>(path)?;
    let mut materials = Materials::default();
    let mut warnings = Warnings::default();
    let mut meshes = Vec::with_capacity(scene.meshes.len());
    // A scene may have one file thousands of times, so its name is looked up once.
    let mut lines = HashMap::new();
    for mesh in &scene.meshes {
        let file = relative_to(path, &mesh.file);
        let line = *lines.entry(&mesh.file).or_insert_with(|| line_that_names(&mesh.file, &text));
        let named = Reference { file: path.to_owned(), line };
        let placement = Placement::new(mesh.transform);
        meshes.push(obj::read(&file, &named, &placement, &mut materials, &mut warnings)?);
    }
    let (materials, textures) = materials.into_parts();
    let description = SceneDescription {
        camera: scene.camera,
        meshes,
        materials,
        textures,
        lights: scene.lights,
        defaults: scene.defaults,
    };
    Ok(Loaded { description, warnings: warnings.into_vec() })
}

/// The line of a scene file that names `file`.
///
/// The parser keeps no positions, so this looks for the text. A name that was written with escapes is not found.
fn line_that_names(file: &str, text: &str) -> Option<usize> {
    let names_it = |line: &str| !line.trim_start().starts_with('#') && line.contains(file);
    text.lines().position(names_it).map(|index| index + 1)
}
