//! **arty-import**: converts glTF files, such as Blender exports, to scene files of the renderer.
//!
//! `cargo arty import room.glb` writes `room.yml`, `room.obj`, `room.mtl` and the textures. Meshes, the camera, point and
//! spot lights, and base and emissive materials are converted. Whatever has no counterpart in the renderer is
//! [listed](Imported::left_out): nothing is dropped silently.
//!
//! | module | contents |
//! |---|---|
//! | `left_out` | the list of what was not converted |
//! | `document` | a glTF file with its buffers and images; names of its items |
//! | `accessor` | arrays of numbers in buffers |
//! | `material` | from metallic-roughness materials to those of MTL files |
//! | `mesh` | triangles in world space |
//! | `camera`, `light` | camera and lights |
//! | `scene` | from the nodes of a scene to all of these |
//! | `text` | scene, OBJ and MTL files as text |
//! | `output` | the files that are written |
//! | [`args`] | command line |

mod accessor;
pub mod args;
mod camera;
mod document;
mod left_out;
mod light;
mod material;
mod mesh;
mod output;
mod scene;
mod text;

pub use output::{Imported, import};
pub use scene::Options;
