//! Directions: between points, reflected, refracted.

use glam::Vec3;

/// The unit vector from one point to another and their distance, in scene units.
///
/// For equal points the result is (0, 0, 0) and 0. Very large or small differences are scaled before they are squared, so
/// that no distance representable in `f32` overflows or underflows.
#[inline]
pub fn direction_and_distance(from: Vec3, to: Vec3) -> (Vec3, f32) {
    let difference = to - from;
    let squared = difference.length_squared();
    if squared > 1e-30 && squared < 1e30 {
        let distance = squared.sqrt();
        return (difference / distance, distance);
    }
    scaled_direction(difference)
}

#[cold]
fn scaled_direction(difference: Vec3) -> (Vec3, f32) {
    let scale = difference.abs().max_element();
    if scale == 0.0 || !scale.is_finite() {
        return (Vec3::ZERO, scale);
    }
    let scaled = difference / scale;
    let length = scaled.length();
    (scaled / length, scale * length)
}

/// The reflection of `w` about the unit vector `normal`: r = 2 (n·w) n − w. All vectors point away from the surface.
#[inline]
pub fn reflect(w: Vec3, normal: Vec3) -> Vec3 {
    2.0 * normal.dot(w) * normal - w
}

/// The refraction of `w` and its cosine to −`normal`; `None` for total internal reflection.
///
/// `w` and `normal` are unit vectors on the same side; `ratio` is the index of refraction on that side divided by the one
/// on the other side. Snell's law: sin θ_t = ratio · sin θ.
#[inline]
pub fn refract(w: Vec3, normal: Vec3, ratio: f32) -> Option<(Vec3, f32)> {
    let cos = normal.dot(w).clamp(0.0, 1.0);
    // sin² as (1 − cos)(1 + cos): accurate near normal incidence.
    let sin2_t = ratio * ratio * (1.0 - cos) * (1.0 + cos);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let wt = (ratio * cos - cos_t) * normal - ratio * w;
    Some((wt.normalize(), cos_t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn direction_and_distance_are_accurate_over_the_whole_range_of_f32() {
        for exponent in -36..=37 {
            let length = 10f32.powi(exponent);
            let (wi, distance) = direction_and_distance(Vec3::ZERO, length * Vec3::new(2.0, -1.0, 2.0));
            assert!((wi - Vec3::new(2.0, -1.0, 2.0) / 3.0).length() < 1e-6, "1e{exponent}: {wi}");
            assert!((distance / (3.0 * length) - 1.0).abs() < 1e-6, "1e{exponent}: {distance}");
        }
    }

    #[test]
    fn equal_points_have_no_direction() {
        assert_eq!(direction_and_distance(Vec3::ONE, Vec3::ONE), (Vec3::ZERO, 0.0));
    }

    #[test]
    fn refraction_obeys_snells_law_and_is_reversible() {
        let normal = Vec3::Z;
        for step in 0..100 {
            let theta = step as f32 / 100.0 * std::f32::consts::FRAC_PI_2;
            let w = Vec3::new(theta.sin(), 0.0, theta.cos());
            let (wt, cos_t) =
                refract(w, normal, 1.0 / 1.5).expect("no total internal reflection on the thinner side");
            assert!((wt.length() - 1.0).abs() < 1e-6 && (cos_t + wt.z).abs() < 1e-6);
            assert!((1.5 * -wt.x - w.x).abs() < 1e-6, "n sin θ is invariant");
            // Near the critical angle the inverse is ill-conditioned.
            if theta < 1.5 {
                let (back, _) = refract(wt, -normal, 1.5).expect("refraction is reversible");
                assert!((back - w).length() < 1e-4, "{back} {w}");
            }
        }
        assert!(refract(Vec3::new(0.8, 0.0, 0.6), normal, 1.5).is_none(), "total internal reflection");
    }
}
