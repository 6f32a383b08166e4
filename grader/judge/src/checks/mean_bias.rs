//! **mean-bias**: are the means those of the reference image?

use super::means::{self, Picture};
use super::{Bench, Stop};
use crate::reference::Reference;
use crate::statistics::bias::Expected;
use verdict::error::Error;
use verdict::report::CheckResult;
use verdict::rubric::{CheckSpec, Hits};

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let judged = bench.scene(spec);
    let expected = expected(spec, &judged.reference)?;
    means::run(bench, spec, &Picture::of(bench, spec, &[&judged.description], &expected), result)
}

/// What the reference says.
///
/// # Errors
/// If it does not have that picture.
pub fn expected(spec: &CheckSpec, reference: &Reference) -> Result<Expected, Error> {
    reference
        .views
        .get(&spec.view())
        .and_then(|light| light.expected(spec.technique))
        .ok_or_else(|| {
            Error::Input(format!(
                "the reference of `{scene}` does not have {technique} with {bounces} bounces{hits}; make it with `cargo \
                 grader reference {scene}`",
                scene = spec.scene,
                technique = spec.technique,
                bounces = spec.max_bounces,
                hits = if spec.hits == Hits::Off { " and hits off" } else { "" }
            ))
        })
}
