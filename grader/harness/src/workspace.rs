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
    /// If there is neither.
    pub fn find() -> Result<Self> {
        let current =
            std::env::current_dir().map_err(|error| Error::Harness(format!("no current folder: {error}")))?;
        Self::first([current.as_path(), Path::new(env!("CARGO_MANIFEST_DIR"))]).ok_or_else(|| {
            Error::Input(
                "the current folder is not in a checkout of arty (no skeleton/ and scenes/): name one with \
                 --workspace=DIR"
                    .into(),
            )
        })
    }

    /// The checkout that a folder is in.
    ///
    /// # Errors
    /// If it is in none.
    pub fn open(folder: &Path) -> Result<Self> {
        let full = folder.canonicalize().map_err(|error| Error::file(folder, error))?;
        Self::first([full.as_path()])
            .ok_or_else(|| Error::file(folder, "this is not a checkout of arty (no skeleton/ and scenes/)"))
    }

    /// The first of these folders, each followed by its parents, that is a checkout.
    fn first<'a>(folders: impl IntoIterator<Item = &'a Path>) -> Option<Self> {
        let is_checkout =
            |folder: &&Path| folder.join("skeleton/Cargo.toml").is_file() && folder.join("scenes").is_dir();
        let root = folders.into_iter().flat_map(Path::ancestors).find(is_checkout)?;
        Some(Self { root: root.to_owned() })
    }

    /// Top folder of the checkout.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The student's file in the skeleton.
    pub fn student_file(&self) -> PathBuf {
        self.root.join("skeleton/src/algorithms/render_pt.rs")
    }

    /// The solution's version of the student's file. Handouts do not contain it.
    pub fn solution_file(&self) -> PathBuf {
        self.root.join("solution/src/algorithms/render_pt.rs")
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

    /// Folder of an assignment. An absolute `name` is used as it is.
    pub fn assignment(&self, name: &str) -> AssignmentFolder {
        AssignmentFolder::new(self.root.join("assignments").join(name))
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
    fn the_checkout_of_the_current_folder_comes_before_the_one_that_the_program_was_built_from() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let [here, built_from] = ["here", "built-from"].map(|name| checkout(&folder.path().join(name)));
        let root = |current: &Path| {
            let found = Workspace::first([current, &built_from.join("scenes")]);
            found.expect("one of them is a checkout").root
        };
        assert_eq!(root(&here.join("scenes/extreme")), here);
        assert_eq!(root(folder.path()), built_from);
        assert!(Workspace::first([folder.path()]).is_none());
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
