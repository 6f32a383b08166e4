//! The command line of the laboratory: `cargo lab`.

fn main() -> std::process::ExitCode {
    lab::commands::run()
}
