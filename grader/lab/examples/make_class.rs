//! Makes a class to measure with: correct, wrong and hostile submissions, each in a folder of its own.
//!
//! `cargo run --release -p lab --example make_class -- --out target/class --count 100`, then
//! `time cargo grader class target/class --out target/class-report`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use harness::assignment::AssignmentOption;
use harness::workspace::Workspace;
use lab::mutants::{Kind, variants};
use lab::output::{create_folder, write_text};
use verdict::error::Result;

/// Make a class of submissions from the committed variants of the solution
#[derive(Parser)]
struct Arguments {
    /// Folder of the class; it is created
    #[arg(long)]
    out: PathBuf,
    /// Number of submissions
    #[arg(long, default_value_t = 100)]
    count: usize,
    #[command(flatten)]
    assignment: AssignmentOption,
}

fn main() -> ExitCode {
    make(&Arguments::parse()).map_or_else(
        |error| {
            eprintln!("error: {error}");
            error.exit_code()
        },
        |()| ExitCode::SUCCESS,
    )
}

fn make(arguments: &Arguments) -> Result<()> {
    let workspace = Workspace::find()?;
    let assignment = arguments.assignment.open(&workspace)?;
    let all = variants(&assignment)?.list;
    let of_kind =
        |kind| all.iter().filter(move |variant| variant.kind == kind).map(|variant| variant.source.clone());
    let (right, wrong): (Vec<String>, Vec<String>) =
        (of_kind(Kind::Right).collect(), of_kind(Kind::Wrong).collect());
    let hostile = hostile();
    for index in 0..arguments.count {
        // Of ten, four are correct, four wrong, one is the starting file or does not compile, one is hostile.
        let turn = index / 10;
        let source = match index % 10 {
            0..=3 => right[(4 * turn + index % 10) % right.len()].clone(),
            4..=7 => wrong[(4 * turn + index % 10) % wrong.len()].clone(),
            8 if turn % 2 == 0 => assignment.folder.starter()?,
            8 => "fn main( {".to_owned(),
            _ => hostile[turn % hostile.len()].clone(),
        };
        let folder = arguments.out.join(format!("student{index:03}"));
        create_folder(&folder)?;
        let file = folder.join(assignment.rubric.submission.name());
        write_text(&file, &format!("// {index}\n{source}"))?;
    }
    println!("{}: {} submissions", arguments.out.display(), arguments.count);
    Ok(())
}

/// Submissions that hang, panic, end the process or overflow the stack.
fn hostile() -> Vec<String> {
    ["loop {}", "panic!()", "std::process::exit(0)", "std::process::abort()", "fn f(n: u64) -> u64 { if n == 0 { 0 } else { f(n + 1) + std::hint::black_box(n) } } Rgb::gray(f(1) as f32)"]
        .iter()
        .map(|what| {
            format!(
                "use arty::prelude::*;\npub struct PathTracer;\n\
                 impl PathTracer {{ pub fn new(_: Settings) -> Self {{ Self }} }}\n\
                 impl Integrator for PathTracer {{\n\
                 fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb {{ {what} }}\n}}\n"
            )
        })
        .collect()
}
