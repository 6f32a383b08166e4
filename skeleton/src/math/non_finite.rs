//! Where a sum of colours first became NaN or infinite, on the current thread. This costs finite sums a comparison.

use std::cell::Cell;
use std::panic::Location;

thread_local! {
    static FIRST: Cell<Option<&'static Location<'static>>> = const { Cell::new(None) };
}

/// Forgets all sums so far. [`sample_pixel`](crate::render::sample_pixel) begins with it.
#[inline]
pub(crate) fn forget_sums() {
    FIRST.set(None);
}

/// The place in a source of the first addition of colours whose result was NaN or infinite, although the colour on its left
/// was not, since the last path began on this thread; `None` if there was none.
pub fn first_non_finite_sum() -> Option<&'static Location<'static>> {
    FIRST.get()
}

/// Records an addition whose result is NaN or infinite.
#[cold]
pub(super) fn record(location: &'static Location<'static>) {
    if FIRST.get().is_none() {
        FIRST.set(Some(location));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;

    #[test]
    fn the_first_addition_is_found() {
        forget_sums();
        let mut sum = Rgb::WHITE + Rgb::BLACK;
        assert_eq!(first_non_finite_sum(), None);
        sum += Rgb::gray(f32::NAN);
        let line = line!() - 1;
        sum += Rgb::WHITE;
        let _ = Rgb::WHITE + Rgb::gray(f32::INFINITY);
        let first = first_non_finite_sum().expect("it was recorded");
        assert_eq!(first.line(), line, "neither the later ones nor the operator itself");
        assert!(first.file().ends_with("non_finite.rs") && !sum.is_finite());
        forget_sums();
        let _ = Rgb::WHITE + Rgb::gray(f32::INFINITY);
        assert_eq!(first_non_finite_sum().map(Location::line), Some(line!() - 1));
    }
}
