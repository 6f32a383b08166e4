//! The report in the formats of other systems: one file a format, each made from the student's edition of a
//! [`Report`], since students read all of them.
//!
//! Names, panic messages and paths may hold anything; what is special in a format is escaped by that format.

mod autolab;
mod classroom50;
mod github;
mod gradescope;
mod junit;
mod markdown;
mod surroundings;

use std::path::{Path, PathBuf};
use std::str::FromStr;

use verdict::edition::for_student;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::report::Report;

use crate::streams::{note, print};

pub use surroundings::{Received, Surroundings};

/// A format of another system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// A summary in GitHub's Markdown.
    Markdown,
    /// JUnit's XML, as GitLab, Jenkins and others show it.
    Junit,
    /// GitHub's annotations: workflow commands for standard output.
    Github,
    /// Gradescope's `results.json`.
    Gradescope,
    /// The `result.json` of Classroom 50.
    Classroom50,
    /// The line that Autolab reads.
    Autolab,
}

impl Format {
    /// The name of its file where none is asked for; `-` is standard output.
    pub fn default_file(self) -> &'static str {
        match self {
            Self::Markdown => "summary.md",
            Self::Junit => "junit.xml",
            Self::Gradescope => "results.json",
            Self::Classroom50 => "result.json",
            Self::Github | Self::Autolab => "-",
        }
    }

    /// The report in this format, without what only staff may see.
    ///
    /// # Errors
    /// If the format's library fails, which is a fault of the grader's.
    pub fn render(self, report: &Report, surroundings: &Surroundings) -> Result<String> {
        let trouble = |error: &dyn std::fmt::Display| Error::Harness(format!("export: {error}"));
        // The one place where it is decided what an export may hold.
        let (report, _) = &for_student(report, None);
        match self {
            Self::Markdown => Ok(markdown::summary(report)),
            Self::Junit => junit::xml(report).map_err(|error| trouble(&error)),
            Self::Github => Ok(github::annotations(report, surroundings)),
            Self::Gradescope => gradescope::results(report, surroundings).map_err(|error| trouble(&error)),
            Self::Classroom50 => classroom50::result(report, surroundings).map_err(|error| trouble(&error)),
            Self::Autolab => autolab::line(report).map_err(|error| trouble(&error)),
        }
    }
}

/// A format and where it goes, as in `junit` or `junit:build/junit.xml`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// The format.
    pub format: Format,
    /// The file; `-` is standard output. Without one, [`Format::default_file`] in the folder of the report.
    pub file: Option<PathBuf>,
}

impl FromStr for Export {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let (name, file) = text.split_once(':').map_or((text, None), |(name, file)| (name, Some(file)));
        let format = <Format as clap::ValueEnum>::from_str(name, false).map_err(|_| {
            let all = <Format as clap::ValueEnum>::value_variants().iter();
            let names: Vec<String> = all
                .filter_map(|format| Some(clap::ValueEnum::to_possible_value(format)?.get_name().to_owned()))
                .collect();
            format!("the formats are {}", names.join(", "))
        })?;
        if file == Some("") {
            return Err("the colon must be followed by the name of a file, or `-`".to_owned());
        }
        Ok(Self { format, file: file.map(PathBuf::from) })
    }
}

impl Export {
    /// Where it goes, for a report in `folder`; `None` is standard output.
    pub fn target(&self, folder: &Path) -> Option<PathBuf> {
        let default = || match self.format.default_file() {
            "-" => PathBuf::from("-"),
            name => folder.join(name),
        };
        let file = self.file.clone().unwrap_or_else(default);
        (file != Path::new("-")).then_some(file)
    }

    /// Writes the report there.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, report: &Report, surroundings: &Surroundings, folder: &Path) -> Result<()> {
        let text = self.format.render(report, surroundings)?;
        let Some(file) = self.target(folder) else { return print(&text) };
        output::write_bytes(&file, &text)?;
        note(format_args!("written: {}", file.display()));
        Ok(())
    }
}

/// The beginning of a text that someone may have made very long.
fn shortened(text: &str, characters: usize) -> String {
    match text.char_indices().nth(characters) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::{STAFF_ONLY, with_staff_only_checks};

    #[test]
    fn no_format_names_what_only_staff_may_see() {
        let report = with_staff_only_checks();
        let surroundings = Surroundings::default();
        for format in <Format as clap::ValueEnum>::value_variants() {
            let text = format.render(&report, &surroundings).expect("it can be made");
            for secret in STAFF_ONLY {
                assert!(!text.contains(secret), "{format:?}, {secret}: {text}");
            }
        }
    }

    #[test]
    fn a_format_may_name_its_file() {
        let export = |text: &str| text.parse::<Export>();
        let folder = Path::new("report");
        let target = |text: &str| export(text).expect("it is a format").target(folder);
        assert_eq!(target("junit"), Some(PathBuf::from("report/junit.xml")));
        assert_eq!(target("junit:a:b.xml"), Some(PathBuf::from("a:b.xml")));
        assert_eq!(target("junit:-"), None);
        assert_eq!(target("autolab"), None);
        assert!(export("word").expect_err("no such format").contains("gradescope"));
        assert!(export("junit:").is_err());
    }
}
