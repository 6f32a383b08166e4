// The fixed program around a submission: `render_pt.rs` is placed beside this file, and one call of rustc compiles both
// against the prebuilt framework.

#[forbid(unsafe_code)]
mod render_pt;

fn main() -> std::process::ExitCode {
    host::serve(|settings| Box::new(render_pt::PathTracer::new(settings)))
}
