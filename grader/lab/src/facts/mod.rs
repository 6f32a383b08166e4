//! Facts of the variants: which fail for which known mistake, and how well that explains mistakes never seen before.

mod leave_one_out;

use harness::build::{Framework, compile};
use harness::sandbox::Limits;
use judge::audit::audit;
use rayon::prelude::*;
use verdict::error::{Error, Result};

use crate::mutants::Variant;

pub use judge::diagnosis::{FactRow, FailedFact, LearntFacts};
pub use leave_one_out::leave_one_out;

/// Audits variants.
///
/// # Errors
/// If one does not compile, or the grader fails.
pub fn measure(framework: &Framework, variants: &[Variant], seed: u64) -> Result<LearntFacts> {
    let row = |variant: &Variant| {
        let program = compile(framework, &variant.source, &Limits::default())?.map_err(|failure| {
            Error::Input(format!("variant {} does not compile:\n{}", variant.id, failure.messages))
        })?;
        let audit = audit(&program, seed)?;
        Ok(FactRow {
            variant: variant.id.clone(),
            failed: FailedFact::all(&audit),
            ended_early: audit.fault.is_some(),
        })
    };
    let rows: Result<Vec<FactRow>> = variants.par_iter().map(row).collect();
    Ok(LearntFacts { rows: rows? })
}
