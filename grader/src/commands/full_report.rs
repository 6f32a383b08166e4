//! What a grade does once its points stand: error against run time, pictures, and the report as a page.

use std::path::{Path, PathBuf};

use crate::build::{Framework, HandInProgram, compile};
use crate::convergence::{brief, print_sentences};
use crate::error::{Error, Result};
use crate::report::{Picture, Report, page, pictures};
use crate::sandbox::Limits;
use crate::submission::Submission;
use crate::workspace::Workspace;

/// Completes a report, saves it again, and writes it as `report.html` beside it. The points do not change.
pub(super) fn complete(
    workspace: &Workspace,
    submission: &Submission,
    seed: u64,
    report: &mut Report,
    file: &Path,
) -> Result<()> {
    let mut shown = Vec::new();
    if report.submission.build_failure.is_none() {
        eprintln!("measuring error against run time, for no points (--no-report leaves it out) …");
        let framework = Framework::build(workspace)?;
        let (hand_in, solution) = rayon::join(
            || compile(&framework, &submission.source, &Limits::default()),
            || solution(workspace, &framework),
        );
        if let Ok(hand_in) = hand_in? {
            let convergence = brief(workspace, &hand_in, solution?.as_ref(), seed)?;
            println!("\nError against run time, for no points");
            print_sentences(&convergence);
            report.convergence = Some(convergence);
            shown = pictures(workspace, &hand_in, report, rayon::current_num_threads(), seed)?;
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

/// The solution, in a checkout that has one which compiles.
fn solution(workspace: &Workspace, framework: &Framework) -> Result<Option<HandInProgram>> {
    let path = workspace.solution_file();
    if !path.is_file() {
        return Ok(None);
    }
    Ok(compile(framework, &Submission::read(&path)?.source, &Limits::default())?.ok())
}
