//! The transfer curve of sRGB (IEC 61966-2-1): between linear values and what image files hold.

use std::sync::LazyLock;

/// From a value with the transfer curve, in [0, 1], to linear.
pub fn decode(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// From linear to a value with the transfer curve; both in [0, 1].
pub fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// [`decode`] for a value of 8 bits, from a table.
#[inline]
pub fn decode_8bit(value: u8) -> f32 {
    static TABLE: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| decode(i as f32 / 255.0)));
    TABLE[usize::from(value)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encode_inverts_decode_at_every_8_bit_value() {
        for value in 0..=255u8 {
            assert_eq!((encode(decode_8bit(value)) * 255.0).round() as u8, value);
        }
        assert!((encode(0.18) * 255.0 - 117.6).abs() < 0.1, "middle grey");
    }
}
