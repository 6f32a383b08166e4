//! Statistics of a scene (`--features`).

use std::fmt::Write as _;
use std::io::{self, Write as _};

use super::args::Args;
use super::plan::{max_bounces, size};
use crate::scene::file::Loaded;
use crate::scene::{EnvironmentDescription, Scene};

/// Prints the statistics and warnings of a scene.
pub(super) fn print(args: &Args, loaded: &Loaded, scene: &Scene) {
    // A closed pipe is not an error.
    let _ = io::stdout().write_all(text(args, loaded, scene).as_bytes());
}

fn text(args: &Args, loaded: &Loaded, scene: &Scene) -> String {
    let description = &loaded.description;
    let (width, height) = size(args, scene.defaults());
    let vertices: usize = description.meshes.iter().map(|mesh| mesh.positions.len()).sum();
    let texels: usize = description.textures.iter().map(|texture| texture.texels.len()).sum();
    let mut rows = vec![
        ("scene", args.scene.display().to_string()),
        ("content hash", description.hash()),
        ("image size", format!("{width} x {height}")),
        ("max bounces", max_bounces(args, scene.defaults()).to_string()),
        ("meshes", format!("{}  ({vertices} vertices)", description.meshes.len())),
        ("materials", description.materials.len().to_string()),
    ];
    if !description.textures.is_empty() {
        rows.push(("textures", format!("{}  ({texels} texels)", description.textures.len())));
    }
    if let Some(EnvironmentDescription { width, height, .. }) = &description.environment {
        rows.push(("environment map", format!("{width} x {height} texels")));
    }
    let mut text = String::new();
    for (name, value) in rows {
        // Aligned with the rows of the features. Writing to a string cannot fail.
        let _ = writeln!(text, "{name:<19}{value}");
    }
    let _ = writeln!(text, "{}", scene.features());
    loaded.warnings.iter().for_each(|warning| _ = writeln!(text, "warning: {warning}"));
    scene.warnings().iter().for_each(|warning| _ = writeln!(text, "warning: {warning}"));
    text
}
