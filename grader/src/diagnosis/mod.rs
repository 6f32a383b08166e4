//! Likely causes.
use std::path::Path;

use crate::error::Result;
use crate::report::{Diagnosis, Report};

pub struct Catalogue;
impl Catalogue {
    pub fn load(_folder: &Path) -> Result<Self> {
        Ok(Self)
    }
    pub fn diagnose(&self, _report: &Report, _source: &str) -> Vec<Diagnosis> {
        Vec::new()
    }
}
