//! Writing of OpenEXR files.

use std::io::{Cursor, Write};
use std::path::Path;

use ::exr::block::UncompressedBlock;
use ::exr::block::writer::ChunksWriter;
use ::exr::error::Error;
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::{AttributeValue, ChannelDescription, Compression, LineOrder, SampleType, Text};
use ::exr::meta::header::{Header, LayerAttributes, standard_names};
use ::exr::prelude::{SmallVec, f16};

use super::{ExrFile, Precision};
use crate::diagnostic::Diagnostic;
use crate::image::write_aside;

/// Maximum length of channel and attribute names in bytes.
const MAX_NAME_LENGTH: usize = 255;

impl ExrFile {
    /// Writes the file with lossless compression. The same content gives the same bytes.
    ///
    /// # Errors
    ///
    /// If the format cannot represent it (no pixels, no channels, a channel of a different size, a name that is empty, too
    /// long or reserved), or as [`write_aside`]; an existing file is kept then.
    pub fn write(&self, path: &Path, precision: Precision) -> Result<(), Diagnostic> {
        let header = self.header(precision).map_err(|reason| {
            Diagnostic::about(path, format!("cannot be written as an OpenEXR file: {reason}"))
        })?;
        let mut bytes = self.encode(header).map_err(|reason| {
            Diagnostic::about(path, format!("cannot be written as an OpenEXR file: {reason}"))
        })?;
        sort_attributes(&mut bytes);
        write_aside(path, |file| file.write_all(&bytes))
    }

    /// The header.
    fn header(&self, precision: Precision) -> Result<Header, String> {
        let (width, height) = (self.width, self.height);
        // The limit of the format is i32::MAX / 2; an image near that does not fit into memory.
        if !(1..1 << 30).contains(&width) || !(1..1 << 30).contains(&height) {
            return Err(format!("{width} x {height} pixels are not supported"));
        }
        if self.channels.is_empty() {
            return Err("there are no channels".to_owned());
        }
        for (name, samples) in &self.channels {
            check_name(name)?;
            if samples.len() != width * height {
                let count = samples.len();
                return Err(format!("channel {name} has {count} samples for {width} x {height} pixels"));
            }
        }
        let sample_type = match precision {
            Precision::Full => SampleType::F32,
            Precision::Half => SampleType::F16,
        };
        // The format requires channels to be sorted by name, as the map is.
        let channels: SmallVec<[ChannelDescription; 5]> =
            self.channels.keys().map(|name| ChannelDescription::named(text(name), sample_type)).collect();
        Ok(Header::new(Text::default(), (width, height), channels)
            .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
            .with_attributes(self.attributes()?))
    }

    /// The attributes of the layer.
    fn attributes(&self) -> Result<LayerAttributes, String> {
        let mut attributes = LayerAttributes {
            software_name: Some(text(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")))),
            ..LayerAttributes::default()
        };
        for (name, value) in &self.metadata {
            check_name(name)?;
            let value = text(value);
            match name.as_str() {
                "software" => attributes.software_name = Some(value),
                "comments" => attributes.comments = Some(value),
                "owner" => attributes.owner = Some(value),
                "capDate" => attributes.capture_date = Some(value),
                reserved if standard_names::ALL.contains(&reserved.as_bytes()) => {
                    return Err(format!("the attribute name {reserved} is reserved by the format"));
                }
                _ => drop(attributes.other.insert(text(name), AttributeValue::Text(value))),
            }
        }
        Ok(attributes)
    }

    fn encode(&self, header: Header) -> Result<Vec<u8>, Error> {
        let mut file = Cursor::new(Vec::new());
        let channels = header.channels.clone();
        let samples: Vec<&[f32]> = self.channels.values().map(Vec::as_slice).collect();
        ::exr::block::write(&mut file, [header].into_iter().collect(), true, |meta, writer| {
            let blocks = meta.collect_ordered_block_data(|block| {
                UncompressedBlock::collect_block_data_from_lines(&channels, block, |line| {
                    let place = line.location;
                    let start = place.position.y() * self.width + place.position.x();
                    let row = &samples[place.channel][start..start + place.sample_count];
                    let written = match channels.list[place.channel].sample_type {
                        SampleType::F16 => line.write_samples(|x| to_half(row[x])),
                        _ => line.write_samples_from_slice(row),
                    };
                    written.expect("a line of a block has room for its samples");
                })
            });
            // The progress callback is unused; the crate offers no other way to compress through a reference.
            writer.on_progress(|_| ()).compress_all_blocks_parallel(&meta, blocks)
        })?;
        Ok(file.into_inner())
    }
}

/// Bytes before the attributes: magic number and version.
const ATTRIBUTES: usize = 8;

/// Sorts the attributes of a file of one part by name. The crate keeps them in a hash table, whose order differs between
/// two files of the same content. No offset changes: the header keeps its length.
fn sort_attributes(bytes: &mut [u8]) {
    let mut attributes = Vec::new();
    let mut start = ATTRIBUTES;
    while let Some(end) = end_of_attribute(bytes, start) {
        attributes.push(bytes[start..end].to_vec());
        start = end;
    }
    // Each begins with its name and a zero byte, so that the order of the bytes is that of the names.
    attributes.sort();
    let sorted = attributes.concat();
    bytes[ATTRIBUTES..ATTRIBUTES + sorted.len()].copy_from_slice(&sorted);
}

/// Where an attribute (name, type, size, value) ends; None at the end of the list, which an empty name marks.
fn end_of_attribute(bytes: &[u8], start: usize) -> Option<usize> {
    let end_of_text = |from: usize| Some(from + bytes.get(from..)?.iter().position(|&byte| byte == 0)? + 1);
    let name = end_of_text(start).filter(|&end| end > start + 1)?;
    let size = end_of_text(name)?;
    let value = bytes.get(size..size + 4)?.try_into().map(u32::from_le_bytes).ok()?;
    let end = size + 4 + value as usize;
    (end <= bytes.len()).then_some(end)
}

/// Rounds to 16 bits; finite values stay finite, since an infinity would look like a fault of the renderer.
fn to_half(value: f32) -> f16 {
    let limit = f16::MAX.to_f32();
    f16::from_f32(if value.is_finite() { value.clamp(-limit, limit) } else { value })
}

/// A text of the format, as UTF-8.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

fn check_name(name: &str) -> Result<(), String> {
    if name.is_empty() || name.len() > MAX_NAME_LENGTH || name.contains('\0') {
        return Err(format!(
            "invalid name {name:?}: must have 1 to {MAX_NAME_LENGTH} bytes and no zero byte"
        ));
    }
    Ok(())
}
