//! Reading of OpenEXR files, including broken and hostile ones.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use ::exr::block::UncompressedBlock;
use ::exr::block::reader::ChunksReader;
use ::exr::error::Error;
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::{AttributeValue, Compression, SampleType};
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::prelude::f16;

use super::ExrFile;
use crate::diagnostic::Diagnostic;

/// Maximum number of samples: 1 GiB of memory.
const MAX_SAMPLES: u128 = 1 << 28;
/// Maximum length of a file with as many samples: zlib adds far less than 1/16 in the worst case.
const MAX_FILE_LENGTH: u64 = (4 << 28) + (4 << 24);
/// Maximum compression factor of the supported methods (zlib: 1032; run lengths: 64).
const MAX_COMPRESSION_RATIO: u128 = 1040;

impl ExrFile {
    /// Reads a single-part scan-line file, uncompressed or compressed by run lengths or zlib, as [`ExrFile::write`] and most
    /// programs write it.
    ///
    /// Samples are converted to 32-bit floats.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, has an unsupported format, or is damaged. Memory is allocated only for as many pixels as
    /// a file of its length can contain, and for at most 2²⁸ samples.
    pub fn read(path: &Path) -> Result<Self, Diagnostic> {
        let fail = |reason: String| Diagnostic::about(path, format!("cannot be read: {reason}"));
        let file = File::open(path).map_err(|error| fail(error.to_string()))?;
        let length = file.metadata().map_err(|error| fail(error.to_string()))?.len();
        decode(BufReader::new(file), length).map_err(fail)
    }
}

/// Reads a file of `length` bytes.
///
/// # Errors
/// What is wrong with the file.
pub(super) fn decode(file: impl Read + Seek, length: u64) -> Result<ExrFile, String> {
    // Checked before the metadata is read, which may be as long as the file.
    if length > MAX_FILE_LENGTH {
        return Err(format!("the file has {length} bytes; at most {MAX_FILE_LENGTH} are read"));
    }
    let reader = ::exr::block::read(file, true).map_err(explain)?;
    let [header] = reader.headers() else {
        let name =
            |header: &Header| header.own_attributes.layer_name.as_ref().map(|name| lossy(name.as_slice()));
        let names: Vec<String> = reader.headers().iter().filter_map(name).collect();
        let names = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
        return Err(format!("it has several parts{names}; save the one that you mean in a file of its own"));
    };
    check(header, length)?;

    let header = header.clone();
    let (width, height) = (header.layer_size.width(), header.layer_size.height());
    let mut channels = vec![vec![0.0; width * height]; header.channels.list.len()];
    let mut is_row_read = vec![false; height];
    let chunks = reader.all_chunks(true).map_err(explain)?;
    for block in chunks.sequential_decompressor(true) {
        let block = block.map_err(explain)?;
        // The number of blocks is that of the image, so none is missing if there is no duplicate.
        let top = block.index.pixel_position.y();
        if std::mem::replace(&mut is_row_read[top], true) {
            return Err(format!("it contains row {top} twice"));
        }
        copy_samples(&block, &header, &mut channels).map_err(explain)?;
    }

    let names = header.channels.list.iter().map(|channel| lossy(channel.name.as_slice()));
    let channels = names.zip(channels).collect();
    Ok(ExrFile { width, height, channels, metadata: metadata(&header.own_attributes) })
}

/// Refuses unsupported formats, and images too large for the length of the file.
fn check(header: &Header, length: u64) -> Result<(), String> {
    if header.deep || header.blocks != BlockDescription::ScanLines {
        return Err("it is tiled or deep; save it as scan lines".to_owned());
    }
    let compression = header.compression;
    if !matches!(
        compression,
        Compression::Uncompressed | Compression::RLE | Compression::ZIP1 | Compression::ZIP16
    ) {
        return Err(format!(
            "its compression ({compression}) is not supported; save it with zip compression"
        ));
    }
    let (width, height) = (header.layer_size.width(), header.layer_size.height());
    let count = header.channels.list.len();
    let samples = width as u128 * height as u128 * count as u128;
    if samples > MAX_SAMPLES {
        return Err(format!(
            "{width} x {height} pixels in {count} channels exceed the limit of {MAX_SAMPLES} samples"
        ));
    }
    let pixel_bytes = width as u128 * height as u128 * header.channels.bytes_per_pixel as u128;
    if pixel_bytes > MAX_COMPRESSION_RATIO * u128::from(length) {
        return Err(format!(
            "its header claims {width} x {height} pixels in {count} channels, too many for {length} bytes"
        ));
    }
    let (data, display) = (header.own_attributes.layer_position, header.shared_attributes.display_window);
    if (data, header.layer_size) != (display.position, display.size) {
        return Err(format!(
            "it is cropped: its data window, {width} x {height} pixels at ({}, {}), is not its display window, {} x {} at ({}, {}); \
             save the whole image",
            data.x(),
            data.y(),
            display.size.width(),
            display.size.height(),
            display.position.x(),
            display.position.y()
        ));
    }
    Ok(())
}

/// Copies the samples of a block to the channels of the image.
fn copy_samples(block: &UncompressedBlock, header: &Header, channels: &mut [Vec<f32>]) -> Result<(), Error> {
    let width = header.layer_size.width();
    for line in block.lines(&header.channels) {
        let place = line.location;
        let start = place.position.y() * width + place.position.x();
        let row = &mut channels[place.channel][start..start + place.sample_count];
        match header.channels.list[place.channel].sample_type {
            SampleType::F32 => line.read_samples_into_slice(row)?,
            SampleType::F16 => {
                for (sample, half) in row.iter_mut().zip(line.read_samples::<f16>()) {
                    *sample = half?.to_f32();
                }
            }
            SampleType::U32 => {
                for (sample, whole) in row.iter_mut().zip(line.read_samples::<u32>()) {
                    *sample = whole? as f32;
                }
            }
        }
    }
    Ok(())
}

/// All text attributes.
fn metadata(attributes: &LayerAttributes) -> BTreeMap<String, String> {
    let standard = [
        ("software", &attributes.software_name),
        ("comments", &attributes.comments),
        ("owner", &attributes.owner),
        ("capDate", &attributes.capture_date),
    ];
    let standard = standard.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value.as_ref()?)));
    let other = attributes.other.iter().filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => Some((lossy(name.as_slice()), text)),
        _ => None,
    });
    standard.chain(other).map(|(name, value)| (name, lossy(value.as_slice()))).collect()
}

/// A text of the format, which need not be UTF-8.
fn lossy(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn explain(error: Error) -> String {
    match error {
        Error::Invalid(reason) => format!("it is damaged or not an OpenEXR file ({reason})"),
        Error::NotSupported(reason) => format!("it uses an unsupported feature ({reason})"),
        error => error.to_string(),
    }
}
