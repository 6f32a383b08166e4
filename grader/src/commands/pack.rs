//! `grader pack`: what students hand in.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use jiff::Timestamp;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::lateness::standing;
use super::policy::policy;
use classroom::policy::Receipt;
use harness::assignment::Assignment;
use harness::build::{Framework, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use intake::md5_of;
use verdict::error::{Error, Result};
use verdict::submission::FILE_NAME;

/// Pack your submission: checks that it compiles, packs it with your explanation, prints the MD5 checksum.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The file to hand in [default: the student file in the skeleton]
    file: Option<PathBuf>,
    /// The written explanation (.txt, .md or .pdf); may be given several times
    #[arg(long, value_name = "FILE")]
    explanation: Vec<PathBuf>,
    /// The archive to write
    #[arg(long, value_name = "FILE.zip", default_value = "submission.zip")]
    out: PathBuf,
    /// Pack it even if it does not compile: it will earn points only where a person gives them
    #[arg(long)]
    anyway: bool,
    /// Your login, if you have an extension
    #[arg(long, default_value = "")]
    student: String,
    #[command(flatten)]
    assignment: Assignment,
    /// Deadline and extensions [default: course.yml beside the rubric, if there is one]
    #[arg(long, value_name = "FILE.yml")]
    course: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let rubric = arguments.assignment.rubric(&workspace)?;
    let policy = policy(&workspace, &arguments.assignment.name, &rubric, arguments.course.as_deref())?;
    let file = arguments.file.clone().unwrap_or_else(|| workspace.student_file());
    let submission = intake::read(&file)?;
    let mut entries = vec![(FILE_NAME.to_owned(), submission.source.clone().into_bytes())];
    for path in &arguments.explanation {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let lower = name.to_lowercase();
        if ![".txt", ".md", ".pdf"].iter().any(|end| lower.ends_with(end)) {
            return Err(Error::file(path, "an explanation is a .txt, .md or .pdf"));
        }
        if entries.iter().any(|(other, _)| *other == name) {
            return Err(Error::file(path, "there is another file of this name"));
        }
        entries.push((name, std::fs::read(path).map_err(|error| Error::file(path, error))?));
    }
    eprintln!("compiling {} …", file.display());
    if let Err(failure) = compile(&Framework::build(&workspace)?, &submission.source, &Limits::default())? {
        eprintln!("{}", failure.messages);
        if !arguments.anyway {
            return Err(Error::Input(
                "it does not compile, and was not packed (--anyway packs it)".to_owned(),
            ));
        }
    }
    if entries.len() == 1 && rubric.tasks.iter().any(|task| task.manual) {
        eprintln!("note: there is no written explanation in it (--explanation=FILE)");
    }
    let bytes = archive(&entries).map_err(|error| Error::Harness(format!("the archive: {error}")))?;
    arty::image::write_aside(&arguments.out, |writer| writer.write_all(&bytes))?;
    println!("{}: {} bytes, MD5 {}", arguments.out.display(), bytes.len(), md5_of(&bytes));
    for (name, _) in &entries {
        println!("  {name}");
    }
    let now = Receipt { received_at: Some(Timestamp::now()), ..Receipt::default() };
    let names = [arguments.student.as_str()];
    if let Some(standing) = policy.as_ref().and_then(|policy| standing(policy, &names, &now, &[])) {
        println!("{standing}");
    }
    Ok(ExitCode::SUCCESS)
}

/// A zip archive that is the same whenever and wherever it is made.
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
