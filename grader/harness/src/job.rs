//! Errors of jobs: faults of the submission apart from failures of the harness.

use verdict::check::Fault;
use verdict::error::Error;

/// Why a job could not be finished, and who can fix it.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// The submission gave no valid answer: a finding for its report.
    #[error("{0}")]
    Submission(Fault),
    /// The harness or the machine failed.
    #[error(transparent)]
    Harness(#[from] Error),
}

impl From<Fault> for JobError {
    fn from(fault: Fault) -> Self {
        Self::Submission(fault)
    }
}

impl JobError {
    /// The error for a trusted program, such as the solution, whose faults count as failures of the harness.
    pub fn of_trusted(self, program: &str) -> Error {
        match self {
            Self::Submission(fault) => Error::Harness(format!("{program}: {fault}")),
            Self::Harness(error) => error,
        }
    }
}

/// Separates faults of a submission, as the inner error, from failures of the harness.
///
/// # Errors
/// Failures of the harness.
pub fn apart<T>(answer: Result<T, JobError>) -> Result<Result<T, Fault>, Error> {
    match answer {
        Ok(answer) => Ok(Ok(answer)),
        Err(JobError::Submission(fault)) => Ok(Err(fault)),
        Err(JobError::Harness(error)) => Err(error),
    }
}
