//! `grader doctor`.

use std::path::Path;
use std::process::ExitCode;

use harness::build::{Framework, compile};
use harness::host_process::HostProcess;
use harness::sandbox::{Layers, Level, Limits, Machine, linker};
use harness::workspace::Workspace;
use verdict::error::Result;
use verdict::report::Sandbox;

/// Tell what this machine gives for grading: compiler, linker, sandbox, and how to get a better one.
#[derive(clap::Args)]
pub(super) struct Arguments {}

/// Compiles the starting file and starts it, as a grade would, and tells what was found.
pub(super) fn run(_: &Arguments) -> Result<ExitCode> {
    let workspace = Workspace::find()?;
    let limits = Limits::default();
    say("system", format!("{} on {}", std::env::consts::OS, std::env::consts::ARCH));
    say("cores", rayon::current_num_threads());
    say("checkout", free_space(workspace.root()));
    say("temporary files", free_space(&std::env::temp_dir()));
    let linker =
        linker().map_or("`cc` is not in the search path".to_owned(), |path| path.display().to_string());
    say("linker", linker);

    let framework = Framework::build(&workspace)?;
    say("framework", framework.dependencies.display());
    say("compiler", format!("{} ({})", framework.toolchain, framework.rustc.display()));
    say(
        "time",
        format!("{} s to compile, {} s for a job", limits.compile_time.as_secs(), limits.job_time.as_secs()),
    );
    say(
        "memory",
        format!("{} MiB to compile, {} MiB for a job", limits.compile_memory >> 20, limits.job_memory >> 20),
    );

    let starter = intake::read(&workspace.student_file())?;
    let host = match compile(&framework, &starter.source, &limits)? {
        Ok(program) => {
            let process = HostProcess::start(&program, 1)?;
            if let Some(fault) = process.fault() {
                say("starting file", format!("does not start: {fault}"));
            }
            Some((program.layers, process.layers()))
        }
        Err(failure) => {
            say(
                "starting file",
                format!("does not compile: {}", failure.messages.lines().next().unwrap_or("")),
            );
            None
        }
    };
    let possible = Machine::here().layers();
    let (compiler, host) = host.unwrap_or((possible, possible));
    say("rustc's sandbox", describe(compiler));
    say("submission's sandbox", describe(host));
    let sandbox = Sandbox::new(compiler, host, Vec::new());
    say("level", sandbox.level);
    if sandbox.level < Level::Strong {
        println!("\nWhat is missing: {}.", sandbox.missing);
        let mut advice = Machine::here().advice();
        if compiler.landlock < possible.landlock {
            advice.push(
                "rustc and its linker do not work with their files locked away: with rustup's toolchain and the \
                 system's gcc they do"
                    .to_owned(),
            );
        }
        if compiler.unprivileged != possible.unprivileged {
            advice.push(
                "rustc cannot be run by another user: put the toolchain where anyone can read it".to_owned(),
            );
        }
        for line in advice {
            println!("- {line}");
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn say(what: &str, found: impl std::fmt::Display) {
    println!("{what:>18}  {found}");
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

/// A folder, and how much fits in it, where the system tells.
fn free_space(folder: &Path) -> String {
    #[cfg(unix)]
    if let Ok(found) = rustix::fs::statvfs(folder) {
        return format!("{} ({} MiB free)", folder.display(), (found.f_bavail * found.f_frsize) >> 20);
    }
    folder.display().to_string()
}
