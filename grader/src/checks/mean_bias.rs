//! **mean-bias**: are the means those of the reference image?

use crate::error::{Error, Result};
use crate::reference::Reference;
use crate::rubric::{CheckSpec, Hits};
use crate::statistics::bias::Expected;

/// What the reference says.
pub(super) fn expected(spec: &CheckSpec, reference: &Reference) -> Result<Expected> {
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
