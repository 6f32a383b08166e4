//! Archives of feedback in the layouts that Moodle ("Upload multiple feedback files in a zip") and ILIAS ("Multi-Feedback")
//! take back: a folder for each student, named as the system names it, with the student's report.

use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::record::ResultDir;
use verdict::error::{Error, Result};
use verdict::output;

/// The feedback of one student.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Feedback {
    /// Key of the row.
    pub key: String,
    /// Folder in the archive.
    pub folder: String,
}

/// Moodle's name for the folder of a participant. It splits the name at `_`: the second part is the number.
pub(super) fn moodle_folder(name: &str, number: &str) -> String {
    let name = plain(name);
    let name = if name.is_empty() { "Participant" } else { &name };
    format!("{name}_{number}_assignsubmission_file_")
}

/// ILIAS's name for the folder of a participant: the last part is the number. All of them are in one folder whose name
/// begins with `multi_feedback`.
pub(super) fn ilias_folder(last_name: &str, first_name: &str, login: &str, number: &str) -> String {
    format!("multi_feedback/{}_{}_{login}_{number}", plain(last_name), plain(first_name))
}

/// A name without what separates names or folders.
fn plain(name: &str) -> String {
    name.chars()
        .map(|c| if "_/\\".contains(c) || c.is_control() { ' ' } else { c })
        .collect::<String>()
        .trim()
        .to_owned()
}

/// Writes the archive with the reports of a class in `out`. Returns the number of reports; students without one are left
/// out.
///
/// # Errors
/// If it cannot be written.
pub fn save(path: &Path, out: &Path, list: &[Feedback]) -> Result<usize> {
    let mut count = 0;
    output::write(path, |file| -> std::io::Result<()> {
        let mut archive = ZipWriter::new(file);
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(zip::DateTime::DEFAULT)
            .unix_permissions(0o644);
        for Feedback { key, folder } in list {
            let [student, _] = ResultDir::new(out, key).pages();
            let Ok(mut page) = std::fs::File::open(&student) else { continue };
            archive.start_file(format!("{folder}/report.html"), options)?;
            std::io::copy(&mut page, &mut archive)?;
            count += 1;
        }
        archive.finish().map(drop).map_err(std::io::Error::from)
    })?;
    if count == 0 {
        return Err(Error::file(out, "there are no reports to hand back: grade without --no-report"));
    }
    Ok(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_read_back_by_the_systems() {
        // Moodle splits at `_` into at most five parts: name, number, type, plugin, rest.
        let moodle = moodle_folder("Ann_Marie O/Lee", "11");
        let parts: Vec<&str> = moodle.splitn(5, '_').collect();
        assert_eq!(parts, ["Ann Marie O Lee", "11", "assignsubmission", "file", ""]);
        let ilias = ilias_folder("de la Cruz", "Bo", "bc_2", "302");
        assert_eq!(ilias.rsplit('_').next(), Some("302"));
        assert!(ilias.starts_with("multi_feedback/de la Cruz_Bo_bc_2"));
    }

    #[test]
    fn the_archive_holds_the_students_edition_only() {
        let out = tempfile::tempdir().expect("a temporary folder");
        let folder = out.path().join("submissions/ann");
        std::fs::create_dir_all(&folder).expect("it can be made");
        std::fs::write(folder.join("report.html"), "hers").expect("it can be written");
        std::fs::write(folder.join("report-tutor.html"), "secret").expect("it can be written");
        let entry = |key: &str| Feedback { key: key.to_owned(), folder: moodle_folder(key, "11") };
        let path = out.path().join("feedback.zip");
        assert_eq!(save(&path, out.path(), &[entry("ann"), entry("bob")]).expect("it can be written"), 1);
        let mut archive =
            zip::ZipArchive::new(std::fs::File::open(path).expect("it is there")).expect("a zip");
        assert_eq!(archive.len(), 1);
        let file = archive.by_name("ann_11_assignsubmission_file_/report.html").expect("it has one");
        let text = std::io::read_to_string(file).expect("it is text");
        assert_eq!(text, "hers");
        assert!(save(&out.path().join("none.zip"), out.path(), &[entry("bob")]).is_err());
    }
}
