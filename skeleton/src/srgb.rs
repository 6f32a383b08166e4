//! The sRGB transfer curve (IEC 61966-2-1), and exposure.

use std::sync::LazyLock;

/// The sRGB encoding of a linear value: 0 is black, 1 is white. Not clamped: the curve is extended below 0 and above 1.
pub fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The linear value of an sRGB-encoded one: the inverse of [`srgb_encode`].
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The 8-bit sRGB level of a linear value, clamped to 0 and 255. NaN gives 0.
pub fn linear_to_srgb_u8(linear: f32) -> u8 {
    (srgb_encode(linear) * 255.0).round() as u8
}

/// The linear value of an 8-bit sRGB level.
pub fn srgb_to_linear_u8(level: u8) -> f32 {
    // Used in every texture lookup, hence the table.
    static LINEAR: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|level| srgb_decode(level as f32 / 255.0)));
    LINEAR[usize::from(level)]
}

/// The factor of an exposure in stops (EV): 2 per stop.
pub fn exposure_factor(stops: f32) -> f32 {
    stops.exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_have_known_levels() {
        // 0.5 and 0.18 by hand: 255 (1.055 · x^(1/2.4) − 0.055) = 187.5 and 117.6.
        let cases = [(0.0, 0), (0.003_130_8, 10), (0.18, 118), (0.5, 188), (1.0, 255), (2.0, 255)];
        for (linear, level) in cases {
            assert_eq!(linear_to_srgb_u8(linear), level, "{linear}");
        }
        assert_eq!(linear_to_srgb_u8(-1.0), 0);
        assert_eq!(linear_to_srgb_u8(f32::INFINITY), 255);
        assert_eq!(linear_to_srgb_u8(f32::NEG_INFINITY), 0);
        assert_eq!(linear_to_srgb_u8(f32::NAN), 0);
    }

    #[test]
    fn every_level_survives_decoding_and_encoding() {
        for level in 0..=255 {
            assert_eq!(linear_to_srgb_u8(srgb_to_linear_u8(level)), level);
        }
    }

    #[test]
    fn the_two_parts_of_the_curve_meet() {
        // The constants of the standard are rounded: the parts meet to about 1e-7, and so does the decoding.
        let (below, above) = (0.003_130_8_f32, 0.003_130_9_f32);
        assert!((srgb_encode(above) - srgb_encode(below)).abs() < 2e-6);
        assert!((srgb_decode(0.040_45) - 0.003_130_8).abs() < 1e-7);
        for i in 0..=1000 {
            let linear = i as f32 / 250.0;
            assert!((srgb_decode(srgb_encode(linear)) - linear).abs() <= 2e-6 * linear.max(1.0), "{linear}");
        }
    }

    #[test]
    fn a_stop_is_a_factor_of_two() {
        assert_eq!(exposure_factor(0.0), 1.0);
        assert_eq!(exposure_factor(3.0), 8.0);
        assert_eq!(exposure_factor(-1.0), 0.5);
    }
}
