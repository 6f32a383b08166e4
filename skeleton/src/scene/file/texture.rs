//! Texture images.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use image::{ImageFormat, ImageReader, Limits};

use crate::diagnostic::Diagnostic;
use crate::input::{self, Reference};
use crate::scene::Texture;

/// Maximum width and height.
const MAX_SIDE: u32 = 16384;
/// Memory limit for decoding: an image of the maximum size in 8-bit RGB, and some more.
const MAX_DECODED_BYTES: u64 = 1 << 30;
const MAX_FILE_BYTES: u64 = 1 << 30;

/// The textures read so far; each file is read once.
#[derive(Default)]
pub(super) struct Textures {
    textures: Vec<Texture>,
    indices: HashMap<PathBuf, u32>,
}

impl Textures {
    /// The index of the texture in `file`, which is read the first time.
    pub(super) fn index(&mut self, file: &Path, named: &Reference) -> Result<u32, Diagnostic> {
        // Two names of one file are the same texture. If the path cannot be resolved, reading will fail with the reason.
        let key = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        if let Some(&index) = self.indices.get(&key) {
            return Ok(index);
        }
        let index = u32::try_from(self.textures.len())
            .map_err(|_| input::unreadable(file, Some(named), "exceeds the maximum number of textures"))?;
        self.textures.push(read(file, named)?);
        self.indices.insert(key, index);
        Ok(index)
    }

    /// The texture with an index that [`index`](Self::index) returned.
    pub(super) fn get(&self, index: u32) -> &Texture {
        &self.textures[index as usize]
    }

    /// All textures, in the order of their indices.
    pub(super) fn into_vec(self) -> Vec<Texture> {
        self.textures
    }
}

fn read(file: &Path, named: &Reference) -> Result<Texture, Diagnostic> {
    input::check_readable(file, MAX_FILE_BYTES, Some(named))?;
    let unreadable = |error: &dyn std::fmt::Display| {
        input::unreadable(file, Some(named), format_args!("cannot be read as an image: {error}"))
    };
    let mut reader = ImageReader::open(file)
        .and_then(ImageReader::with_guessed_format)
        .map_err(|error| unreadable(&error))?;
    if reader.format() == Some(ImageFormat::Jpeg)
        && !jpeg_has_an_end(file).map_err(|error| unreadable(&error))?
    {
        return Err(unreadable(&"the JPEG data are truncated"));
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| unreadable(&error))?.into_rgb8();
    let (width, height) = image.dimensions();
    if width == 0 || height == 0 {
        return Err(unreadable(&"it has no pixels"));
    }
    let texels = image.pixels().map(|pixel| pixel.0).collect();
    Ok(Texture { width, height, texels })
}

/// True if the end marker of a JPEG image is near the end of the file.
///
/// The decoder silently fills truncated images with grey.
fn jpeg_has_an_end(file: &Path) -> std::io::Result<bool> {
    const MARKER: [u8; 2] = [0xff, 0xd9];
    // Some cameras and programs append zeros or a few bytes.
    const TAIL: u64 = 4096;
    let mut file = BufReader::new(File::open(file)?);
    let length = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(length.saturating_sub(TAIL)))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    Ok(tail.windows(MARKER.len()).any(|bytes| bytes == MARKER))
}
