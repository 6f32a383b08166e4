//! The fixed program around a submission.

use verdict::rubric::{Contract, StudentFile};

/// Source text at the beginning of every program: macros that keep prints out of the protocol.
const PRELUDE: &str = include_str!("../../../host/program/prelude.rs");

/// The fixed program around the submissions of an assignment.
#[derive(Clone, Debug)]
pub struct Program {
    /// Name of the student's file.
    pub file_name: String,
    /// Text of the program. The student's file is a module of it.
    pub text: String,
    /// A submission that compiles on every machine that can compile one.
    pub empty_submission: &'static str,
}

/// In the programs of contracts, the name of the student's module.
const MODULE: &str = "student_file";

impl Program {
    /// The program around a student's file.
    pub fn around(file: &StudentFile) -> Self {
        let (main, empty_submission) = match file.contract {
            Contract::PathTracer => (
                include_str!("../../../host/program/path_tracer.rs"),
                include_str!("../../../host/program/path_tracer_empty.rs"),
            ),
            Contract::EnvironmentSampler => (
                include_str!("../../../host/program/environment_sampler.rs"),
                include_str!("../../../host/program/environment_sampler_empty.rs"),
            ),
        };
        let module = file.module();
        let main = main.replace(MODULE, module);
        Self {
            file_name: file.name().to_owned(),
            text: format!("{PRELUDE}\n#[forbid(unsafe_code)]\nmod {module};\n{main}"),
            empty_submission,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_students_file_is_a_module_of_the_program_under_its_own_name() {
        let path = "skeleton/src/sky.rs".to_owned();
        let program = Program::around(&StudentFile { path, contract: Contract::PathTracer, solution: None });
        assert_eq!(program.file_name, "sky.rs");
        assert!(program.text.contains("#[forbid(unsafe_code)]\nmod sky;\n"), "{}", program.text);
        assert!(
            program.text.contains("sky::PathTracer::new") && !program.text.contains(MODULE),
            "{}",
            program.text
        );
    }
}
