//! What axe-core, an accessibility checker from npm, finds in a page.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::Browser;

/// The script of axe-core, fetched once; `None`, and says so, without npm or a network.
pub(crate) fn script() -> Option<String> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("axe");
    let file = folder.join("node_modules/axe-core/axe.min.js");
    if !file.is_file() {
        std::fs::create_dir_all(&folder).expect("it can be made");
        let mut npm = Command::new("npm");
        npm.args(["install", "--no-save", "--no-audit", "--no-fund", "--ignore-scripts", "axe-core@4"]);
        let _ = npm.current_dir(&folder).stdout(Stdio::null()).stderr(Stdio::null()).status();
    }
    let script = std::fs::read_to_string(file).ok();
    if script.is_none() {
        // Not by a macro, whose words are kept back of tests that pass.
        let words =
            b"LEFT OUT: npm cannot install axe-core, so that the pages' accessibility was not checked\n";
        std::io::stderr().write_all(words).expect("somebody listens");
    }
    script
}

/// The rules that a page violates, each with the elements that do.
pub(crate) fn violations(browser: &mut Browser, script: &str, page: &Path) -> String {
    browser.open(page, 1280, 900);
    browser.ask(&format!("{script}; 0"));
    browser.ask("window.found = null; axe.run(document).then((it) => { window.found = it.violations; }); 0");
    browser.wait("window.found !== null");
    browser.text(
        "window.found.map((it) => it.id + ': ' + it.help + ' ' + it.nodes.slice(0, 3).map((node) => \
         node.html.slice(0, 200) + ' ' + node.failureSummary).join(' | ')).join('\\n')",
    )
}
