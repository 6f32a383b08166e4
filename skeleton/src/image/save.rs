//! Atomic writing of files.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::diagnostic::Diagnostic;

/// Writes a temporary file and renames it to `path` once it is complete.
///
/// Other processes see either the earlier file (or none) or the complete new one, even after a failure. If `write` fails,
/// the temporary file is removed. The file is not synced to disk: a power failure soon afterwards may lose it.
///
/// # Errors
///
/// The error of `write`, or why the file cannot be created: the folder is missing or read-only, the disk is full, `path` is
/// a folder.
pub fn write_aside<E: Display>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), Diagnostic> {
    // From here on, dropping the temporary file after a failure removes it.
    let temporary = temporary_beside(path)?;
    let mut writer = BufWriter::new(temporary.as_file());
    write(&mut writer).map_err(|error| cannot_write(path, &error))?;
    // Dropping the writer would flush as well, but ignore errors such as a full disk.
    writer.flush().map_err(|error| cannot_write(path, &error))?;
    drop(writer);
    temporary.persist(path).map_err(|error| cannot_write(path, &error.error))?;
    Ok(())
}

/// Checks in advance whether [`write_aside`] can create a file. Does not touch an existing file.
///
/// # Errors
///
/// Why the file cannot be created: the folder is missing or read-only, `path` is a folder.
pub fn check_writable(path: &Path) -> Result<(), Diagnostic> {
    temporary_beside(path).map(drop)
}

/// An empty temporary file in the folder of `path`.
fn temporary_beside(path: &Path) -> Result<NamedTempFile, Diagnostic> {
    let Some(name) = path.file_name() else {
        return Err(cannot_write(path, &"not a file name"));
    };
    if path.is_dir() {
        return Err(cannot_write(path, &"it is a folder"));
    }
    // In the same folder, since files can be renamed within a file system only.
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(cannot_write(path, &format_args!("no such folder: {}", folder.display())));
    }

    let mut prefix = std::ffi::OsString::from(".");
    prefix.push(name);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".part");
    // By default only the owner could read a temporary file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));

    builder.tempfile_in(folder).map_err(|error| cannot_write(path, &error))
}

fn cannot_write(path: &Path, reason: &dyn Display) -> Diagnostic {
    Diagnostic::about(path, format!("cannot be written: {reason}"))
}

/// The folder of a file.
fn folder_of(path: &Path) -> &Path {
    // The parent of a bare file name is the empty path.
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
    fn a_complete_file_replaces_the_earlier_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("result.txt");
        for text in ["first", "second"] {
            write_aside(&path, |file| file.write_all(text.as_bytes())).expect("writing works");
            assert_eq!(fs::read_to_string(&path).expect("the file is there"), text);
        }
        assert_eq!(names_in(folder.path()), ["result.txt"]);
    }

    #[test]
    fn a_failure_keeps_the_earlier_file_and_leaves_no_temporary_file() {
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
    fn a_panic_keeps_the_earlier_file_and_leaves_no_temporary_file() {
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
    fn errors_name_the_obstacle() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("file"), "").expect("writing works");
        let cases = [
            (folder.path().join("missing/x.txt"), "no such folder"),
            (folder.path().join("file/x.txt"), "no such folder"),
            (folder.path().to_owned(), "it is a folder"),
            (folder.path().join(".."), "not a file name"),
        ];
        for (path, reason) in cases {
            let error = write_aside(&path, |file| file.write_all(b"x")).expect_err("this cannot work");
            assert_eq!(error.file, path);
            assert!(error.message.contains(reason), "{error}");
            assert_eq!(check_writable(&path), Err(error), "detected in advance");
        }
    }

    #[test]
    fn checking_in_advance_touches_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("result.txt");
        check_writable(&path).expect("nothing is in the way");
        assert_eq!(names_in(folder.path()), [""; 0]);
        fs::write(&path, "earlier").expect("writing works");
        check_writable(&path).expect("an earlier file may be replaced");
        assert_eq!(fs::read_to_string(&path).expect("the file is there"), "earlier");
    }

    // Not even root can create a file there.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_read_only_folder_is_an_error() {
        let error = write_aside(Path::new("/proc/result.txt"), |file| file.write_all(b"x"))
            .expect_err("this cannot work");
        assert!(error.message.starts_with("cannot be written: "), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn the_file_has_the_default_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_aside(&ours, |file| file.write_all(b"x")).expect("writing works");
        fs::write(&plain, "x").expect("writing works");
        let mode = |path: &Path| fs::metadata(path).expect("the file is there").permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }

    #[test]
    fn a_bare_file_name_is_in_the_current_folder() {
        assert_eq!(folder_of(Path::new("result.txt")), Path::new("."));
        assert_eq!(folder_of(Path::new("out/result.txt")), Path::new("out"));
    }
}
