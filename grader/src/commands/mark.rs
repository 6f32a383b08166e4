//! `grader mark`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::intake::{reader, wanted};
use super::marks_table::{Entry, entries};
use classroom::class::gradebook::{Row, load_rows};
use classroom::class::lookup::Lookup;
use classroom::marks::{Mark, Marks, fingerprint, why_not};
use harness::assignment::{Assignment, AssignmentOption};
use harness::workspace::Workspace;
use present::page::{Readers, pages_beside, pictures_beside, write_pages};
use present::pictures::load;
use present::streams::note;
use present::words::count;
use present::{Detail, print_summary};
use verdict::error::{Error, Result};
use verdict::report::Report;
use verdict::rubric::Rubric;
use verdict::text::harmless;

/// Record the points a tutor gives for a task that is not graded automatically
///
/// In the results of a class, a mark belongs to a student and to the explanation that was handed in.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Student of a class (login, e-mail address, number, name, or the submission's folder); without a class, the
    /// submission that was graded
    #[arg(required_unless_present = "from")]
    student: Option<String>,
    /// Source to use if a submission that was graded alone holds several: the end of its path, in archives too
    #[arg(long, value_name = "PATH", conflicts_with = "from")]
    source: Option<String>,
    /// Task, by its number on the sheet
    #[arg(required_unless_present = "from")]
    task: Option<String>,
    /// Points
    #[arg(required_unless_present = "from")]
    points: Option<f64>,
    /// Comment for the student
    #[arg(long, value_name = "TEXT", default_value = "")]
    comment: String,
    /// Table of marks: columns student, task, points, comment; or student, a column for each task, comment
    #[arg(long, value_name = "FILE", conflicts_with_all = ["student", "comment"])]
    from: Option<PathBuf>,
    /// Folder with the results of the class or of the grade; marks are stored there
    #[arg(long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    #[command(flatten)]
    assignment: AssignmentOption,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let assignment = arguments.assignment.open(workspace)?;
    let rubric = &assignment.rubric;
    let entries = arguments.entries(rubric)?;
    for Entry { at, task, points, .. } in &entries {
        if let Some(why) = why_not(rubric, task, *points) {
            return Err(Error::Input(format!("{at}{why}")));
        }
    }
    let class = arguments.out.join("class.json");
    if class.is_file() {
        return mark_in_class(&arguments.out, &load_rows(&class)?, &entries);
    }
    if arguments.from.is_some() {
        return Err(Error::file(
            &arguments.out,
            "there is no class.json: --from needs the results of a class",
        ));
    }
    entries.iter().try_for_each(|entry| mark_alone(arguments, &assignment, entry))?;
    Ok(ExitCode::SUCCESS)
}

impl Arguments {
    /// The marks to record.
    fn entries(&self, rubric: &Rubric) -> Result<Vec<Entry>> {
        if let Some(path) = &self.from {
            return entries(path, rubric);
        }
        let (Some(student), Some(task), Some(points)) = (&self.student, &self.task, self.points) else {
            return Err(Error::Input("give student, task and points, or --from".to_owned()));
        };
        let (student, task, comment) = (student.clone(), task.clone(), self.comment.clone());
        Ok(vec![Entry { at: String::new(), student, task, points, comment }])
    }
}

fn mark(student: &str, explanation: &str, entry: &Entry) -> Mark {
    Mark {
        student: student.to_owned(),
        task: entry.task.clone(),
        explanation: explanation.to_owned(),
        points: entry.points,
        comment: entry.comment.clone(),
        marked_at: jiff::Timestamp::now().to_string(),
    }
}

/// Records marks of rows of a class: all of them, or none if one is wrong or contradicts another.
fn mark_in_class(out: &Path, rows: &[Row], entries: &[Entry]) -> Result<ExitCode> {
    let lookup = Lookup::new(rows);
    let mut marks: Vec<Mark> = Vec::new();
    let mut told = Vec::new();
    for entry in entries {
        let (task, points) = (&entry.task, entry.points);
        let blame = |message: String| Error::Input(format!("{}{message}", entry.at));
        for row in lookup.rows_of(&entry.student).map_err(blame)? {
            let earlier = marks.iter().find(|mark| mark.student == row.key && mark.task == *task);
            if let Some(other) =
                earlier.filter(|other| other.points != points || other.comment != entry.comment)
            {
                return Err(blame(format!(
                    "`{}` has another mark in task {task}, {} points, on an earlier line: keep one of the two",
                    row.key, other.points
                )));
            }
            marks.push(mark(&row.key, &row.explanation, entry));
            let what = match row.explanations.as_slice() {
                [] => "no explanation was handed in".to_owned(),
                names => names.join(", "),
            };
            told.push(format!("{}, task {task}: {points} points ({})", harmless(&row.key), harmless(&what)));
        }
    }
    told.iter().for_each(note);
    let marks = Marks::add(out, marks)?;
    note(format_args!("stored in {}; `grader class … --resume` updates the tables", marks.path().display()));
    Ok(ExitCode::SUCCESS)
}

/// Records a mark of a submission that was graded alone, and adds it to its report and pages.
fn mark_alone(arguments: &Arguments, assignment: &Assignment, entry: &Entry) -> Result<()> {
    let path = PathBuf::from(&entry.student);
    let wanted = wanted(assignment)?;
    let intake = reader().take(std::slice::from_ref(&path), &wanted, arguments.source.as_deref())?;
    for explanation in &intake.explanations {
        note(format_args!("{}: {}", harmless(&explanation.name), count(explanation.bytes, "byte")));
    }
    let file = arguments.out.join("report.json");
    let mut report = Report::load(&file)?;
    let hash = intake.outcome.as_ref().map_or_else(|_| String::new(), |submission| submission.hash());
    if report.submission.hash != hash
        || fingerprint(&report.submission.explanations) != fingerprint(&intake.explanations)
    {
        return Err(Error::file(
            &file,
            format!("this is not the grade of {}: grade it first", path.display()),
        ));
    }
    let student = report.submission.path.clone();
    let marks = Marks::add(&arguments.out, vec![mark(&student, &fingerprint(&intake.explanations), entry)])?;
    note(format_args!("task {}: {} points, stored in {}", entry.task, entry.points, marks.path().display()));
    marks.apply(&mut report, &student);
    report.save(&file)?;
    if pages_beside(&file).iter().any(|page| page.is_file()) {
        let pictures = load(&pictures_beside(&file)).unwrap_or_default();
        write_pages(&report, &pictures, &file, Readers::Staff(None))?;
    }
    print_summary(&report, Detail::All);
    Ok(())
}
