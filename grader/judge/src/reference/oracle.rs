//! The solution, asked about scenes that have no reference. What it said once is not rendered again.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use arty::integrator::Settings;
use arty::scene::SceneDescription;

use super::make::live;
use crate::statistics::bias::Expected;
use harness::build::{Framework, SubmissionProgram, compile, recipe};
use harness::host_process::HostProcess;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::submission::Submission;

/// The solution of this checkout. It is compiled only once it is needed, and not again while it is the same.
///
/// Program and answers are kept where Cargo builds the framework, under the hash of all that they depend on.
#[derive(Debug)]
pub struct Oracle {
    submission: Submission,
    framework: Framework,
    /// Over the framework, the solution's source, how it is compiled, and how its samples become an answer.
    hash: blake3::Hash,
    folder: PathBuf,
    program: Mutex<Option<Arc<SubmissionProgram>>>,
}

impl Oracle {
    /// The solution of a checkout; `None` if it does not have it.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn of(workspace: &Workspace, framework: &Framework) -> Result<Option<Self>> {
        let path = workspace.solution_file();
        if !path.is_file() {
            return Ok(None);
        }
        let mut hasher = blake3::Hasher::new();
        hasher.update(framework.hash.as_bytes());
        hasher.update(include_bytes!("make.rs"));
        hasher.update(recipe().as_bytes());
        let submission = Submission::load_trusted(&path)?;
        hasher.update(submission.source.as_bytes());
        Ok(Some(Self {
            submission,
            framework: framework.clone(),
            hash: hasher.finalize(),
            folder: workspace.framework_target().join("answers"),
            program: Mutex::default(),
        }))
    }

    /// The solution as a program, for commands that are nothing without it.
    ///
    /// # Errors
    /// If the checkout does not have it, or it does not compile.
    pub fn required(workspace: &Workspace) -> Result<Arc<SubmissionProgram>> {
        Self::of(workspace, &Framework::build(workspace)?)?
            .ok_or_else(|| {
                Error::file(&workspace.solution_file(), "this checkout does not have the solution")
            })?
            .program()
    }

    /// Over all that programs and answers depend on.
    pub fn hash(&self) -> blake3::Hash {
        self.hash
    }

    /// The solution as a program, built like any submission, now or earlier.
    ///
    /// # Errors
    /// If it does not compile.
    pub fn program(&self) -> Result<Arc<SubmissionProgram>> {
        let mut program = self.program.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(program) = &*program {
            return Ok(Arc::clone(program));
        }
        let (limits, file) = (Limits::default(), self.folder.join(format!("{}.program", self.hash)));
        let earlier = read(&file).and_then(|executable| SubmissionProgram::again(&executable, &limits).ok());
        // It may have come here with a cache, from a machine with another C library.
        let compiled = match earlier
            .filter(|program| HostProcess::start(program, 1).is_ok_and(|process| process.fault().is_none()))
        {
            Some(program) => program,
            None => {
                let Submission { path, source } = &self.submission;
                let compiled = compile(&self.framework, source, &limits)?.map_err(|failure| {
                    Error::file(path, format!("does not compile:\n{}", failure.messages))
                })?;
                // Whoever cannot keep it compiles it again.
                let _ = self.keep(&file, &compiled);
                compiled
            }
        };
        Ok(Arc::clone(program.insert(Arc::new(compiled))))
    }

    /// What a correct estimator gives in a scene, with `samples` samples of each pixel.
    ///
    /// # Errors
    /// If the solution fails.
    pub fn expected(
        &self,
        scene: &SceneDescription,
        settings: Settings,
        samples: u32,
        seed: u64,
        threads: usize,
    ) -> Result<Expected> {
        let question = format!("{} {} {settings:?} {samples} {seed}", self.hash, scene.hash());
        let file = self.folder.join(blake3::hash(question.as_bytes()).to_hex().as_str());
        if let Some(answer) = read(&file).and_then(|bytes| postcard::from_bytes(&bytes).ok()) {
            return Ok(answer);
        }
        let answer = live(&*self.program()?, scene, settings, samples, seed, threads)?;
        let bytes = postcard::to_stdvec(&answer).map_err(|error| Error::file(&file, error))?;
        // Whoever cannot keep it asks again.
        let _ = self.write(&file, &bytes);
        Ok(answer)
    }

    /// Keeps the program, in place of earlier ones.
    fn keep(&self, file: &Path, program: &SubmissionProgram) -> Result<()> {
        let trouble = |error| Error::output(&self.folder, error);
        let executable =
            std::fs::read(&program.executable).map_err(|error| Error::file(&program.executable, error))?;
        for entry in std::fs::read_dir(&self.folder).into_iter().flatten() {
            let path = entry.map_err(trouble)?.path();
            if path.extension() == file.extension() {
                std::fs::remove_file(path).map_err(trouble)?;
            }
        }
        self.write(file, &executable)
    }

    /// Writes something down for [`read`].
    fn write(&self, file: &Path, bytes: &[u8]) -> Result<()> {
        output::create_folder(&self.folder)?;
        output::write_bytes(file, [blake3::hash(bytes).as_bytes(), bytes].concat())
    }
}

/// What was written down; `None` if it is not there, or not whole.
fn read(file: &Path) -> Option<Vec<u8>> {
    let mut bytes = std::fs::read(file).ok()?;
    let (hash, rest) = bytes.split_at_checked(blake3::OUT_LEN)?;
    let is_whole = blake3::hash(rest).as_bytes() == hash;
    is_whole.then(|| bytes.split_off(blake3::OUT_LEN))
}
