//! `grader mark`.

use std::path::PathBuf;
use std::process::ExitCode;

use super::intake::reader;
use classroom::marks::{Mark, Marks, why_not};
use harness::assignment::Assignment;
use harness::workspace::Workspace;
use present::page::{Readers, pages_beside, pictures_beside, write_pages};
use present::pictures::load;
use present::streams::note;
use present::words::count;
use present::{Detail, print_summary};
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::Report;
use verdict::text::harmless;

/// Record the points a tutor gives for a task that is not graded automatically
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The submission that was graded: a file, folder, archive or git repository
    submission: PathBuf,
    /// Source to use if there are several: the end of its path, in archives too
    #[arg(long, value_name = "PATH")]
    source: Option<String>,
    /// Task, such as 5.2a
    task: String,
    /// Points
    points: f64,
    /// Comment for the student
    #[arg(long, value_name = "TEXT", default_value = "")]
    comment: String,
    /// Folder with the results of the grade; marks are stored there and added to its report
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    #[command(flatten)]
    assignment: Assignment,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let rubric = arguments.assignment.rubric(workspace)?;
    if let Some(why) = why_not(&rubric, &arguments.task, arguments.points) {
        return Err(Error::Input(why));
    }
    let intake =
        reader().take(std::slice::from_ref(&arguments.submission), "", arguments.source.as_deref())?;
    for explanation in &intake.explanations {
        note(format_args!("{}: {}", harmless(&explanation.name), count(explanation.bytes, "byte")));
    }
    let submission = intake.outcome.map_err(|refusal| Error::file(&arguments.submission, refusal))?;
    output::create_folder(&arguments.out)?;
    let mut marks = Marks::open(&arguments.out)?;
    marks.set(Mark {
        submission: submission.hash(),
        task: arguments.task.clone(),
        points: arguments.points,
        comment: arguments.comment.clone(),
        marked_at: jiff::Timestamp::now().to_string(),
    })?;
    let Arguments { task, points, .. } = arguments;
    note(format_args!("task {task}: {points} points, stored in {}", marks.path().display()));
    update_report(arguments, &submission.hash(), &marks)?;
    Ok(ExitCode::SUCCESS)
}

/// Adds the marks to the report of the grade, if it is of the same submission, and to its pages.
fn update_report(arguments: &Arguments, submission: &str, marks: &Marks) -> Result<()> {
    let file = arguments.out.join("report.json");
    if !file.is_file() {
        return Ok(());
    }
    let mut report = Report::load(&file)?;
    if report.submission.hash != submission {
        return Ok(());
    }
    marks.apply(&mut report);
    report.save(&file)?;
    if pages_beside(&file).iter().any(|page| page.is_file()) {
        let pictures = load(&pictures_beside(&file)).unwrap_or_default();
        write_pages(&report, &pictures, &file, Readers::Staff(None))?;
    }
    print_summary(&report, Detail::All);
    Ok(())
}
