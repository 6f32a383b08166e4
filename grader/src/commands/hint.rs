//! `grader hint`.

use std::path::PathBuf;
use std::process::ExitCode;

use super::intake::source_of;
use harness::workspace::Workspace;
use present::streams::{note, print_line};
use present::words;
use verdict::error::{Error, Result};
use verdict::report::Report;

/// Say more about the next step: 1 = what its check saw, 2 = likely causes and their questions, 3 = where to look
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Level of detail
    #[arg(value_name = "LEVEL", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=LEVELS))]
    level: u8,
    /// Report of the last grade
    #[arg(long, value_name = "FILE", default_value = "report/report.json")]
    report: PathBuf,
}

const LEVELS: i64 = 3;

pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    if !arguments.report.exists() {
        let remedy = "there is no report yet: run `cargo grade` first, or name a report with --report";
        return Err(Error::file(&arguments.report, remedy));
    }
    let report = Report::load(&arguments.report)?;
    let path = PathBuf::from(&report.submission.path);
    let source = source_of(&report);
    if source.as_ref().is_some_and(|now| now.hash() != report.submission.hash) {
        note(format_args!("note: {} has changed since this grade: `cargo grade`", path.display()));
    }
    let Some(next) = report.next() else {
        let nothing = || "There is nothing to give a hint for: no check failed.".to_owned();
        print_line(words::finish(&report).unwrap_or_else(nothing))?;
        return Ok(ExitCode::SUCCESS);
    };
    print_line(words::next_heading(&next))?;
    match arguments.level {
        1 => words::hint_on_check(&report, &next),
        2 => words::hint_on_causes(&report, &next),
        _ => {
            let text = source.map(|submission| submission.source).unwrap_or_default();
            let sheet = workspace.assignment(&report.assignment).sheet();
            let sheet = sheet.strip_prefix(workspace.root()).map(PathBuf::from).unwrap_or(sheet);
            let mut lines: Vec<String> = marks_of(&text, &next.task.id)
                .into_iter()
                .map(|line| format!("{}:{line}: a place of this task", path.display()))
                .collect();
            lines.push(format!("{}: the section on {}", sheet.display(), next.task.id));
            lines.extend(words::hint_on_paths(&report, &next));
            lines
        }
    }
    .into_iter()
    .try_for_each(|line| print_line(format_args!("  {line}")))?;
    if i64::from(arguments.level) < LEVELS {
        print_line(format_args!("more: `cargo hint {}`", arguments.level + 1))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Lines of the marks `// TASK` that name a task, counted from 1.
fn marks_of(source: &str, task: &str) -> Vec<usize> {
    let names = |line: &str| {
        let mark = line.trim().strip_prefix("// TASK ")?.split(':').next()?;
        mark.split(',').any(|name| name.trim() == task).then_some(())
    };
    source.lines().enumerate().filter_map(|(index, line)| names(line).map(|()| index + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_found_by_the_task_that_they_name() {
        let source = "\n  // TASK 5.1a, 5.2b: sample\n// END 5.1a\n// TASK 5.1b: weight\n// see TASK 5.1a";
        assert_eq!(marks_of(source, "5.1a"), [2]);
        assert_eq!(marks_of(source, "5.2b"), [2]);
        assert_eq!(marks_of(source, "5.1"), [0; 0]);
    }
}
