//! The sandbox on Linux: which layers this machine supports, and how a process is confined before its program starts.

mod account;
mod calls;
mod clock;
mod loading;
mod memory;
mod user;

use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use host::confine::{landlock as files, seccomp};
use landlock::{ABI, AccessFs, PathBeneath, PathFd, RulesetCreated, RulesetCreatedAttr};
use rustix::process::{
    Resource, Rlimit, Signal, geteuid, getrlimit, set_parent_process_death_signal, setrlimit,
};
use seccompiler::BpfProgram;
use verdict::sandbox::Layers;

use super::process::Profile;
use super::{Grants, Limits};
use user::{Switch, User, switch_user};
use verdict::error::{Error, Result};

pub(crate) use account::Account;
pub(crate) use clock::{delay, processor_time};
pub(crate) use loading::confirmed;
pub(crate) use memory::out_of_memory_kills;

/// Sandbox support of this machine, found by trying.
#[derive(Clone, Debug)]
pub struct Machine {
    landlock: u32,
    seccomp: bool,
    user: User,
}

impl Machine {
    /// This machine. It is probed once.
    pub fn here() -> &'static Self {
        static HERE: OnceLock<Machine> = OnceLock::new();
        HERE.get_or_init(Self::measure)
    }

    /// Confines a thread and lets it try what must fail. Other threads are not affected.
    fn measure() -> Self {
        let nothing = Self { landlock: 0, seccomp: false, user: User::here() };
        let user = nothing.user.clone();
        let confined = std::thread::spawn(move || {
            let user = user.confirm();
            let landlock = files::ruleset()
                .filter(|(ruleset, _)| files::restrict(ruleset).is_ok() && files::holds())
                .map_or(0, |(_, abi)| abi);
            let seccomp = seccomp::denying(&[libc::SYS_statx, libc::SYS_newfstatat], libc::EPERM)
                .is_some_and(|filter| seccompiler::apply_filter(&filter).is_ok() && seccomp::holds());
            Self { landlock, seccomp, user }
        });
        confined.join().unwrap_or(nothing)
    }

    /// Layers that are available.
    pub fn layers(&self) -> Layers {
        Layers {
            landlock: self.landlock,
            seccomp: self.seccomp,
            limits: true,
            unprivileged: !matches!(self.user, User::Root(_)),
        }
    }

    /// Steps that raise the sandbox level of this machine, one sentence each; empty at the highest level.
    pub fn advice(&self) -> Vec<String> {
        let mut advice = Vec::new();
        if self.landlock == 0 {
            advice.push(
                "Landlock: use Linux 5.13 or newer, with `landlock` in the kernel's list of security modules \
                 (boot with `lsm=landlock,…`); a container's seccomp profile must let its three system calls through"
                    .to_owned(),
            );
        }
        if !self.seccomp {
            advice
                .push("seccomp: use a kernel with CONFIG_SECCOMP_FILTER, on x86-64 or 64-bit ARM".to_owned());
        }
        if let User::Root(why) = &self.user {
            advice.push(format!("another user id: {why}; or do not run the grader as root"));
        }
        advice
    }
}

/// Everything that a process does to itself between fork and exec.
#[derive(Default)]
struct Confinement {
    limits: Vec<(Resource, Rlimit)>,
    user: Option<Switch>,
    landlock: Option<RulesetCreated>,
    /// seccomp filters, in the order in which they are applied.
    seccomp: Vec<BpfProgram>,
}

impl Confinement {
    /// Runs in the new process: it must not allocate or wait for a lock.
    fn enforce(&mut self) -> std::io::Result<()> {
        close_others_on_exec();
        for &(resource, limit) in &self.limits {
            setrlimit(resource, limit)?;
        }
        if let Some(switch) = self.user {
            switch_user(switch)?;
        }
        // After the change of user, which would undo it. Should the grader be killed, its submissions end with it.
        set_parent_process_death_signal(Some(Signal::KILL))?;
        rustix::thread::set_no_new_privs(true)?;
        if let Some(ruleset) = &self.landlock {
            files::restrict(ruleset)?;
        }
        seccomp::set_own_id(&mut self.seccomp);
        for filter in &self.seccomp {
            let failed = |_| std::io::Error::from(std::io::ErrorKind::PermissionDenied);
            seccompiler::apply_filter(filter).map_err(failed)?;
        }
        Ok(())
    }
}

/// See [`super::prepare`].
pub(super) fn confine(command: &mut Command, profile: Profile<'_>, limits: &Limits) -> Result<Layers> {
    let mut confinement = confinement(profile, limits)?;
    let layers = Layers {
        landlock: confinement.landlock.as_ref().map_or(0, |_| Machine::here().landlock),
        seccomp: !confinement.seccomp.is_empty(),
        limits: true,
        unprivileged: confinement.user.is_some() || !geteuid().is_root(),
    };
    // SAFETY: of the new process only this thread lives on, so that a lock that another one held is held for ever.
    // `enforce` allocates nothing and takes no lock: it makes system calls with what was prepared here.
    unsafe { command.pre_exec(move || confinement.enforce()) };
    Ok(layers)
}

