//! What a grade does once its points stand: error against run time, pictures, and the report as a page.

use std::path::{Path, PathBuf};

use crate::build::compile;
use crate::convergence::{brief, print_sentences};
use crate::error::{Error, Result};
use crate::grade::{Grader, Options};
use crate::reference::Oracle;
use crate::report::{Picture, Report, page, pictures};
use crate::submission::Submission;
use crate::workspace::Workspace;

/// Completes a report, saves it again, and writes it as `report.html` beside it. The points do not change.
pub(super) fn complete(
    workspace: &Workspace,
    grader: &Grader,
    submission: &Submission,
    report: &mut Report,
    file: &Path,
) -> Result<()> {
    let mut shown = Vec::new();
    if report.submission.build_failure.is_none() {
        eprintln!("measuring error against run time, for no points (--no-report leaves it out) …");
        let Options { seed, threads, limits, .. } = grader.options();
        if let Ok(hand_in) = compile(grader.framework(), &submission.source, limits)? {
            let solution = grader.oracle().map(Oracle::program).transpose()?;
            let convergence = brief(workspace, &hand_in, solution.as_deref(), *seed)?;
            println!("\nError against run time, for no points");
            print_sentences(&convergence);
            report.convergence = Some(convergence);
            shown = pictures(workspace, &hand_in, report, *threads, *seed)?;
            report.images = shown.iter().map(Picture::error).collect();
        }
    }
    report.save(file)?;
    let text = page(report, &shown);
    arty::image::write_aside(&page_beside(file), |writer| {
        std::io::Write::write_all(writer, text.as_bytes())
    })?;
    Ok(())
}

/// Removes the page of an earlier grade, which would lie beside the report of another.
pub(super) fn remove_page(file: &Path) -> Result<()> {
    match std::fs::remove_file(page_beside(file)) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::file(&page_beside(file), error))
        }
        _ => Ok(()),
    }
}

/// `report.html` beside `report.json`.
fn page_beside(file: &Path) -> PathBuf {
    file.with_extension("html")
}
