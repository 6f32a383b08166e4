//! Writing files, and comparing them with those on disk.

use std::fs;
use std::path::Path;

use arty::image::Image;
use arty::image::exr::{ExrFile, Precision};

/// One file of the folder.
pub(crate) struct OutputFile {
    /// Path relative to the folder of the scenes.
    pub(crate) name: String,
    /// Content.
    pub(crate) content: Content,
}

/// Content of a file. The kinds are compared differently.
pub(crate) enum Content {
    /// Text with Unix line ends; a checkout with other line ends counts as equal.
    Text(String),
    /// A PNG file. Equal if its pixels are, since another release of the encoder may pack them differently.
    Png(Vec<u8>),
    /// An OpenEXR file with this image. Equal if its pixels are.
    Map(Image),
}

/// Writes all files, and replaces existing ones.
pub(crate) fn write(folder: &Path, files: &[OutputFile]) -> std::io::Result<()> {
    for file in files.iter().filter(|file| difference(folder, file).is_some()) {
        let path = folder.join(&file.name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        match &file.content {
            Content::Text(text) => fs::write(path, text)?,
            Content::Png(bytes) => fs::write(path, bytes)?,
            Content::Map(image) => {
                let written = ExrFile::new(image).write(&path, Precision::Full);
                written.map_err(|error| std::io::Error::other(error.to_string()))?;
            }
        }
    }
    Ok(())
}

/// One line for each file that is missing or differs.
pub(crate) fn differences(folder: &Path, files: &[OutputFile]) -> Vec<String> {
    files.iter().filter_map(|file| difference(folder, file)).collect()
}

fn difference(folder: &Path, file: &OutputFile) -> Option<String> {
    let name = &file.name;
    let found = match fs::read(folder.join(name)) {
        Ok(found) => found,
        Err(error) => return Some(format!("scenes/{name}: {error}")),
    };
    match &file.content {
        Content::Text(expected) => {
            let found = String::from_utf8_lossy(&found).replace("\r\n", "\n");
            first_different_line(&found, expected).map(|line| format!("scenes/{name}:{line}: differs"))
        }
        Content::Map(expected) => {
            let file = ExrFile::read(&folder.join(name)).ok().and_then(|file| file.layer(""));
            (file.as_ref() != Some(expected)).then(|| format!("scenes/{name}: the texels differ"))
        }
        Content::Png(expected) => {
            (pixels(&found) != pixels(expected)).then(|| format!("scenes/{name}: the pixels differ"))
        }
    }
}

/// The first line, counted from 1, at which two texts differ.
fn first_different_line(found: &str, expected: &str) -> Option<usize> {
    if found == expected {
        return None;
    }
    let equal = found.lines().zip(expected.lines()).take_while(|(a, b)| a == b).count();
    Some(equal + 1)
}

/// Width, height and pixels of a PNG file; none if it is broken.
fn pixels(png: &[u8]) -> Option<(u32, u32, Vec<u8>)> {
    let image = image::load_from_memory_with_format(png, image::ImageFormat::Png).ok()?.into_rgb8();
    Some((image.width(), image.height(), image.into_raw()))
}
