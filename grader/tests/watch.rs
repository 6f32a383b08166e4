//! `grade --watch`, as someone at an editor meets it.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// The program, ended when the test is over, however that comes about.
struct Watching {
    child: Child,
    lines: Receiver<String>,
}

impl Watching {
    fn start(folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_grader"))
            .args(["grade", "render_pt.rs", "--watch", "--only=mean-bias/cornell_box_point/nee/1"])
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let output = BufReader::new(child.stdout.take().expect("stdout is piped"));
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            output.lines().map_while(Result::ok).try_for_each(|line| sender.send(line))
        });
        Self { child, lines }
    }

    /// Reads until a line has the text in it.
    fn expect(&self, text: &str) {
        let mut seen = String::new();
        // The framework may have to be built first.
        while let Ok(line) = self.lines.recv_timeout(Duration::from_secs(400)) {
            if line.contains(text) {
                return;
            }
            seen += &line;
            seen.push('\n');
        }
        panic!("`{text}` did not come:\n{seen}");
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn every_save_is_graded_whatever_is_saved() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let solution =
        std::fs::read_to_string(root.join("solution/src/algorithms/render_pt.rs")).expect("it is there");
    let starter =
        std::fs::read_to_string(root.join("skeleton/src/algorithms/render_pt.rs")).expect("it is there");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("render_pt.rs");
    let save = |text: &str| std::fs::write(&file, text).expect("it can be written");
    save(&starter);
    let watching = Watching::start(folder.path());
    watching.expect("Nothing has been filled in yet");
    let page = std::fs::read_to_string(folder.path().join("report/report.html")).expect("there is a page");
    assert!(page.contains("location.reload"), "it reloads itself");
    save("this is no program");
    watching.expect("does not compile");
    std::fs::remove_file(&file).expect("it can be removed");
    watching.expect("waiting: ");
    // As many editors save: another file is given the name.
    std::fs::write(folder.path().join("new"), &solution).expect("it can be written");
    std::fs::rename(folder.path().join("new"), &file).expect("it can be renamed");
    watching.expect("since the last save: now passes: mean-bias/cornell_box_point/nee/1");
}
