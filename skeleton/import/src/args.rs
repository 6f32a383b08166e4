//! The command line.

use std::path::PathBuf;

use arty::diagnostic::Diagnostic;
use arty::scene::{Scene, file};
use clap::Parser;

use crate::{Options, import};

/// Converts a glTF file, such as a Blender export, to a scene file with meshes, materials and textures.
///
/// Everything that the renderer has no counterpart for is listed.
#[derive(Debug, Parser)]
#[command(name = "arty import", version, max_term_width = 100, after_help = EXAMPLE)]
pub struct Args {
    /// The file: .glb, or .gltf with the files beside it
    #[arg(value_name = "FILE.glb")]
    pub source: PathBuf,

    /// The scene file to write; meshes, materials and textures are written beside it; without it, `FILE.yml` in the
    /// current folder
    #[arg(short, long, value_name = "SCENE.yml")]
    pub output: Option<PathBuf>,

    /// Replace existing files
    #[arg(long)]
    pub overwrite: bool,

    /// Lumens per watt: light intensities are in candela in glTF, in watts here
    ///
    /// Blender's exporter multiplies its watts by 683 ("Standard" lighting mode). Use 1 for files whose intensities are in
    /// watts ("Unitless").
    #[arg(long, value_name = "N", default_value_t = Options::default().lumens_per_watt, value_parser = positive)]
    pub lumens_per_watt: f64,
}

const EXAMPLE: &str = "\
Example: arty import room.glb && arty room.yml
In Blender: File > Export > glTF 2.0, with Include > Cameras and Punctual Lights.";

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "must be a number above 0".to_owned())
}

/// Runs the command and returns what to print: the written scene first, then what was left out.
///
/// # Errors
/// If the file is not valid, or a file cannot be written.
pub fn run(args: &Args) -> Result<Vec<String>, Diagnostic> {
    let default = || PathBuf::from(args.source.file_name().unwrap_or_default()).with_extension("yml");
    let output = args.output.clone().unwrap_or_else(default);
    let stem = output.file_stem().and_then(|stem| stem.to_str()).filter(|stem| is_plain(stem));
    let Some(stem) = stem.filter(|_| output.extension().is_some_and(|extension| extension == "yml")) else {
        let message = "must be a file name that ends in .yml, without white space or `#`: give another one with --output";
        return Err(Diagnostic::about(&output, message));
    };
    let options = Options { lumens_per_watt: args.lumens_per_watt };
    let imported = import(&args.source, stem, options)?;
    let folder = output.parent().unwrap_or(std::path::Path::new(""));
    let written = imported.write(folder, args.overwrite)?;
    let counted =
        |number: usize, noun: &str| format!("{number} {noun}{}", if number == 1 { "" } else { "s" });
    let mut lines = vec![format!(
        "saved {}: {}, {}, {}",
        written.display(),
        counted(imported.triangles, "triangle"),
        counted(imported.materials, "material"),
        counted(imported.lights, "point or spot light")
    )];
    if !imported.left_out.is_empty() {
        lines.push("not imported:".to_owned());
        lines.extend(imported.left_out.iter().map(|item| format!("  {item}")));
    }
    // What the renderer says about the files.
    let loaded = file::load(&written)?;
    let scene = Scene::new(&loaded.description);
    lines.extend(loaded.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.extend(scene.warnings().iter().map(|warning| format!("warning: {warning}")));
    if !scene.features().has_lights() {
        lines.push("warning: the scene has no lights: its image will be black".to_owned());
    }
    Ok(lines)
}

/// True if MTL and OBJ files can name a file of this stem.
fn is_plain(stem: &str) -> bool {
    !stem.is_empty()
        && !stem.contains(|letter: char| letter.is_whitespace() || letter.is_control() || letter == '#')
}
