
fn main() -> std::process::ExitCode {
    host::serve(host::Submission {
        path_tracer: |settings, scene| Box::new(student_file::PathTracer::new(settings, scene)),
        directions: Some(|environment| Box::new(student_file::EnvironmentSampler::new(environment))),
    })
}
