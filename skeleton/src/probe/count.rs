//! Counters of the calls that cost time.

use std::cell::Cell;

use super::Key;

/// Number of calls that an integrator has made on this thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Calls of [`Scene::intersect`](crate::scene::Scene::intersect).
    pub rays: u32,
    /// Calls of [`Scene::occluded`](crate::scene::Scene::occluded).
    pub shadow_rays: u32,
    /// Calls of [`Light::sample_direct`](crate::light::Light::sample_direct).
    pub light_samples: u32,
}

thread_local! {
    static COUNTS: Cell<Counts> = const { Cell::new(Counts { rays: 0, shadow_rays: 0, light_samples: 0 }) };
}

/// Returns the counters of this thread and resets them to zero.
pub fn take_counts(_: &Key) -> Counts {
    COUNTS.take()
}

#[inline]
pub(crate) fn count_ray() {
    add(|counts| counts.rays += 1);
}

#[inline]
pub(crate) fn count_shadow_ray() {
    add(|counts| counts.shadow_rays += 1);
}

#[inline]
pub(crate) fn count_light_sample() {
    add(|counts| counts.light_samples += 1);
}

#[inline]
fn add(increment: impl FnOnce(&mut Counts)) {
    let mut counts = COUNTS.get();
    increment(&mut counts);
    COUNTS.set(counts);
}
