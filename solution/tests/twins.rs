//! The starter and the solution are the same outside of the blocks to fill in.
//!
//! The files are read when the test runs, so that nothing in `skeleton/` depends on the solution.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

/// The only code in the starter's blocks: without it, the starter would not compile, or not without warnings. This list
/// is what a reviewer has approved; the grader reads the blocks of the assignment's `starter.rs` instead.
const STARTER_CODE: [&str; 6] = [
    "last_bounce = Some(LastBounce {});",
    "let _ = (scene, hit, bsdf, sampler); // Delete this line once you use them.",
    "Rgb::BLACK",
    "let _ = (scene, hit, emission, last_bounce); // Delete this line once you use them.",
    "1.0",
    "struct LastBounce {}",
];

/// A block to fill in.
struct Block {
    /// Its tasks, such as `5.1a, 5.2b`.
    tasks: String,
    /// The lines between its marks.
    lines: Vec<String>,
}

/// A file, split into blocks and the rest.
struct Submission {
    blocks: Vec<Block>,
    /// Everything outside of the blocks, including the marks.
    frame: String,
}

fn text(package: &str, file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(package).join(file);
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{package}/{file}: {error}"))
}

fn submission(package: &str) -> Submission {
    let text = text(package, "src/algorithms/render_pt.rs");
    let mut submission = Submission { blocks: Vec::new(), frame: String::new() };
    let mut open: Option<Block> = None;
    for line in text.split_inclusive('\n') {
        let mark = line.trim();
        if let Some(end) = mark.strip_prefix("// END ") {
            let block = open.take().unwrap_or_else(|| panic!("{package}: `{mark}` ends nothing"));
            assert_eq!(block.tasks, end, "{package}: a block has one name at both ends");
            submission.blocks.push(block);
        }
        match (&mut open, mark.strip_prefix("// TASK ")) {
            (Some(block), None) => block.lines.push(line.to_owned()),
            (None, None) => submission.frame.push_str(line),
            (None, Some(begin)) => {
                let (tasks, _) =
                    begin.split_once(':').unwrap_or_else(|| panic!("{package}: `{mark}` has no colon"));
                open = Some(Block { tasks: tasks.to_owned(), lines: Vec::new() });
                submission.frame.push_str(line);
            }
            (Some(block), Some(_)) => panic!("{package}: `{mark}` begins within {}", block.tasks),
        }
    }
    if let Some(block) = open {
        panic!("{package}: the block {} has no end", block.tasks);
    }
    submission
}

/// The text of a line, code or comment; `None` without any letter or digit.
fn content(line: &str) -> Option<&str> {
    let content = line.trim().trim_start_matches('/').trim();
    content.contains(|c: char| c.is_alphanumeric()).then_some(content)
}

#[test]
fn both_programs_have_the_same_main() {
    assert_eq!(text("skeleton", "src/main.rs"), text("solution", "src/main.rs"));
}

/// Students edit the file in `skeleton/`; the grader compares it with the assignment's copy.
#[test]
fn the_skeleton_has_the_starter_of_the_assignment() {
    let handed_out = text("assignments/05-nee-mis", "starter.rs");
    let message = "cp skeleton/src/algorithms/render_pt.rs assignments/05-nee-mis/starter.rs";
    assert!(text("skeleton", "src/algorithms/render_pt.rs") == handed_out, "they differ: {message}");
}

#[test]
fn starter_and_solution_differ_within_their_blocks_only() {
    let (starter, solution) = (submission("skeleton"), submission("solution"));
    assert_eq!(starter.frame, solution.frame);
    let tasks = |submission: &Submission| {
        submission.blocks.iter().map(|block| block.tasks.clone()).collect::<Vec<_>>()
    };
    assert_eq!(tasks(&starter), tasks(&solution));
    for task in ["5.1a", "5.1b", "5.2b"] {
        assert!(
            tasks(&starter).iter().any(|tasks| tasks.split(", ").any(|it| it == task)),
            "{task} has a block"
        );
    }
}

#[test]
fn every_block_of_the_solution_is_filled_in() {
    for block in submission("solution").blocks {
        let is_code = |line: &String| content(line).is_some() && !line.trim().starts_with("//");
        assert!(block.lines.iter().any(is_code), "the block {} has no code", block.tasks);
    }
}

#[test]
fn the_starter_has_nothing_of_the_solution() {
    let solution = submission("solution");
    let secrets: HashSet<&str> =
        solution.blocks.iter().flat_map(|block| &block.lines).filter_map(|line| content(line)).collect();
    let starter = submission("skeleton");
    for line in starter.blocks.iter().flat_map(|block| &block.lines) {
        let line = line.trim();
        if STARTER_CODE.contains(&line) {
            continue;
        }
        // This applies to comments, too.
        if let Some(content) = content(line) {
            assert!(!secrets.contains(content), "`{line}` is from the solution");
        }
        assert!(
            line.is_empty() || line.starts_with("//"),
            "`{line}` is code that the starter should not have"
        );
    }
}
