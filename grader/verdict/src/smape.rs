//! The symmetric mean absolute percentage error.

/// mean(|x − r| / (|x| + |r|)) over pixels and channels, in [0, 1]. This is the form without the factor 2, as used for
/// denoisers (Vogels et al.: "Denoising with Kernel Prediction and Asymmetric Loss Functions", 2018). A term whose
/// values are both 0 is 0. The noise of the reference is not subtracted.
///
/// # Panics
/// If picture and reference differ in their number of pixels.
pub(crate) fn smape(picture: &[[f64; 3]], reference: &[[f64; 3]]) -> f64 {
    assert_eq!(picture.len(), reference.len(), "pixels");
    let pairs = picture.iter().flatten().zip(reference.iter().flatten());
    let terms = pairs.map(|(x, r)| {
        let sum = x.abs() + r.abs();
        if sum > 0.0 { (x - r).abs() / sum } else { 0.0 }
    });
    terms.sum::<f64>() / (3 * picture.len()).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_symmetric_and_reaches_from_0_to_1() {
        let (a, b) = ([[1.0, 2.0, 0.0]], [[3.0, 2.0, 0.0]]);
        assert!((smape(&a, &b) - 0.5 / 3.0).abs() < 1e-15);
        assert_eq!(smape(&a, &b), smape(&b, &a));
        assert_eq!(smape(&[[0.0; 3]], &[[5.0; 3]]), 1.0);
        assert_eq!(smape(&[], &[]), 0.0);
    }
}
