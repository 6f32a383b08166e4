//! The programs that are measured, and their names.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::commands::intake::{reader, wanted};
use harness::assignment::Assignment;
use harness::build::{SubmissionProgram, compile};
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use judge::convergence::MeasuredProgram;
use judge::reference::Oracle;
use verdict::convergence::{NotMeasured, Role};
use verdict::error::Result;

/// Names of the programs that are always measured.
const SOLUTION: &str = "solution";
const BASELINE: &str = "BSDF sampling";

/// The programs that are measured.
pub(super) struct Programs {
    /// Submissions that compile, with their names.
    submissions: Vec<(String, SubmissionProgram)>,
    /// Programs that they are compared with, likewise.
    rivals: Vec<(String, SubmissionProgram)>,
    /// `None` if the checkout does not have it.
    solution: Option<Arc<SubmissionProgram>>,
    /// Programs that cannot be measured.
    pub(super) left_out: Vec<NotMeasured>,
}

impl Programs {
    /// Compiles submissions, without any the student file, their rivals, and the solution.
    pub(super) fn build(
        paths: &[PathBuf],
        rivals: &[&PathBuf],
        workspace: &Workspace,
        assignment: &Assignment,
    ) -> Result<Self> {
        let mut paths = if paths.is_empty() { vec![assignment.student_file()] } else { paths.to_vec() };
        let count = paths.len();
        paths.extend(rivals.iter().copied().cloned());
        let wanted = wanted(assignment)?;
        let sources = paths.iter().map(|path| reader().read(path, &wanted)).collect::<Result<Vec<_>>>()?;
        let framework = assignment.framework(workspace)?;
        let mut left_out = Vec::new();
        let (mut submissions, mut rivals) = (Vec::new(), Vec::new());
        for (index, (submission, name)) in sources.iter().zip(names(&paths, &wanted.file_name)).enumerate() {
            let list = if index < count { &mut submissions } else { &mut rivals };
            match compile(&framework, &submission.source, &Limits::default())? {
                Ok(program) => list.push((name, program)),
                Err(_) => left_out.push(everywhere(name, "it does not compile")),
            }
        }
        let solution =
            Oracle::of(workspace, assignment, &framework)?.map(|oracle| oracle.program()).transpose()?;
        if solution.is_none() {
            left_out.push(everywhere("the solution".to_owned(), "this checkout does not have it"));
        }
        Ok(Self { submissions, rivals, solution, left_out })
    }

    /// All programs in the order of the curves. BSDF sampling is that of the solution, or else of the first submission.
    pub(super) fn measured(&self) -> Vec<MeasuredProgram<'_>> {
        let named = |name: &str, role, program| MeasuredProgram { name: name.to_owned(), role, program };
        let submissions = self.submissions.iter();
        let mut all: Vec<MeasuredProgram<'_>> =
            submissions.map(|(name, program)| named(name, Role::Submission, program)).collect();
        let rivals = self.rivals.iter();
        all.extend(rivals.map(|(name, program)| named(name, Role::Rival, program)));
        let solution = self.solution.as_deref();
        all.extend(solution.map(|program| named(SOLUTION, Role::Solution, program)));
        let baseline = solution.or(self.submissions.first().map(|(_, program)| program));
        all.extend(baseline.map(|program| named(BASELINE, Role::Baseline, program)));
        all
    }
}

fn everywhere(program: String, why: &str) -> NotMeasured {
    NotMeasured { program, scene: String::new(), why: why.to_owned() }
}

/// Names of submissions: the file, or the folder of a file with the usual name. The whole path where several would have
/// the same name.
fn names(paths: &[PathBuf], usual: &str) -> Vec<String> {
    let all: Vec<String> = paths.iter().map(|path| short_name(path, usual)).collect();
    let is_unique = |name: &String| {
        // The solution and its BSDF sampling are measured beside them.
        all.iter().filter(|other| *other == name).count() == 1 && name != SOLUTION && name != BASELINE
    };
    let name = |(path, name): (&PathBuf, &String)| {
        if is_unique(name) { name.clone() } else { path.display().to_string() }
    };
    paths.iter().zip(&all).map(name).collect()
}

/// Folders within a crate, which say nothing about whose file it is.
const INNER_FOLDERS: [&str; 2] = ["src", "algorithms"];

fn short_name(path: &Path, usual: &str) -> String {
    let is_named = path.file_name().is_some_and(|name| name != usual);
    let name = if path.is_dir() {
        path.file_name()
    } else if is_named {
        path.file_stem()
    } else {
        let folders = path.ancestors().skip(1).filter_map(Path::file_name);
        folders.into_iter().find(|name| !INNER_FOLDERS.iter().any(|inner| name == inner))
    };
    name.map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn submissions_of_the_same_name_are_told_apart_by_their_paths() {
        let paths = ["a/render_pt.rs", "b.rs", "x/c.rs", "y/c.rs"].map(PathBuf::from);
        assert_eq!(names(&paths, "render_pt.rs"), ["a", "b", "x/c.rs", "y/c.rs"]);
    }

    #[test]
    fn a_file_is_named_after_the_folder_that_tells_whose_it_is() {
        let paths =
            ["class/ada/src/algorithms/render_pt.rs", "solution/src/algorithms/render_pt.rs", "render_pt.rs"];
        assert_eq!(names(&paths.map(PathBuf::from), "render_pt.rs"), ["ada", paths[1], "render_pt.rs"]);
    }
}
