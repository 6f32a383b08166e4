//! A check: its kind, its identity and its result.

mod evidence;
mod fault;
mod id;
mod kind;
mod means;
mod result;
mod sampling;
mod stability;
mod weights;
mod why_not;

pub use evidence::{
    ChangeTest, Evidence, FailedFacts, LightShares, Noise, PathLengths, PixelGroup, RandomNumbers, RayCounts,
    SceneChange, TooManyRays, VarianceOf, VariantTest,
};
pub use fault::{Anomaly, Fault, Numerics};
pub use id::{CheckId, Visibility};
pub use kind::CheckKind;
pub use means::{BounceEnergy, Channel, Effect, FurnaceTest, MeanTest, RegionId, RegionKind};
pub use result::{CheckResult, NotRun, Reason, SkipReason, Verdict};
pub use sampling::{SampledMap, SamplingFlaw, SamplingTest};
pub use stability::{Deviation, NumericalCause, Place, StabilityFinding, StabilityTest};
pub use weights::{MeasuredWeights, OnlyWay, OnlyWayWeight, WeightFault, WeightForm, WeightTest};
pub use why_not::WhyNot;
