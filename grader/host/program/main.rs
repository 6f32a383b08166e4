// The fixed program around a submission: `render_pt.rs` is put beside this file, and both are compiled by one call of
// rustc against the prebuilt framework.

#[forbid(unsafe_code)]
mod render_pt;

fn main() -> std::process::ExitCode {
    host::serve(|settings| Box::new(render_pt::PathTracer::new(settings)))
}
