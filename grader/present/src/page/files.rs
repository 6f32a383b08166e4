//! The pages as files beside a report.

use std::path::{Path, PathBuf};

use super::page;
use verdict::edition::{Edition, for_student};
use verdict::error::Result;
use verdict::output;
use verdict::pictures::Picture;
use verdict::report::Report;

/// For whom pages are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readers<'a> {
    /// The student, who graded their own file: `report.html`.
    Student,
    /// Staff and the student: `report-tutor.html`, too. With a path, the student's page names it instead of the
    /// submission's.
    Staff(Option<&'a str>),
}

/// Writes the pages of a report beside its file.
///
/// # Errors
/// If a file cannot be written.
pub fn write_pages(report: &Report, pictures: &[Picture], file: &Path, readers: Readers<'_>) -> Result<()> {
    let path = match readers {
        Readers::Student => None,
        Readers::Staff(path) => path,
    };
    let (student, edition) = for_student(report, path);
    let [for_students, for_tutors] = pages_beside(file);
    if readers == Readers::Student {
        return output::write_bytes(&for_students, small_enough(&student, pictures, edition));
    }
    for (target, report, edition) in [(for_students, &student, edition), (for_tutors, report, Edition::Tutor)]
    {
        output::write_bytes(&target, small_enough(report, pictures, edition))?;
    }
    Ok(())
}

/// Writes the student's page of a report that will be replaced on the next save: without pictures, and it reloads itself.
///
/// # Errors
/// If the file cannot be written.
pub fn write_watched_pages(report: &Report, file: &Path) -> Result<()> {
    let (student, edition) = for_student(report, None);
    let [for_students, _] = pages_beside(file);
    output::write_bytes(&for_students, super::watched_page(&student, edition))
}

/// The most bytes of a page: it is sent by mail, and kept for everybody.
const LARGEST: usize = 3_000_000;

/// The page, without its last pictures if it would be too large with them.
fn small_enough(report: &Report, pictures: &[Picture], edition: Edition) -> String {
    let shown = |count: usize| page(report, &pictures[..count], edition);
    let sizes = (1..=pictures.len()).rev();
    sizes.map(shown).find(|text| text.len() <= LARGEST).unwrap_or_else(|| shown(0))
}

/// Removes the pages of an earlier grade, which would lie beside the report of another, and their pictures.
///
/// # Errors
/// If one is there and cannot be removed.
pub fn remove_pages(file: &Path) -> Result<()> {
    let [student, tutor] = pages_beside(file);
    [student, tutor, pictures_beside(file)].iter().try_for_each(|path| output::remove(path))
}

/// The student's edition, `report.html`, and the tutor's, `report-tutor.html`, beside a `report.json`.
pub fn pages_beside(file: &Path) -> [PathBuf; 2] {
    ["report.html", "report-tutor.html"].map(|name| file.with_file_name(name))
}

/// The pictures of the pages, beside a `report.json`.
pub fn pictures_beside(file: &Path) -> PathBuf {
    file.with_file_name("pictures.bin")
}
