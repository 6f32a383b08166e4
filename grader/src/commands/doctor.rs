//! `grader doctor`.

use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;

use super::intake::{reader, wanted};
use harness::assignment::{Assignment, AssignmentOption};
use harness::build::{Framework, compile};
use harness::host_process::HostProcess;
use harness::sandbox::{Layers, Level, Limits, Machine, linker};
use harness::workspace::Workspace;
use present::streams::print_line;
use present::words::missing_layers;
use verdict::error::Result;
use verdict::report::Sandbox;

/// Check whether this machine can grade: compiler, linker and sandbox, and how to strengthen the sandbox
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    assignment: AssignmentOption,
}

/// Compiles and starts the student file of the assignment as a grade would, and prints what was found.
pub(super) fn run(arguments: &Arguments, workspace: &Workspace) -> Result<ExitCode> {
    let limits = Limits::default();
    print_machine(workspace)?;
    let assignment = arguments.assignment.open(workspace)?;
    let framework = assignment.framework(workspace)?;
    print_build(&framework, &limits)?;
    let possible = Machine::here().layers();
    let (compiler, host) = try_starter(&assignment, &framework, &limits)?.unwrap_or((possible, possible));
    print_sandbox(possible, compiler, host)?;
    Ok(ExitCode::SUCCESS)
}

fn print_machine(workspace: &Workspace) -> Result<()> {
    row("system", format_args!("{} on {}", std::env::consts::OS, std::env::consts::ARCH))?;
    row("cores", rayon::current_num_threads())?;
    row("checkout", free_space(workspace.root()))?;
    row("temporary files", free_space(&std::env::temp_dir()))?;
    let linker =
        linker().map_or("`cc` is not in the search path".to_owned(), |path| path.display().to_string());
    row("linker", linker)
}

fn print_build(framework: &Framework, limits: &Limits) -> Result<()> {
    row("framework", framework.dependencies.display())?;
    row("compiler", format_args!("{} ({})", framework.toolchain, framework.rustc.display()))?;
    let [compile, job] = [limits.compile_time, limits.job_time].map(|time| time.as_secs());
    row("time limits", format_args!("{compile} s to compile, {job} s per job"))?;
    let [compile, job] = [limits.compile_memory, limits.job_memory].map(|bytes| bytes >> 20);
    row("memory limits", format_args!("{compile} MiB to compile, {job} MiB per job"))
}

/// Sandbox layers of the compiler and of the student file's process; `None` if the file does not compile.
fn try_starter(
    assignment: &Assignment,
    framework: &Framework,
    limits: &Limits,
) -> Result<Option<(Layers, Layers)>> {
    let starter = reader().read(&assignment.student_file(), &wanted(assignment)?)?;
    match compile(framework, &starter.source, limits)? {
        Ok(program) => {
            let process = HostProcess::start(&program, 1)?;
            if let Some(fault) = process.fault() {
                row("student file", format_args!("does not start: {fault}"))?;
            }
            Ok(Some((program.layers, process.layers())))
        }
        Err(failure) => {
            let first = failure.messages.lines().next().unwrap_or_default();
            row("student file", format_args!("does not compile: {first}"))?;
            Ok(None)
        }
    }
}

fn print_sandbox(possible: Layers, compiler: Layers, host: Layers) -> Result<()> {
    row("rustc's sandbox", describe(compiler))?;
    row("program's sandbox", describe(host))?;
    let sandbox = Sandbox::new(compiler, host, Vec::new());
    row("level", sandbox.level)?;
    if sandbox.level >= Level::Strong {
        return Ok(());
    }
    print_line(format_args!("\nMissing: {}.", missing_layers(&sandbox)))?;
    let mut advice = Machine::here().advice();
    if compiler.landlock < possible.landlock {
        advice.push(
            "rustc and its linker fail when Landlock restricts their files: use rustup's toolchain and the system's \
             gcc"
            .to_owned(),
        );
    }
    if compiler.unprivileged != possible.unprivileged {
        advice.push(
            "rustc cannot be run by another user: install the toolchain where every user can read it"
                .to_owned(),
        );
    }
    advice.iter().try_for_each(|line| print_line(format_args!("- {line}")))
}

fn row(name: &str, value: impl Display) -> Result<()> {
    print_line(format_args!("{name:>18}  {value}"))
}

fn describe(layers: Layers) -> String {
    let yes = |holds: bool, what: &str| format!("{what} {}", if holds { "yes" } else { "NO" });
    let landlock = match layers.landlock {
        0 => "Landlock NO".to_owned(),
        version => format!("Landlock {version}"),
    };
    [
        landlock,
        yes(layers.seccomp, "seccomp"),
        yes(layers.limits, "limits"),
        yes(layers.unprivileged, "not root"),
    ]
    .join(", ")
}

/// A folder with the free space of its file system, where that is known.
fn free_space(folder: &Path) -> String {
    #[cfg(unix)]
    if let Ok(found) = rustix::fs::statvfs(folder) {
        return format!("{} ({} MiB free)", folder.display(), (found.f_bavail * found.f_frsize) >> 20);
    }
    folder.display().to_string()
}
