//! The files that are written.

use std::io::Write;
use std::path::{Path, PathBuf};

use arty::diagnostic::Diagnostic;
use arty::image::{check_writable, write_aside};

use crate::document::Document;
use crate::scene::{Converted, Options, convert};
use crate::text;

/// A converted scene: its files, and what was left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Names and contents of the files. The last one is the scene file, which refers to all others.
    pub files: Vec<(String, Vec<u8>)>,
    /// What has no counterpart in the renderer, one item each.
    pub left_out: Vec<String>,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of point and spot lights.
    pub lights: usize,
    /// Number of materials.
    pub materials: usize,
}

/// Converts a `.glb` or `.gltf` file. The files are named after `stem`.
///
/// # Errors
/// The file and its first item that is not valid.
pub fn import(source: &Path, stem: &str, options: Options) -> Result<Imported, Diagnostic> {
    let document = Document::read(source)?;
    let Converted { view, lights, parts, materials, left_out } = convert(&document, stem, options)?;
    let source_name = source.file_name().unwrap_or_default().to_string_lossy().replace(char::is_control, "?");
    let triangles = parts.iter().map(|part| part.triangles.len()).sum();
    let number_of_materials = materials.all.len();
    let mut files = materials.images;
    files.push((format!("{stem}.mtl"), text::mtl(&materials.all).into_bytes()));
    files.push((format!("{stem}.obj"), text::obj(stem, &parts, &materials.all).into_bytes()));
    files.push((format!("{stem}.yml"), text::scene(stem, &source_name, &view, &lights).into_bytes()));
    let left_out = left_out.into_vec();
    Ok(Imported { files, left_out, triangles, lights: lights.len(), materials: number_of_materials })
}

impl Imported {
    /// Writes the files into a folder and returns the path of the scene file. Existing files are kept unless `overwrite`
    /// is set.
    ///
    /// # Errors
    /// If a file exists or cannot be written. Nothing has been written if a file exists.
    pub fn write(&self, folder: &Path, overwrite: bool) -> Result<PathBuf, Diagnostic> {
        for (name, _) in &self.files {
            let path = folder.join(name);
            if !overwrite && path.exists() {
                let message = "exists already; --overwrite replaces it, --output writes elsewhere";
                return Err(Diagnostic::about(&path, message));
            }
            check_writable(&path)?;
        }
        let mut last = folder.to_owned();
        for (name, contents) in &self.files {
            last = folder.join(name);
            write_aside(&last, |file| file.write_all(contents))?;
        }
        Ok(last)
    }
}
