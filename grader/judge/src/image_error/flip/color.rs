//! Colour spaces of FLIP: linear sRGB, YCxCz, and L*a*b* with the Hunt adjustment. White is linear (1, 1, 1).

/// Linear sRGB to XYZ (D65), with the authors' coefficients.
const RGB_TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// XYZ (D65) to linear sRGB.
const XYZ_TO_RGB: [[f64; 3]; 3] = [
    [3.241_003_275, -1.537_398_934, -0.498_615_861],
    [-0.969_224_334, 1.875_930_071, 0.041_554_224],
    [0.055_639_423, -0.204_011_202, 1.057_148_933],
];

/// Luminance Y of a linear colour.
pub(super) fn luminance(color: [f64; 3]) -> f64 {
    dot(RGB_TO_XYZ[1], color)
}

/// Linear sRGB to YCxCz, a linear space of opponent colours.
pub(super) fn to_ycxcz(color: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = to_white_relative(color);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// YCxCz to linear sRGB, clamped to [0, 1].
pub(super) fn from_ycxcz([lightness, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (lightness + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    let xyz = std::array::from_fn(|c| relative[c] * white(c));
    XYZ_TO_RGB.map(|row| dot(row, xyz).clamp(0.0, 1.0))
}

/// Linear sRGB to L*a*b*, with a* and b* scaled by lightness, since colourfulness falls with luminance (Hunt 1952).
pub(super) fn to_hunt_lab(color: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let curve = |t: f64| {
        if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let [x, y, z] = to_white_relative(color).map(curve);
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// The HyAB distance, for large differences of colour (Abasi, Tehran, Fairchild 2020).
pub(super) fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

fn to_white_relative(color: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| dot(RGB_TO_XYZ[c], color) / white(c))
}

fn white(channel: usize) -> f64 {
    RGB_TO_XYZ[channel].iter().sum()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_conversions_round_trip_and_preserve_white() {
        for color in [[0.2, 0.5, 0.9], [1.0; 3], [0.0; 3]] {
            let back = from_ycxcz(to_ycxcz(color));
            assert!(color.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-6), "{color:?} {back:?}");
        }
        let [lightness, a, b] = to_hunt_lab([1.0; 3]);
        assert!((lightness - 100.0).abs() < 1e-9 && a.abs() < 1e-9 && b.abs() < 1e-9);
        assert!(to_hunt_lab([0.0; 3])[0].abs() < 1e-9);
    }
}
