//! Irradiance from a uniformly emitting polygon.

use glam::DVec3;

/// Irradiance at a point, per unit of radiance, from the part of a polygon above the horizon.
///
/// E / L = ½ |Σ Θᵢ n·Γᵢ|, with the angle Θᵢ that edge i spans seen from the point and the unit normal Γᵢ of the
/// plane through the edge and the point (Lambert 1760; Arvo, "Analytic Methods for Simulated Light Transport", 1995).
pub(super) fn irradiance(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let above = clip(corners.iter().map(|&corner| corner - point), normal);
    let mut sum = 0.0;
    for (i, &a) in above.iter().enumerate() {
        let b = above[(i + 1) % above.len()];
        let cross = a.cross(b);
        let sine = cross.length();
        if sine > 0.0 {
            sum += sine.atan2(a.dot(b)) * normal.dot(cross / sine);
        }
    }
    0.5 * sum.abs()
}

/// The part of a polygon (corners relative to the point) above the horizon (Sutherland and Hodgman 1974).
fn clip(corners: impl Iterator<Item = DVec3>, normal: DVec3) -> Vec<DVec3> {
    let corners: Vec<DVec3> = corners.collect();
    let mut above = Vec::with_capacity(corners.len() + 1);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (height_a, height_b) = (normal.dot(a), normal.dot(b));
        if height_a >= 0.0 {
            above.push(a);
        }
        if (height_a >= 0.0) != (height_b >= 0.0) {
            above.push(a + (b - a) * (height_a / (height_a - height_b)));
        }
    }
    above
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of sides a, b at height h with one corner overhead: with X = a/h, Y = b/h it is
    /// ½ [X/√(1+X²) · atan(Y/√(1+X²)) + Y/√(1+Y²) · atan(X/√(1+Y²))] (Howell, configuration factor B-3).
    #[test]
    fn a_rectangle_has_its_configuration_factor() {
        for (a, b, h) in [(1.0, 1.0, 1.0), (0.1, 3.0, 0.5), (20.0, 7.0, 0.01), (0.01, 0.02, 4.0)] {
            let corners = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]].map(|[x, y]| DVec3::new(x, y, h));
            let (x, y) = (a / h, b / h);
            let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
            let expected = 0.5 * (x / rx * (y / rx).atan() + y / ry * (x / ry).atan());
            let seen = irradiance(DVec3::ZERO, DVec3::Z, &corners);
            assert!((seen / expected - 1.0).abs() < 1e-9, "{a} × {b} at {h}: {seen} instead of {expected}");
        }
    }

    #[test]
    fn parts_below_the_horizon_do_not_contribute() {
        let whole = [[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]].map(|[y, z]| DVec3::new(1.0, y, z));
        let upper = [[-1.0, 1.0], [-1.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(|[y, z]| DVec3::new(1.0, y, z));
        let seen = |corners: &[DVec3]| irradiance(DVec3::ZERO, DVec3::Z, corners);
        assert!(seen(&upper) > 0.1);
        assert!((seen(&whole) - seen(&upper)).abs() < 1e-12);
        assert_eq!(seen(&whole.map(|corner| corner - 5.0 * DVec3::Z)), 0.0);
    }
}
