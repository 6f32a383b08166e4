//! **mean-bias**: are the means those of the reference image?

use crate::error::{Error, Result};
use crate::reference::Reference;
use crate::rubric::CheckSpec;
use crate::statistics::bias::Expected;

/// What the reference says.
pub(super) fn expected(spec: &CheckSpec, reference: &Reference) -> Result<Expected> {
    reference
        .by_bounces
        .get(&spec.max_bounces)
        .and_then(|light| light.expected(spec.technique))
        .ok_or_else(|| {
            Error::Input(format!(
                "the reference of `{scene}` does not have {technique} with {bounces} bounces; make it with `cargo \
                 grader reference {scene}`",
                scene = spec.scene,
                technique = spec.technique,
                bounces = spec.max_bounces
            ))
        })
}
