
fn main() -> std::process::ExitCode {
    host::serve(host::Submission {
        path_tracer: |settings, _| Box::new(student_file::PathTracer::new(settings)),
        directions: None,
    })
}
