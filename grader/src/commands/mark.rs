//! `grader mark`.

use std::path::PathBuf;
use std::process::ExitCode;

use classroom::marks::{Mark, Marks, why_not};
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use present::page::{Readers, pages_beside, pictures_beside, write_pages};
use present::pictures::load;
use present::print_summary;
use verdict::error::{Error, Result};
use verdict::report::Report;

/// Record the points that a person gives for a task that is not graded automatically.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The submission, as it was graded: a file, folder, archive or git repository
    submission: PathBuf,
    /// The task, as in 5.2a
    task: String,
    /// The points
    points: f64,
    /// What the student is told
    #[arg(long, value_name = "TEXT", default_value = "")]
    comment: String,
    /// The folder of the grade's results: marks are kept there, and go into its report
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    #[command(flatten)]
    assignment: Assignment,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let rubric = arguments.assignment.rubric(&workspace)?;
    if let Some(why) = why_not(&rubric, &arguments.task, arguments.points) {
        return Err(Error::Input(why));
    }
    let intake = intake::take(std::slice::from_ref(&arguments.submission), "")?;
    for explanation in &intake.explanations {
        eprintln!("{}: {} bytes", verdict::text::harmless(&explanation.name), explanation.bytes);
    }
    let submission = intake.outcome.map_err(|refusal| Error::file(&arguments.submission, refusal))?;
    std::fs::create_dir_all(&arguments.out).map_err(|error| Error::file(&arguments.out, error))?;
    let mut marks = Marks::open(&arguments.out)?;
    marks.set(Mark {
        submission: submission.hash(),
        task: arguments.task.clone(),
        points: arguments.points,
        comment: arguments.comment.clone(),
        marked_at: jiff::Timestamp::now().to_string(),
    })?;
    eprintln!("{} of task {}: {}", arguments.points, arguments.task, marks.path().display());
    let file = arguments.out.join("report.json");
    if file.is_file() {
        let mut report = Report::load(&file)?;
        if report.submission.hash == submission.hash() {
            marks.apply(&mut report);
            report.save(&file)?;
            if pages_beside(&file).iter().any(|page| page.is_file()) {
                write_pages(
                    &report,
                    &load(&pictures_beside(&file)).unwrap_or_default(),
                    &file,
                    Readers::Staff(None),
                )?;
            }
            print_summary(&report);
        }
    }
    Ok(ExitCode::SUCCESS)
}
