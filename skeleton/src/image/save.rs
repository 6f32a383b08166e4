//! Writing a file so that it is there whole or not at all.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::diagnostic::Diagnostic;

/// Writes a file aside and moves it to `path` once it is complete.
///
/// Whoever reads `path` meanwhile, also after a failure in the middle, finds the earlier file there (or
/// none), never half of the new one. What was written of the new one is removed if `write` fails. The
/// file is not forced to the disk: a loss of power soon afterwards may lose it.
///
/// # Errors
///
/// What `write` failed with, or why the file cannot be there: its folder is missing or may not be written
/// to, the disk is full, `path` is a folder.
pub fn write_aside<E: Display>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), Diagnostic> {
    // If anything fails from here on, dropping the temporary file removes it.
    let temporary = temporary_beside(path)?;
    let mut writer = BufWriter::new(temporary.as_file());
    write(&mut writer).map_err(|error| cannot_write(path, &error))?;
    // Dropping the writer would flush too, but swallow the error of a full disk.
    writer.flush().map_err(|error| cannot_write(path, &error))?;
    drop(writer);
    temporary.persist(path).map_err(|error| cannot_write(path, &error.error))?;
    Ok(())
}

/// Finds out whether [`write_aside`] would have a place for a file, before the work to fill it is done.
///
/// Neither the file nor an earlier one of that name is touched.
///
/// # Errors
///
/// Why the file cannot be there: its folder is missing or may not be written to, `path` is a folder.
pub fn check_writable(path: &Path) -> Result<(), Diagnostic> {
    temporary_beside(path).map(drop)
}

/// An empty file in the folder of `path`, which is removed when it is dropped.
fn temporary_beside(path: &Path) -> Result<NamedTempFile, Diagnostic> {
    let Some(name) = path.file_name() else {
        return Err(cannot_write(path, &"this does not name a file"));
    };
    if path.is_dir() {
        return Err(cannot_write(path, &"this is a folder"));
    }
    // The temporary file has to be in the same folder, since a file can only be renamed on the same disk.
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(cannot_write(path, &format_args!("there is no folder {}", folder.display())));
    }

    let mut prefix = std::ffi::OsString::from(".");
    prefix.push(name);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".part");
    // The result is no secret: without this, only its owner could read it.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));

    builder.tempfile_in(folder).map_err(|error| cannot_write(path, &error))
}

fn cannot_write(path: &Path, reason: &dyn Display) -> Diagnostic {
    Diagnostic::about(path, format!("cannot be written: {reason}"))
}

/// The folder that a file lies in.
fn folder_of(path: &Path) -> &Path {
    // The parent of a bare file name is the empty path, which names no folder.
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io;

    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder can be listed");
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_complete_file_replaces_the_earlier_one_and_nothing_else_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("result.txt");
        for text in ["first", "second"] {
            write_aside(&path, |file| file.write_all(text.as_bytes())).expect("writing works");
            assert_eq!(fs::read_to_string(&path).expect("the file is there"), text);
        }
        assert_eq!(names_in(folder.path()), ["result.txt"]);
    }

    #[test]
    fn a_failure_in_the_middle_keeps_the_earlier_file_and_leaves_no_rest() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("result.txt");
        fs::write(&path, "earlier").expect("writing works");
        let error = write_aside(&path, |file| {
            file.write_all(b"half of it")?;
            file.flush()?;
            Err(io::Error::other("out of ideas"))
        })
        .expect_err("the failure is passed on");
        assert!(error.to_string().ends_with("result.txt: cannot be written: out of ideas"), "{error}");
        assert_eq!(fs::read_to_string(&path).expect("the file is there"), "earlier");
        assert_eq!(names_in(folder.path()), ["result.txt"]);
    }

    #[test]
    fn a_panic_in_the_middle_keeps_the_earlier_file_and_leaves_no_rest() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("result.txt");
        fs::write(&path, "earlier").expect("writing works");
        let outcome =
            std::panic::catch_unwind(|| write_aside(&path, |_| -> io::Result<()> { panic!("on purpose") }));
        assert!(outcome.is_err());
        assert_eq!(fs::read_to_string(&path).expect("the file is there"), "earlier");
        assert_eq!(names_in(folder.path()), ["result.txt"]);
    }

    #[test]
    fn what_stands_in_the_way_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("file"), "").expect("writing works");
        let cases = [
            (folder.path().join("missing/x.txt"), "there is no folder"),
            (folder.path().join("file/x.txt"), "there is no folder"),
            (folder.path().to_owned(), "this is a folder"),
            (folder.path().join(".."), "this does not name a file"),
        ];
        for (path, reason) in cases {
            let error = write_aside(&path, |file| file.write_all(b"x")).expect_err("this cannot work");
            assert_eq!(error.file, path);
            assert!(error.message.contains(reason), "{error}");
            assert_eq!(check_writable(&path), Err(error), "known beforehand");
        }
    }

    #[test]
    fn a_check_beforehand_touches_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("result.txt");
        check_writable(&path).expect("nothing is in the way");
        assert_eq!(names_in(folder.path()), [""; 0]);
        fs::write(&path, "earlier").expect("writing works");
        check_writable(&path).expect("an earlier file may be replaced");
        assert_eq!(fs::read_to_string(&path).expect("the file is there"), "earlier");
    }

    // Not even the superuser can create a file there.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_that_may_not_be_written_to_is_an_error() {
        let error = write_aside(Path::new("/proc/result.txt"), |file| file.write_all(b"x"))
            .expect_err("this cannot work");
        assert!(error.message.starts_with("cannot be written: "), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_the_result_if_they_may_read_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_aside(&ours, |file| file.write_all(b"x")).expect("writing works");
        fs::write(&plain, "x").expect("writing works");
        let mode = |path: &Path| fs::metadata(path).expect("the file is there").permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }

    #[test]
    fn a_bare_file_name_lies_in_the_current_folder() {
        assert_eq!(folder_of(Path::new("result.txt")), Path::new("."));
        assert_eq!(folder_of(Path::new("out/result.txt")), Path::new("out"));
    }
}
