//! Why a job of a submission could not be finished.

use verdict::check::Fault;
use verdict::error::Error;

/// Why a job could not be finished, and so whose matter that is.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// The submission did not answer as it should: a finding about it.
    #[error("{0}")]
    Submission(Fault),
    /// Something else is wrong.
    #[error(transparent)]
    Harness(#[from] Error),
}

impl From<Fault> for JobError {
    fn from(fault: Fault) -> Self {
        Self::Submission(fault)
    }
}

impl JobError {
    /// The error of a program that is trusted, such as the solution: its faults are the harness's.
    pub fn of_trusted(self, program: &str) -> Error {
        match self {
            Self::Submission(fault) => Error::Harness(format!("{program}: {fault}")),
            Self::Harness(error) => error,
        }
    }
}

/// Takes faults of a submission apart from everything else, where they are looked at rather than passed on.
///
/// # Errors
/// What is not the submission's doing.
pub fn apart<T>(answer: Result<T, JobError>) -> Result<Result<T, Fault>, Error> {
    match answer {
        Ok(answer) => Ok(Ok(answer)),
        Err(JobError::Submission(fault)) => Ok(Err(fault)),
        Err(JobError::Harness(error)) => Err(error),
    }
}
