//! Facts from measurements.

use arty::integrator::Technique;
use verdict::audit::{Fact, Factor, Outcome, Place, Term, Why};

use super::measure::Measured;

/// Term, technique and place of a fact.
#[derive(Clone, Copy, Debug)]
pub(super) struct About {
    pub(super) term: Term,
    pub(super) technique: Technique,
    pub(super) place: Place,
}

/// Tolerated relative error of a result, and error of an exponent, beyond noise.
pub(super) const RATIO: f64 = 2e-3;
const EXPONENT: f64 = 0.02;

/// Number of standard errors that count as noise: of eight sets, they are exceeded once in 10,000 cases.
pub(super) const NOISE: f64 = 8.0;

/// Result relative to the exact one below which nothing arrives.
pub(super) const NOTHING: f64 = 1e-5;

impl About {
    /// A fact with this outcome.
    pub(super) fn fact(self, factor: Factor, expected: f64, measured: f64, outcome: Outcome) -> Fact {
        let Self { term, technique, place } = self;
        let measured = Some(measured).filter(|measured| measured.is_finite());
        Fact { term, factor, technique, place, expected, measured, outcome, example: None }
    }

    /// A result that should be `exact` in all channels; the measured value is that of the worst one.
    pub(super) fn size(self, factor: Factor, exact: [f64; 3], seen: Measured) -> Fact {
        let noise = NOISE * seen.error / exact[0].abs();
        let ratios = (0..3).map(|channel| seen.all[channel] / exact[channel]);
        let worst = ratios.max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())).unwrap_or(f64::NAN);
        self.ratio(factor, worst, noise)
    }

    /// A ratio that should be 1.
    pub(super) fn ratio(self, factor: Factor, ratio: f64, noise: f64) -> Fact {
        let holds = (ratio - 1.0).abs() <= RATIO + noise;
        self.fact(factor, 1.0, ratio, holds_if(holds))
    }

    /// A result that should be 0, relative to `scale`.
    pub(super) fn nothing(self, factor: Factor, scale: f64, seen: Measured) -> Fact {
        let worst = seen.all.into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN);
        let holds = worst.abs() <= scale.abs() * NOTHING;
        self.fact(factor, 0.0, worst / scale, holds_if(holds))
    }

    /// The exponent of an answer whose logarithm changed by `by`. `exact` is the exact result before.
    pub(super) fn exponent(
        self,
        (factor, expected): (Factor, f64),
        [before, after]: [Measured; 2],
        by: f64,
        exact: f64,
    ) -> Fact {
        if before.value.is_nan() || before.value <= exact * NOTHING {
            return self.not_measured(factor, expected, Why::NothingArrives);
        }
        let exponent = (after.value / before.value).ln() / by;
        let noise = NOISE * (before.error / before.value).hypot(after.error / after.value) / by.abs();
        self.power(factor, expected, exponent, noise)
    }

    /// An exponent with a known value.
    pub(super) fn power(self, factor: Factor, expected: f64, exponent: f64, noise: f64) -> Fact {
        let holds = (exponent - expected).abs() <= EXPONENT + noise;
        // An infinite exponent is one of a result that vanished.
        self.fact(factor, expected, exponent, holds_if(holds))
    }

    /// A fact that cannot be measured.
    pub(super) fn not_measured(self, factor: Factor, expected: f64, why: Why) -> Fact {
        self.fact(factor, expected, f64::NAN, Outcome::DoesNotApply(why))
    }
}

/// The outcome of a fact.
pub(super) fn holds_if(holds: bool) -> Outcome {
    if holds { Outcome::Holds } else { Outcome::Fails }
}

/// How far the ratio of a fact is off; failed ones more than others.
pub(super) fn deviation(fact: &Fact) -> f64 {
    let off = fact.measured.map_or(f64::INFINITY, |measured| (measured - 1.0).abs());
    if fact.fails() { off + 1e6 } else { off }
}
