//! The checkout that a command works in, and the paths of its files.

use std::path::{Path, PathBuf};

use verdict::error::{Error, Result};

use crate::assignment_folder::AssignmentFolder;

/// A checkout of the project.
#[derive(Clone, Debug)]
pub struct Workspace {
    root: PathBuf,
}

impl Workspace {
    /// The checkout that the current folder is in, or, outside of any, the one that this program was built from.
    ///
    /// # Errors
    /// If there is neither, or if they are two: a tutor who stands in a student's checkout must not grade by its rubric,
    /// nor build its framework.
    pub fn find() -> Result<Self> {
        let current =
            std::env::current_dir().map_err(|error| Error::Harness(format!("no current folder: {error}")))?;
        Self::only(&current, Path::new(env!("CARGO_MANIFEST_DIR")))
    }

    /// The only checkout that one of these folders is in.
    fn only(current: &Path, built_from: &Path) -> Result<Self> {
        let full = |root: &Path| root.canonicalize().unwrap_or_else(|_| root.to_owned());
        match (Self::around(current), Self::around(built_from)) {
            (None, None) => Err(Error::Input(
                "the current folder is not in a checkout of arty (no skeleton/ and scenes/): name one with \
                 --workspace=DIR"
                    .into(),
            )),
            (Some(here), Some(other)) if full(&here.root) != full(&other.root) => {
                let [here, other] = [here.root.display(), other.root.display()];
                Err(Error::Input(format!(
                    "the current folder is in the checkout {here}, but this program was built from {other}: say whose \
                     rubric and framework count, with --workspace={here} or --workspace={other}"
                )))
            }
            (Some(one), _) | (None, Some(one)) => Ok(one),
        }
    }

    /// The checkout that a folder is in.
    ///
    /// # Errors
    /// If it is in none.
    pub fn open(folder: &Path) -> Result<Self> {
        let full = folder.canonicalize().map_err(|error| Error::file(folder, error))?;
        Self::around(&full)
            .ok_or_else(|| Error::file(folder, "this is not a checkout of arty (no skeleton/ and scenes/)"))
    }

    /// The checkout that a folder is in: the folder itself, or the nearest of its parents that is one.
    fn around(folder: &Path) -> Option<Self> {
        let is_checkout =
            |folder: &&Path| folder.join("skeleton/Cargo.toml").is_file() && folder.join("scenes").is_dir();
        Some(Self { root: folder.ancestors().find(is_checkout)?.to_owned() })
    }

    /// Top folder of the checkout.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// File of a scene, `scenes/<scene>.yml`.
    pub fn scene_file(&self, scene: &str) -> PathBuf {
        self.root.join("scenes").join(format!("{scene}.yml"))
    }

    /// Reference of a scene that checks compare with, `references/<scene>.exr`.
    pub fn reference_file(&self, scene: &str) -> PathBuf {
        self.root.join("references").join(format!("{scene}.exr"))
    }

    /// Picture of a scene for people, `references/pictures/<scene>.exr`.
    pub fn picture_file(&self, scene: &str) -> PathBuf {
        self.root.join("references/pictures").join(format!("{scene}.exr"))
    }

    /// Expected results of the extreme scenes.
    pub fn extreme_answers(&self) -> PathBuf {
        self.extreme_scene_file("answers")
    }

    /// File of an extreme scene, `scenes/extreme/<scene>.yml`.
    pub fn extreme_scene_file(&self, scene: &str) -> PathBuf {
        self.root.join("scenes/extreme").join(format!("{scene}.yml"))
    }

    /// The folder of measurements of the renderer's numerical range.
    pub fn limits(&self) -> PathBuf {
        self.root.join("grader/lab/limits")
    }

    /// Folder of all assignments.
    pub fn assignments_folder(&self) -> PathBuf {
        self.root.join("assignments")
    }

    /// Names of all assignments, sorted: the folders with a rubric.
    ///
    /// # Errors
    /// If the folder of all assignments cannot be read.
    pub fn assignments(&self) -> Result<Vec<String>> {
        let folder = self.assignments_folder();
        let trouble = |error| Error::file(&folder, error);
        let mut names = Vec::new();
        for entry in std::fs::read_dir(&folder).map_err(trouble)? {
            let entry = entry.map_err(trouble)?;
            if AssignmentFolder::new(entry.path()).rubric_file().is_file() {
                names.push(entry.file_name().to_string_lossy().into_owned());
            }
        }
        names.sort();
        Ok(names)
    }

    /// True if this is a checkout of staff: handouts do not contain the solution's program.
    pub fn is_staff(&self) -> bool {
        self.root.join("solution/Cargo.toml").is_file()
    }

    /// Folder of an assignment. An absolute `name` is used as it is.
    pub fn assignment(&self, name: &str) -> AssignmentFolder {
        AssignmentFolder::new(self.assignments_folder().join(name))
    }

    /// Cargo's target folder for the framework that submissions are linked against.
    pub fn framework_target(&self) -> PathBuf {
        self.root.join("target/framework")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that passes for a checkout.
    fn checkout(folder: &Path) -> PathBuf {
        std::fs::create_dir_all(folder.join("scenes/extreme")).expect("it can be made");
        std::fs::create_dir_all(folder.join("skeleton")).expect("it can be made");
        std::fs::write(folder.join("skeleton/Cargo.toml"), "").expect("it can be written");
        folder.to_owned()
    }

    #[test]
    fn one_checkout_is_found_from_inside_or_by_the_program_and_of_two_none_is_guessed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let [here, built_from] = ["here", "built-from"].map(|name| checkout(&folder.path().join(name)));
        let root = |current: &Path, program: &Path| Workspace::only(current, program).map(|found| found.root);
        let inside = here.join("scenes/extreme");
        assert_eq!(root(&inside, &here).expect("it is the same"), here);
        assert_eq!(root(&inside, folder.path()).expect("there is one"), here);
        assert_eq!(root(folder.path(), &built_from.join("scenes")).expect("there is one"), built_from);
        assert!(root(folder.path(), folder.path()).is_err(), "there is none");
        let message = root(&inside, &built_from).expect_err("there are two").to_string();
        for expected in
            [format!("--workspace={}", here.display()), format!("--workspace={}", built_from.display())]
        {
            assert!(message.contains(&expected), "{message}");
        }
    }

    #[test]
    fn a_checkout_can_be_named_and_nothing_else_takes_its_place() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let named = checkout(&folder.path().join("named"));
        let found = Workspace::open(&named.join("scenes")).expect("it is in a checkout");
        assert_eq!(found.root(), named.canonicalize().expect("it is there"));
        assert!(matches!(Workspace::open(folder.path()), Err(Error::Input(_))));
        assert!(matches!(Workspace::open(&folder.path().join("gone")), Err(Error::Input(_))));
    }
}
