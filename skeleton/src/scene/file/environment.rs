//! The key `environment`, and the map that it names.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::Quat;
use image::{ImageFormat, ImageReader, Limits};
use serde::Deserialize;
use serde::de::Deserializer;

use super::checks::{Colour, Number, mapping};
use super::transform::Rotation;
use crate::diagnostic::Diagnostic;
use crate::image::Image;
use crate::image::exr::ExrFile;
use crate::input::{self, Reference};
use crate::math::Rgb;
use crate::scene::EnvironmentDescription;

/// Maximum number of texels: a scene with its map must fit into a message to the grader's host.
const MAX_TEXELS: usize = 1 << 25;
/// Maximum width and height. Coordinates in single precision resolve a thousandth of such a texel.
const MAX_SIDE: u32 = 16384;
const MAX_FILE_BYTES: u64 = 1 << 30;

/// The value of the key `environment`.
pub(super) enum EnvironmentEntry {
    /// The same radiance from every direction.
    Constant(Rgb),
    /// A map in a file.
    Map {
        /// The file name as written, relative to the scene file.
        file: String,
        /// From the map to world space.
        rotation: Quat,
        /// Factor on all radiances.
        scale: f32,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EnvironmentKeys {
    file: Option<String>,
    color: Option<Colour>,
    rotate: Option<Rotation>,
    scale: Option<Number>,
}

impl<'de> Deserialize<'de> for EnvironmentEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let expected = "a mapping with the key `color`, or with the keys `file`, `rotate` and `scale`";
        mapping::<_, EnvironmentKeys, _>(deserializer, expected)
    }
}

impl TryFrom<EnvironmentKeys> for EnvironmentEntry {
    type Error = String;
    fn try_from(keys: EnvironmentKeys) -> Result<Self, String> {
        match keys {
            EnvironmentKeys { file: Some(file), color: None, rotate, scale } => {
                let scale = scale.map_or(1.0, Number::get) as f32;
                if scale < 0.0 {
                    return Err(format!("`scale` is {scale}; it must not be negative"));
                }
                let rotation = rotate.map_or(Quat::IDENTITY, |rotation| rotation.quaternion());
                Ok(Self::Map { file, rotation, scale })
            }
            EnvironmentKeys { file: None, color: Some(color), rotate: None, scale: None } => {
                Ok(Self::Constant(color.into()))
            }
            EnvironmentKeys { file: None, color: Some(_), .. } => {
                Err("`rotate` and `scale` are for a `file`: a `color` is the radiance itself".into())
            }
            EnvironmentKeys { file: Some(_), color: Some(_), .. } => {
                Err("it has a `file` and a `color`: give one of them".into())
            }
            EnvironmentKeys { .. } => Err("it has neither a `file` nor a `color`".into()),
        }
    }
}

/// An environment with the same radiance from every direction: a map of one texel.
pub(super) fn constant(radiance: Rgb) -> EnvironmentDescription {
    EnvironmentDescription { width: 1, height: 1, texels: vec![radiance], rotation: Quat::IDENTITY }
}

/// Reads a map.
///
/// # Errors
/// If the file cannot be read, is neither an OpenEXR nor a Radiance HDR image, is too large, or has a radiance that is
/// negative or not finite, before or after scaling.
pub(super) fn read(
    file: &Path,
    named: &Reference,
    rotation: Quat,
    scale: f32,
) -> Result<EnvironmentDescription, Diagnostic> {
    input::check_readable(file, MAX_FILE_BYTES, Some(named))?;
    let unreadable = |problem: &dyn std::fmt::Display| input::unreadable(file, Some(named), problem);
    let mut start = [0; 4];
    let length = File::open(file).and_then(|mut file| file.read(&mut start));
    length.map_err(|error| unreadable(&format_args!("cannot be read: {error}")))?;
    let image = if start == OPEN_EXR {
        let exr = ExrFile::read(file)?;
        exr.layer("").ok_or_else(|| unreadable(&"has no channels R, G and B"))?
    } else if start.starts_with(b"#?") {
        read_hdr(file).map_err(|error| unreadable(&format_args!("cannot be read: {error}")))?
    } else {
        return Err(unreadable(&"is neither an OpenEXR nor a Radiance HDR image"));
    };
    let (width, height) = (image.width(), image.height());
    if width * height > MAX_TEXELS || width.max(height) > MAX_SIDE as usize {
        return Err(unreadable(&format_args!(
            "has {width} x {height} texels; a map has at most {MAX_TEXELS}, and {MAX_SIDE} in a row or column"
        )));
    }
    let texels: Vec<Rgb> = image.pixels().iter().map(|&texel| texel * scale).collect();
    let is_radiance = |texel: &Rgb| texel.is_finite() && texel.min_channel() >= 0.0;
    if let Some(index) = texels.iter().position(|texel| !is_radiance(texel)) {
        return Err(unreadable(&format_args!(
            "the texel in column {} and row {} is {:?} times the scale {scale}: radiance is finite and not negative",
            index % width,
            index / width,
            image.pixels()[index].to_array()
        )));
    }
    Ok(EnvironmentDescription { width: width as u32, height: height as u32, texels, rotation })
}

/// The first bytes of an OpenEXR file.
const OPEN_EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

fn read_hdr(file: &Path) -> Result<Image, image::ImageError> {
    let mut reader = ImageReader::open(file)?;
    reader.set_format(ImageFormat::Hdr);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    let decoded = reader.decode()?.into_rgb32f();
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    let pixels = decoded.pixels().map(|pixel| Rgb::from(pixel.0)).collect();
    Ok(Image::from_pixels(width, height, pixels))
}
