//! The oracle: the solution as a source of expectations for scenes without a reference, with a cache.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use arty::integrator::Settings;
use arty::scene::SceneDescription;

use super::make::live;
use crate::statistics::expected::Expected;
use harness::assignment::Assignment;
use harness::build::{Framework, SubmissionProgram, compile};
use harness::host_process::HostProcess;
use harness::sandbox::Limits;
use harness::workspace::Workspace;
use verdict::error::{Error, Result};
use verdict::output;
use verdict::submission::Submission;

/// The solution of an assignment, compiled on first use.
///
/// The compiled program and all expectations are cached in Cargo's target folder of the framework, under the hash of
/// everything they depend on.
#[derive(Debug)]
pub struct Oracle {
    submission: Submission,
    framework: Framework,
    /// Cache key: hash of the framework, the solution's source, the way it is compiled, and the code that renders with
    /// it.
    hash: blake3::Hash,
    folder: PathBuf,
    program: Mutex<Option<Arc<SubmissionProgram>>>,
}

impl Oracle {
    /// The solution of an assignment; `None` if the checkout does not have it.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn of(workspace: &Workspace, assignment: &Assignment, framework: &Framework) -> Result<Option<Self>> {
        let path = assignment.solution_file();
        if !path.is_file() {
            return Ok(None);
        }
        let mut hasher = blake3::Hasher::new();
        hasher.update(framework.hash.as_bytes());
        hasher.update(include_bytes!("make.rs"));
        hasher.update(framework.recipe().as_bytes());
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

    /// The program of the solution, for commands that need it.
    ///
    /// # Errors
    /// If the checkout does not have it, or it does not compile.
    pub fn required(workspace: &Workspace, assignment: &Assignment) -> Result<Arc<SubmissionProgram>> {
        Self::of(workspace, assignment, &assignment.framework(workspace)?)?
            .ok_or_else(|| {
                Error::file(&assignment.solution_file(), "this checkout does not have the solution")
            })?
            .program()
    }

    /// Hash of everything that the program and the expectations depend on.
    pub fn hash(&self) -> blake3::Hash {
        self.hash
    }

    /// The program of the solution, from the cache or compiled like any submission.
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
        // The cache may come from a machine with another C library, on which the program does not start.
        let compiled = match earlier
            .filter(|program| HostProcess::start(program, 1).is_ok_and(|process| process.fault().is_none()))
        {
            Some(program) => program,
            None => {
                let Submission { path, source } = &self.submission;
                let compiled = compile(&self.framework, source, &limits)?.map_err(|failure| {
                    Error::file(path, format!("does not compile:\n{}", failure.messages))
                })?;
                // If the cache cannot be written, the program is compiled again next time.
                let _ = self.keep(&file, &compiled);
                compiled
            }
        };
        Ok(Arc::clone(program.insert(Arc::new(compiled))))
    }

    /// Expected mean and noise in a scene, from `samples` samples per pixel.
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
        // If the cache cannot be written, it is rendered again next time.
        let _ = self.write(&file, &bytes);
        Ok(answer)
    }

    /// Caches the program and removes earlier ones.
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

    /// Writes a cache entry for [`read`].
    fn write(&self, file: &Path, bytes: &[u8]) -> Result<()> {
        output::create_folder(&self.folder)?;
        output::write_bytes(file, [blake3::hash(bytes).as_bytes(), bytes].concat())
    }
}

/// Reads a cache entry; `None` if it does not exist or is damaged.
fn read(file: &Path) -> Option<Vec<u8>> {
    let mut bytes = std::fs::read(file).ok()?;
    let (hash, rest) = bytes.split_at_checked(blake3::OUT_LEN)?;
    let is_whole = blake3::hash(rest).as_bytes() == hash;
    is_whole.then(|| bytes.split_off(blake3::OUT_LEN))
}
