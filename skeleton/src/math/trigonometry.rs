//! Sine and cosine on a short interval.

/// (sin x, cos x) for |x| ≤ π/4, with an absolute error below 1.2e-7.
///
/// Minimax polynomials of the Cephes library (S. Moshier). The sampling routines need no other range, and call this often:
/// it takes a few nanoseconds and, unlike the system's math library, gives the same bits on every machine.
#[inline]
pub(super) fn sin_cos_eighth_turn(x: f32) -> (f32, f32) {
    let z = x * x;
    let sin = ((-1.951_529_6e-4 * z + 8.332_161e-3) * z - 1.666_665_5e-1) * z * x + x;
    let cos = ((2.443_315_7e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2) * z * z - 0.5 * z + 1.0;
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::sin_cos_eighth_turn;

    #[test]
    fn agrees_with_the_double_precision_functions() {
        for i in -100_000..=100_000 {
            let x = i as f32 / 100_000.0 * std::f32::consts::FRAC_PI_4;
            let (sin, cos) = sin_cos_eighth_turn(x);
            let (exact_sin, exact_cos) = f64::from(x).sin_cos();
            assert!((f64::from(sin) - exact_sin).abs() < 1.2e-7 * exact_sin.abs().max(1e-3), "sin {x}");
            assert!((f64::from(cos) - exact_cos).abs() < 1.2e-7, "cos {x}");
        }
    }
}
