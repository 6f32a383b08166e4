//! The program `cargo arty import`.

use std::io::Write;
use std::process::ExitCode;

use arty_import::args::{Args, run};
use clap::Parser;

fn main() -> ExitCode {
    let (lines, code) = match run(&Args::parse()) {
        Ok(lines) => (lines, ExitCode::SUCCESS),
        Err(error) => (vec![format!("error: {error}")], ExitCode::from(2)),
    };
    // `eprintln` panics if the reader has closed the pipe.
    let _ = writeln!(std::io::stderr(), "{}", lines.join("\n"));
    code
}