fn confinement(profile: Profile<'_>, limits: &Limits) -> Result<Confinement> {
    let mut confinement = Confinement { limits: limits_of(profile, limits), ..Confinement::default() };
    let machine = Machine::here();
    if !limits.sandbox {
        return Ok(confinement);
    }
    let trouble = |error| Error::Harness(format!("the rules of Landlock: {error}"));
    let account = match profile {
        Profile::Host { program, account, .. } => {
            confinement.seccomp =
                machine.seccomp.then(seccomp::loading_filters).flatten().into_iter().flatten().collect();
            if machine.landlock > 0 {
                confinement.landlock = Some(loading::rules(program).map_err(trouble)?);
            }
            account
        }
        Profile::Compiler { grants, folder, locked, account } => {
            confinement.seccomp =
                machine.seccomp.then(calls::compiler_filter).flatten().into_iter().collect();
            if locked && machine.landlock > 0 {
                confinement.landlock = Some(rules(grants, folder).map_err(trouble)?);
            }
            // A toolchain below a closed home can be read by root only. What else root could read or write, Landlock sees
            // to; where there is no such right to give, or no Landlock, rustc stays root.
            if machine.user == User::Other && !user::anyone_reads(grants) {
                let landlocked = confinement.landlock.is_some();
                let Some(right) = user::right_to_read_all().filter(|_| landlocked) else {
                    return Ok(confinement);
                };
                confinement.user = account.id().map(|id| Switch { id, reads_all: Some(right) });
                return Ok(confinement);
            }
            account
        }
    };
    confinement.user = account.id().map(|id| Switch { id, reads_all: None });
    Ok(confinement)
}

/// The kernel's resource limits that follow from [`Limits`].
fn limits_of(profile: Profile<'_>, limits: &Limits) -> Vec<(Resource, Rlimit)> {
    let (memory, time, file, files) = match profile {
        Profile::Compiler { .. } => {
            (limits.compile_memory, 4 * limits.compile_time.as_secs() + 1, LARGEST_FILE, 1024)
        }
        // The clock on the wall ends a job; this ends a process that nobody looks at any more.
        Profile::Host { threads, .. } => (limits.job_memory + RESERVED * threads as u64, 3600, 0, 64),
    };
    [
        (Resource::As, memory),
        (Resource::Cpu, time),
        (Resource::Fsize, file),
        (Resource::Nofile, files),
        (Resource::Core, 0),
    ]
    .map(|(resource, value)| {
        let highest = getrlimit(resource).maximum.map_or(value, |maximum| maximum.min(value));
        (resource, Rlimit { current: Some(highest), maximum: Some(highest) })
    })
    .into()
}

/// Maximum size in bytes of a file that a compiler may write.
const LARGEST_FILE: u64 = 256 << 20;

/// Bytes that the C library reserves for each thread without using them: an arena (reserved twice for alignment) and a
/// stack.
const RESERVED: u64 = 160 << 20;

/// Landlock rules for a compiler.
fn rules(grants: &Grants, folder: &Path) -> std::result::Result<RulesetCreated, Box<dyn std::error::Error>> {
    let (mut ruleset, _) = files::ruleset().ok_or("the kernel has none any more")?;
    let read = AccessFs::ReadFile | AccessFs::ReadDir;
    // rustc gives the linker nothing to read by way of this.
    let null = std::iter::once((Path::new("/dev/null"), AccessFs::ReadFile | AccessFs::WriteFile));
    let reads = grants.read.iter().map(|path| (path.as_path(), read));
    let executes = grants.execute.iter().map(|path| (path.as_path(), read | AccessFs::Execute));
    for (path, access) in reads.chain(executes).chain(null) {
        let access = if path.is_dir() { access } else { access & AccessFs::from_file(ABI::V1) };
        ruleset = ruleset.add_rule(PathBeneath::new(PathFd::new(path)?, access))?;
    }
    let own = read
        | AccessFs::WriteFile
        | AccessFs::MakeReg
        | AccessFs::MakeDir
        | AccessFs::RemoveFile
        | AccessFs::RemoveDir;
    let own = if Machine::here().landlock >= 3 { own | AccessFs::Truncate } else { own };
    Ok(ruleset.add_rule(PathBeneath::new(PathFd::new(folder)?, own))?)
}

/// Leaves the new program only its three standard streams.
fn close_others_on_exec() {
    // SAFETY: it touches no memory. Old kernels do not know the call; everything that the grader itself opens is
    // closed in any case.
    unsafe { libc::syscall(libc::SYS_close_range, 3, libc::c_uint::MAX, libc::CLOSE_RANGE_CLOEXEC) };
}
