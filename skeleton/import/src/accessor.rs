//! Arrays of numbers in buffers. The reader of `gltf` is not used: it panics where types or sizes do not fit.

use arty::diagnostic::Diagnostic;
use gltf::accessor::{Accessor, DataType, Dimensions};

use crate::document::Document;

/// Reads an accessor of vectors with N components. Integers must be normalized; they become fractions.
///
/// # Errors
/// If it has another type, exceeds its buffer, or a value is not finite.
pub(crate) fn vectors<const N: usize>(
    document: &Document,
    accessor: &Accessor<'_>,
    item: &str,
) -> Result<Vec<[f32; N]>, Diagnostic> {
    let data_type = accessor.data_type();
    let component: fn(&[u8]) -> f32 = match (data_type, accessor.normalized()) {
        (DataType::F32, _) => |bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        (DataType::U8, true) => |bytes| f32::from(bytes[0]) / 255.0,
        (DataType::I8, true) => |bytes| (f32::from(bytes[0] as i8) / 127.0).max(-1.0),
        (DataType::U16, true) => |bytes| f32::from(u16::from_le_bytes([bytes[0], bytes[1]])) / 65535.0,
        (DataType::I16, true) => {
            |bytes| (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])) / 32767.0).max(-1.0)
        }
        _ => return Err(document.error(item, "its numbers are neither floats nor normalized integers")),
    };
    let size = data_type.size();
    let vector = |bytes: &[u8]| std::array::from_fn(|index| component(&bytes[index * size..]));
    let vectors: Vec<[f32; N]> = elements(document, accessor, N, item)?.map(vector).collect();
    match vectors.iter().position(|vector| vector.iter().any(|value| !value.is_finite())) {
        Some(index) => Err(document.error(item, format!("its vector {index} is NaN or infinite"))),
        None => Ok(vectors),
    }
}

/// Reads an accessor of indices, each below `limit`.
///
/// # Errors
/// As [`vectors`], or if an index is too large.
pub(crate) fn indices(
    document: &Document,
    accessor: &Accessor<'_>,
    limit: usize,
    item: &str,
) -> Result<Vec<u32>, Diagnostic> {
    let index: fn(&[u8]) -> u32 = match accessor.data_type() {
        DataType::U8 => |bytes| u32::from(bytes[0]),
        DataType::U16 => |bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        DataType::U32 => |bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        _ => return Err(document.error(item, "its indices are not unsigned integers")),
    };
    let indices: Vec<u32> = elements(document, accessor, 1, item)?.map(index).collect();
    match indices.iter().find(|&&index| index as usize >= limit) {
        Some(index) => Err(document.error(item, format!("index {index} of {limit} vertices"))),
        None => Ok(indices),
    }
}

/// The bytes of each element, of at least as many as its components need.
fn elements<'a>(
    document: &'a Document,
    accessor: &Accessor<'_>,
    components: usize,
    item: &str,
) -> Result<impl Iterator<Item = &'a [u8]>, Diagnostic> {
    let expected = match accessor.dimensions() {
        Dimensions::Scalar => 1,
        Dimensions::Vec2 => 2,
        Dimensions::Vec3 => 3,
        Dimensions::Vec4 => 4,
        _ => 0,
    };
    if expected != components {
        return Err(document.error(item, format!("expected {components} numbers per vertex")));
    }
    if accessor.sparse().is_some() {
        return Err(document.error(item, "sparse arrays are not supported: export without them"));
    }
    let view = accessor.view().ok_or_else(|| document.error(item, "it has no data"))?;
    let size = components * accessor.data_type().size();
    let stride = view.stride().unwrap_or(size);
    let bytes = document.view(&view).and_then(|bytes| bytes.get(accessor.offset()..));
    // The last element need not be followed by the gap that the stride makes.
    let needed = accessor
        .count()
        .checked_sub(1)
        .map_or(Some(0), |gaps| gaps.checked_mul(stride).and_then(|length| length.checked_add(size)));
    match (bytes, needed) {
        (Some(bytes), Some(needed)) if needed <= bytes.len() && stride >= size => {
            Ok((0..accessor.count()).map(move |index| &bytes[index * stride..index * stride + size]))
        }
        _ => Err(document.error(item, "its data exceed their buffer")),
    }
}
