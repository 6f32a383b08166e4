//! Fresnel reflectance of a smooth interface between two dielectrics.

/// Fresnel reflectance of unpolarised light, in [0, 1].
///
/// `cos` is the cosine of incidence, `cos_t` that of refraction, both ≥ 0; `ratio` is the index of refraction on the side of
/// incidence divided by the one on the other side.
///
/// r∥ = (cos − η cos_t) / (cos + η cos_t), r⊥ = (η cos − cos_t) / (η cos + cos_t), F = (r∥² + r⊥²) / 2, with η the
/// ratio (Born and Wolf, "Principles of Optics", 1.5.2).
#[inline]
pub fn fresnel_dielectric(cos: f32, cos_t: f32, ratio: f32) -> f32 {
    let sum_parallel = cos + ratio * cos_t;
    let sum_perpendicular = ratio * cos + cos_t;
    if sum_parallel <= 0.0 || sum_perpendicular <= 0.0 {
        return 1.0; // grazing incidence
    }
    let parallel = (cos - ratio * cos_t) / sum_parallel;
    let perpendicular = (ratio * cos - cos_t) / sum_perpendicular;
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        // Along the normal: ((n − 1) / (n + 1))², 4 % for n = 1.5, from either side.
        assert!((fresnel_dielectric(1.0, 1.0, 1.0 / 1.5) - 0.04).abs() < 1e-6);
        assert!((fresnel_dielectric(1.0, 1.0, 1.5) - 0.04).abs() < 1e-6);
        // Equal indices reflect nothing.
        assert_eq!(fresnel_dielectric(0.3, 0.3, 1.0), 0.0);
        // At Brewster's angle, tan θ = n, only r⊥ is left: ((1 − n²) / (1 + n²))² / 2.
        let theta = 1.5f32.atan();
        let brewster = fresnel_dielectric(theta.cos(), theta.sin(), 1.0 / 1.5);
        assert!((brewster - 0.5 * (1.25f32 / 3.25).powi(2)).abs() < 1e-6);
        assert_eq!(fresnel_dielectric(0.0, 0.5, 1.0 / 1.5), 1.0);
    }
}
