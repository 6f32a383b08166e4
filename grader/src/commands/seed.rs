//! The seed of a grade, public or secret.

use std::path::PathBuf;

use verdict::error::{Error, Result};

/// Seed of all random numbers.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct Seed {
    /// Seed of all random numbers: the same seed gives the same verdicts
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Take the seed from the text of this file, which only staff can read: students cannot prepare for its scenes and
    /// random numbers. The tutor's report names the seed, so that the grade can be repeated with --seed; the student's does not
    #[arg(long, value_name = "FILE", conflicts_with = "seed")]
    secret_seed: Option<PathBuf>,
}

/// Minimum number of characters of a secret: fewer could be found by trying.
const MIN_CHARACTERS: usize = 16;

impl Seed {
    /// True if only staff may know the seed.
    pub(super) fn is_secret(&self) -> bool {
        self.secret_seed.is_some()
    }

    /// The seed: the one of the command line, or the hash of the secret text without spaces around it.
    ///
    /// # Errors
    /// If the file cannot be read, or its text is too short to be a secret.
    pub(super) fn value(&self) -> Result<u64> {
        let Some(file) = &self.secret_seed else { return Ok(self.seed) };
        let text = std::fs::read_to_string(file).map_err(|error| Error::file(file, error))?;
        let secret = text.trim();
        if secret.chars().count() < MIN_CHARACTERS {
            let why = format!(
                "a secret needs at least {MIN_CHARACTERS} characters, such as a line of `openssl rand -hex 16`"
            );
            return Err(Error::file(file, why));
        }
        let mut first = [0; 8];
        first.copy_from_slice(&blake3::hash(secret.as_bytes()).as_bytes()[..8]);
        Ok(u64::from_le_bytes(first))
    }
}
