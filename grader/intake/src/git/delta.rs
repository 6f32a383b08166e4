//! Deltas: an object as parts of another and new bytes.

use super::objects::Trouble;

/// Applies a delta. The result has at most `max` bytes.
pub(super) fn apply(base: &[u8], mut delta: &[u8], max: u64) -> Result<Vec<u8>, Trouble> {
    let rest = &mut delta;
    if size(rest)? != base.len() as u64 {
        return Err(Trouble::Damaged);
    }
    let expected = size(rest)?;
    if expected > max {
        return Err(Trouble::TooLarge);
    }
    let mut result = Vec::new();
    while !rest.is_empty() {
        let command = next(rest)?;
        let part = if command & 128 != 0 {
            let (mut offset, mut length) = (0, 0);
            for byte in 0..4 {
                offset |= if command & (1 << byte) != 0 { usize::from(next(rest)?) << (8 * byte) } else { 0 };
            }
            for byte in 0..3 {
                length |=
                    if command & (16 << byte) != 0 { usize::from(next(rest)?) << (8 * byte) } else { 0 };
            }
            let length = if length == 0 { 0x10000 } else { length };
            base.get(offset..offset + length).ok_or(Trouble::Damaged)?
        } else {
            let (part, after) = rest.split_at_checked(usize::from(command)).ok_or(Trouble::Damaged)?;
            // A command of zero is reserved; without this it would go on without end.
            if part.is_empty() {
                return Err(Trouble::Damaged);
            }
            *rest = after;
            part
        };
        if (result.len() + part.len()) as u64 > expected {
            return Err(Trouble::Damaged);
        }
        result.extend_from_slice(part);
    }
    if result.len() as u64 == expected { Ok(result) } else { Err(Trouble::Damaged) }
}

/// A size: seven bits a byte, the lowest first.
fn size(rest: &mut &[u8]) -> Result<u64, Trouble> {
    let mut size = 0;
    for shift in (0..63).step_by(7) {
        let byte = next(rest)?;
        size |= u64::from(byte & 127) << shift;
        if byte & 128 == 0 {
            return Ok(size);
        }
    }
    Err(Trouble::Damaged)
}

fn next(rest: &mut &[u8]) -> Result<u8, Trouble> {
    let (&first, after) = rest.split_first().ok_or(Trouble::Damaged)?;
    *rest = after;
    Ok(first)
}
