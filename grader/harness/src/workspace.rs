//! Where things lie.

use std::path::{Path, PathBuf};

use verdict::error::{Error, Result};

/// The checkout of the project that the grader works in.
#[derive(Clone, Debug)]
pub struct Workspace {
    root: PathBuf,
}

impl Workspace {
    /// The checkout that this program was built from, or, if that is gone, the one that holds the current folder: it
    /// may be a student's.
    pub fn find() -> Result<Self> {
        let current =
            std::env::current_dir().map_err(|error| Error::Harness(format!("no current folder: {error}")))?;
        let built_from = Path::new(env!("CARGO_MANIFEST_DIR"));
        built_from
            .ancestors()
            .chain(current.ancestors())
            .find(|folder| folder.join("skeleton/Cargo.toml").is_file() && folder.join("scenes").is_dir())
            .map(|root| Self { root: root.to_owned() })
            .ok_or_else(|| {
                Error::Input(
                    "run the grader inside a checkout of arty (no skeleton/ and scenes/ found)".into(),
                )
            })
    }

    /// The folder of the checkout.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The file that students fill in.
    pub fn student_file(&self) -> PathBuf {
        self.root.join("skeleton/src/algorithms/render_pt.rs")
    }

    /// The same file, filled in.
    pub fn solution_file(&self) -> PathBuf {
        self.root.join("solution/src/algorithms/render_pt.rs")
    }

    /// The file of a scene.
    pub fn scene_file(&self, scene: &str) -> PathBuf {
        self.root.join("scenes").join(format!("{scene}.yml"))
    }

    /// The reference of a scene, for judging.
    pub fn reference_file(&self, scene: &str) -> PathBuf {
        self.root.join("references").join(format!("{scene}.exr"))
    }

    /// The reference of a scene, for looking at.
    pub fn picture_file(&self, scene: &str) -> PathBuf {
        self.root.join("references/pictures").join(format!("{scene}.exr"))
    }

    /// What each extreme scene must show.
    pub fn extreme_answers(&self) -> PathBuf {
        self.extreme_scene_file("answers")
    }

    /// The file of an extreme scene.
    pub fn extreme_scene_file(&self, scene: &str) -> PathBuf {
        self.root.join("scenes/extreme").join(format!("{scene}.yml"))
    }

    /// The folder of measurements of the renderer's numerical range.
    pub fn limits(&self) -> PathBuf {
        self.root.join("grader/lab/limits")
    }

    /// The folder of an assignment.
    pub fn assignment(&self, name: &str) -> PathBuf {
        self.root.join("assignments").join(name)
    }

    /// The folder of the solution's variants, whose mistakes are known.
    pub fn variants(&self) -> PathBuf {
        self.root.join("grader/variants")
    }

    /// The table of what became of them.
    pub fn kill_matrix(&self) -> PathBuf {
        self.variants().join("kill-matrix.md")
    }

    /// The table of how often correct hand-ins fail.
    pub fn calibration_table(&self) -> PathBuf {
        self.variants().join("calibration.md")
    }

    /// The plot that belongs to it.
    pub fn calibration_plot(&self) -> PathBuf {
        self.variants().join("calibration.svg")
    }

    /// Where Cargo puts the framework that hand-ins are linked against, apart from all other builds.
    pub fn framework_target(&self) -> PathBuf {
        self.root.join("target/framework")
    }
}
