//! Programs that differ from the solution in a known way.

use serde::{Deserialize, Serialize};

use verdict::convergence::{Bias, Curve, Estimate};
use verdict::error::{Error, Result};

/// A known difference from the solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Planted {
    /// Traces every tenth path twice, for nothing.
    TenPercentSlower,
    /// Traces every path twice, for nothing.
    HalfEfficient,
    /// All radiance is 1 % too bright.
    OnePercentBias,
    /// All paths have the same random numbers.
    SharedSeed,
}

/// All planted programs.
pub(super) const PLANTED: [Planted; 4] =
    [Planted::TenPercentSlower, Planted::HalfEfficient, Planted::OnePercentBias, Planted::SharedSeed];

impl Planted {
    /// Description of the program, for the table.
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::TenPercentSlower => "10 % slower: cost of a sample 1.1",
            Self::HalfEfficient => "half as efficient: efficiency 0.5",
            Self::OnePercentBias => "bias of 1 %",
            Self::SharedSeed => "one seed for all paths: slope above −0.5",
        }
    }

    /// True if a measurement shows the difference: its interval excludes what the solution has, and its value is near what
    /// was planted; or a bias is found. Work that is done twice costs a little less the second time.
    pub(super) fn is_shown(self, curve: &Curve) -> bool {
        let is_between = |estimate: Option<Estimate>, low: f64, high: f64| {
            estimate.is_some_and(|estimate| !estimate.holds(1.0) && (low..=high).contains(&estimate.value))
        };
        match self {
            Self::TenPercentSlower => is_between(curve.relative_cost, 1.05, 1.15),
            Self::HalfEfficient => is_between(curve.efficiency, 0.4, 0.6),
            Self::OnePercentBias => matches!(curve.bias, Bias::Found { .. }),
            Self::SharedSeed => curve.slope.is_some_and(|slope| slope.interval[0] > -0.5),
        }
    }
}

/// The source of a planted program, made from the solution's.
///
/// # Errors
/// If the solution is not written as expected.
pub(super) fn planted(kind: Planted, solution: &str) -> Result<String> {
    const RADIANCE: &str = "fn radiance(&self, scene: &Scene, mut ray: Ray, sampler: &mut Sampler) -> Rgb {";
    const IMPLEMENTATION: &str = "impl Integrator for PathTracer {";
    let body = match kind {
        Planted::TenPercentSlower => {
            "if (ray.direction.x.to_bits() ^ ray.direction.y.to_bits()).wrapping_mul(2_654_435_769) < u32::MAX / 10 {
                std::hint::black_box(self.solution(scene, ray, &mut sampler.clone()));
            }
            self.solution(scene, ray, sampler)"
        }
        Planted::HalfEfficient => {
            "std::hint::black_box(self.solution(scene, ray, &mut sampler.clone()));
            self.solution(scene, ray, sampler)"
        }
        Planted::OnePercentBias => "self.solution(scene, ray, sampler) * 1.01",
        Planted::SharedSeed => {
            "let _ = sampler;
            self.solution(scene, ray, &mut Sampler::new(7, (0, 0), 0))"
        }
    };
    let wrapper = format!(
        "{IMPLEMENTATION}
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {{
            {body}
    }}
}}

impl PathTracer {{"
    );
    if !solution.contains(RADIANCE) || !solution.contains(IMPLEMENTATION) {
        return Err(Error::Harness("planted programs do not fit the solution any more".to_owned()));
    }
    let inner = RADIANCE.replacen("radiance", "solution", 1);
    Ok(solution.replacen(RADIANCE, &inner, 1).replacen(IMPLEMENTATION, &wrapper, 1))
}
