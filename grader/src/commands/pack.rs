//! `grader pack`: the archive that students hand in.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use jiff::Timestamp;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::intake::{reader, wanted};
use super::lateness::standing;
use super::policy::policy;
use ::intake::md5_of;
use classroom::policy::Receipt;
use harness::assignment::AssignmentOption;
use harness::build::compile;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use present::streams::{note, print_line};
use present::words::count;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::submission::Submission;

/// Pack your submission with your explanation, check that it compiles, and print its MD5 checksum
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// File to hand in [default: the student file in the skeleton]
    file: Option<PathBuf>,
    /// Written explanation (.txt, .md or .pdf); repeatable
    #[arg(long, value_name = "FILE")]
    explanation: Vec<PathBuf>,
    /// Archive to write
    #[arg(long, value_name = "FILE.zip", default_value = "submission.zip")]
    out: PathBuf,
    /// Pack the file even if it does not compile; only your tutor can then give points
    #[arg(long)]
    anyway: bool,
    /// Your login, if you were granted an extension
    #[arg(long, default_value = "")]
    student: String,
    #[command(flatten)]
    assignment: AssignmentOption,
    /// Deadline and extensions [default: course.yml beside the rubric, if there is one]
    #[arg(long, value_name = "FILE.yml")]
    course: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let assignment = arguments.assignment.open(workspace)?;
    let policy = policy(&assignment, arguments.course.as_deref())?;
    let file = arguments.file.clone().unwrap_or_else(|| assignment.student_file());
    let submission = reader().read(&file, &wanted(&assignment)?)?;
    let rubric = &assignment.rubric;
    let entries = entries(rubric.submission.name(), &submission, &arguments.explanation)?;
    note(format_args!("compiling {} …", file.display()));
    if let Err(failure) = compile(&assignment.framework(workspace)?, &submission.source, &Limits::default())?
    {
        note(&failure.messages);
        if !arguments.anyway {
            return Err(Error::Input("not packed: it does not compile (--anyway packs it)".to_owned()));
        }
    }
    if arguments.explanation.is_empty() && rubric.tasks.iter().any(|task| task.manual) {
        note("note: there is no written explanation in it (--explanation=FILE)");
    }
    let bytes = archive(&entries).map_err(|error| Error::Harness(format!("the archive: {error}")))?;
    output::write_bytes(&arguments.out, &bytes)?;
    let size = count(bytes.len(), "byte");
    print_line(format_args!("{}: {size}, MD5 {}", arguments.out.display(), md5_of(&bytes)))?;
    for (name, _) in &entries {
        print_line(format_args!("  {name}"))?;
    }
    let now = Receipt { received_at: Some(Timestamp::now()), ..Receipt::default() };
    let names = [arguments.student.as_str()];
    if let Some(standing) = policy.as_ref().and_then(|policy| standing(policy, &names, &now, &[])) {
        print_line(standing)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Names and contents of the files in the archive.
fn entries(name: &str, submission: &Submission, explanations: &[PathBuf]) -> Result<Vec<(String, Vec<u8>)>> {
    let mut entries = vec![(name.to_owned(), submission.source.clone().into_bytes())];
    for path in explanations {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !is_explanation(path) {
            return Err(Error::file(path, "an explanation is a .txt, .md or .pdf"));
        }
        if entries.iter().any(|(other, _)| *other == name) {
            return Err(Error::file(path, "there is another file of this name"));
        }
        entries.push((name, std::fs::read(path).map_err(|error| Error::file(path, error))?));
    }
    Ok(entries)
}

fn is_explanation(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["txt", "md", "pdf"].iter().any(|known| extension.eq_ignore_ascii_case(known))
}

/// Makes a zip archive whose bytes depend on nothing but the entries.
fn archive(entries: &[(String, Vec<u8>)]) -> zip::result::ZipResult<Vec<u8>> {
    let mut writer = ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::DEFAULT)
        .unix_permissions(0o644);
    for (name, bytes) in entries {
        writer.start_file(name.as_str(), options)?;
        writer.write_all(bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}
