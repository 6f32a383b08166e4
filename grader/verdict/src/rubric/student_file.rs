//! What students hand in: one source file, and what it has to define.

use serde::{Deserialize, Serialize};

/// The student's file: the section `submission` of a rubric.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudentFile {
    /// Path in a handout, below its top folder and with `/`. Its last part is the name of the file that is handed in.
    #[serde(rename = "file")]
    pub path: String,
    /// What the file has to define.
    pub contract: Contract,
    /// Path of the solution below the checkout; `None` if it is the `solution.rs` beside the rubric.
    #[serde(default)]
    pub solution: Option<String>,
}

/// What the student's file has to define, and which fixed program is linked around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Contract {
    /// `PathTracer`, an `Integrator` with `new(Settings)`.
    PathTracer,
    /// `EnvironmentSampler`, a `SampleDirections` with `new(&Environment)`, and `PathTracer`, an `Integrator` with
    /// `new(Settings, &Scene)`.
    EnvironmentSampler,
}

impl Contract {
    /// Name of the type by which a source is recognised.
    pub fn type_name(self) -> &'static str {
        match self {
            Self::PathTracer => "PathTracer",
            Self::EnvironmentSampler => "EnvironmentSampler",
        }
    }
}

impl StudentFile {
    /// Name of the file that is handed in.
    pub fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or(&self.path)
    }

    /// Name of the module that the file is: its name without `.rs`.
    pub fn module(&self) -> &str {
        self.name().trim_end_matches(".rs")
    }

    /// Checks the paths.
    ///
    /// # Errors
    /// The first wrong value.
    pub(super) fn validate(&self) -> Result<(), String> {
        for (key, path) in [("file", Some(&self.path)), ("solution", self.solution.as_ref())] {
            let leads_out = |path: &String| {
                path.contains('\\') || path.split('/').any(|part| matches!(part, "" | "." | ".."))
            };
            if path.is_some_and(leads_out) {
                return Err(format!("submission: `{key}` must be a path below the checkout, with `/`"));
            }
        }
        let module = self.name().strip_suffix(".rs").unwrap_or_default();
        let begins = module.starts_with(|first: char| first.is_ascii_lowercase());
        let is_word = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
        // Names of crates and of the program around it would hide the module, or be hidden by it.
        if !(begins && module.chars().all(is_word)) || TAKEN.contains(&module) {
            return Err(format!(
                "submission: `{}` cannot be the name of a module; use lower-case letters, digits and `_`, and none of {}",
                self.name(),
                TAKEN.join(", ")
            ));
        }
        Ok(())
    }
}

/// Names that a student's module cannot have.
const TAKEN: [&str; 8] = ["alloc", "arty", "core", "crate", "host", "main", "mod", "std"];

#[cfg(test)]
mod tests {
    use super::*;

    fn at(path: &str) -> StudentFile {
        StudentFile { path: path.to_owned(), contract: Contract::PathTracer, solution: None }
    }

    #[test]
    fn the_name_of_the_file_is_that_of_a_module() {
        let file = at("a/b/sky_2.rs");
        assert_eq!((file.name(), file.module(), file.validate()), ("sky_2.rs", "sky_2", Ok(())));
        for (path, why) in [
            ("a/main.rs", "cannot be the name"),
            ("a/2.rs", "cannot be the name"),
            ("a/x", "cannot be the name"),
            ("a/X.rs", "cannot be the name"),
            ("a/.rs", "cannot be the name"),
            ("../x.rs", "below the checkout"),
            ("/x.rs", "below the checkout"),
            ("a\\x.rs", "below the checkout"),
        ] {
            let message = at(path).validate().expect_err(path);
            assert!(message.contains(why), "{path}: {message}");
        }
        let solution = Some("/etc/passwd".to_owned());
        assert!(StudentFile { solution, ..at("x.rs") }.validate().is_err());
    }
}
