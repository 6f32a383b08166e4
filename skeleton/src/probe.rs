//! What the grader may script, switch off and count when it runs a hand-in. Nothing of this is in a normal build, and
//! no item that an integrator can name differs.
//!
//! A **script** keeps the geometry of a scene true and replaces numbers: a scripted light offers one known point with
//! a known density; a scripted BSDF has the same value and density in every direction and gives one known direction.
//! So whatever an integrator works out by itself from positions and normals stays right. A script has no state: asked
//! twice, it answers the same. And it draws no random numbers, so that all that are drawn are the integrator's own.
//!
//! **Switches** take away one of the two ways in which light is found. They belong to a scene.
//!
//! **Strata** spread the integrator's own random numbers evenly over many paths.
//!
//! Whoever asks first has the [`Key`] to strata, counts and recordings: the grader's host, before any code of a hand-in.
//!
//! **Counts** and **recordings** are those of the current thread, since one path is followed on one thread.

mod record;
mod strata;

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::bsdf::BsdfSample;
use crate::math::{Rgb, Vec3, direction_and_distance};

pub(crate) use record::record;
pub use record::{Call, Recording, Value, start_recording, take_recording};
pub(crate) use strata::place;
pub use strata::{Strata, set_strata};

/// The right to reset counts, to record and to order random numbers. A hand-in that had it could hide what it does.
#[derive(Debug)]
pub struct Key(());

impl Key {
    /// The only key of this process; `None` from the second call on.
    pub fn take() -> Option<Self> {
        static TAKEN: AtomicBool = AtomicBool::new(false);
        (!TAKEN.swap(true, Ordering::Relaxed)).then_some(Self(()))
    }
}

/// A BSDF with the same value and density for all directions above the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScriptedBsdf {
    /// The point (world space) to which every direction goes that is drawn.
    pub target: Vec3,
    /// Its value, 1/sr; for a delta distribution that of the one direction, and black for all others.
    pub f: Rgb,
    /// Its density per solid angle; for a delta distribution the probability of the one direction. Greater than 0.
    pub pdf: f32,
    /// True if it is a delta distribution.
    pub is_delta: bool,
}

/// A triangle light of which one point is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScriptedLight {
    /// The point in world space; on the light.
    pub point: Vec3,
    /// The density per area with which every point of the light claims to be drawn. Greater than 0.
    pub pdf_area: f32,
}

/// Which ways of finding light are closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switches {
    /// Lights that are hit emit nothing: [`Light::emission`](crate::light::Light::emission) is black. They are still there and are still lights,
    /// since a shadow ray may be an ordinary ray that looks whether it hits the right light.
    pub hits_off: bool,
    /// [`Scene::occluded`](crate::scene::Scene::occluded) is always true.
    pub shadows_off: bool,
}

/// How often an integrator has called what costs time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Calls of [`Scene::intersect`](crate::scene::Scene::intersect).
    pub rays: u32,
    /// Calls of [`Scene::occluded`](crate::scene::Scene::occluded).
    pub shadow_rays: u32,
    /// Calls of [`Light::sample_direct`](crate::light::Light::sample_direct).
    pub light_samples: u32,
    /// Calls of [`Bsdf::sample`](crate::bsdf::Bsdf::sample).
    pub bsdf_samples: u32,
}

thread_local! {
    static COUNTS: Cell<Counts> = const { Cell::new(Counts { rays: 0, shadow_rays: 0, light_samples: 0, bsdf_samples: 0 }) };
}

/// Sets the counts of this thread back to zero and gives what they were.
pub fn take_counts(_: &Key) -> Counts {
    COUNTS.take()
}

#[inline]
pub(crate) fn count(add: impl FnOnce(&mut Counts)) {
    let mut counts = COUNTS.get();
    add(&mut counts);
    COUNTS.set(counts);
}

impl ScriptedBsdf {
    /// The same at a point of a surface.
    #[inline]
    pub(crate) fn seen_from(&self, point: Vec3) -> ScriptedLobe {
        let (wi, _) = direction_and_distance(point, self.target);
        ScriptedLobe { wi, f: self.f, pdf: self.pdf, is_delta: self.is_delta }
    }
}

/// A [`ScriptedBsdf`] at a hit point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScriptedLobe {
    /// The one direction that is drawn.
    pub(crate) wi: Vec3,
    f: Rgb,
    pdf: f32,
    pub(crate) is_delta: bool,
}

impl ScriptedLobe {
    #[inline]
    pub(crate) fn eval(&self) -> Rgb {
        if self.is_delta { Rgb::BLACK } else { self.f }
    }

    #[inline]
    pub(crate) fn pdf(&self) -> f32 {
        if self.is_delta { 0.0 } else { self.pdf }
    }

    #[inline]
    pub(crate) fn sample_delta(&self, normal: Vec3) -> Option<BsdfSample> {
        self.is_delta.then_some(BsdfSample {
            wi: self.wi,
            f: self.f,
            pdf: self.pdf,
            cos: normal.dot(self.wi).abs(),
            is_delta: true,
        })
    }
}
