
fn main() -> std::process::ExitCode {
    host::serve(|settings| Box::new(student_file::PathTracer::new(settings)))
}
