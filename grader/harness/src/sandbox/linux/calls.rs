//! System calls that no compiler needs, and that Landlock does not see.

use host::confine::seccomp::denying;
use seccompiler::BpfProgram;

/// A filter that refuses them. Starting processes and pairs of sockets stay allowed, since rustc starts the linker, and
/// so does changing the mode of an open file, since the linker makes its output executable.
pub(super) fn compiler_filter() -> Option<BpfProgram> {
    use libc::*;

    let mut calls = vec![
        // Modes, owners, times and attributes of files.
        SYS_fchmodat,
        SYS_fchownat,
        SYS_utimensat,
        SYS_setxattr,
        SYS_lsetxattr,
        SYS_fsetxattr,
        SYS_removexattr,
        SYS_lremovexattr,
        SYS_fremovexattr,
        SYS_name_to_handle_at,
        SYS_open_by_handle_at,
        // Other processes.
        SYS_kill,
        SYS_tkill,
        SYS_pidfd_open,
        SYS_pidfd_send_signal,
        SYS_pidfd_getfd,
        SYS_ptrace,
        SYS_process_vm_readv,
        SYS_process_vm_writev,
        SYS_process_madvise,
        SYS_kcmp,
        // The network, and ways around this filter.
        SYS_socket,
        SYS_io_uring_setup,
        SYS_io_uring_enter,
        SYS_io_uring_register,
        // The kernel.
        SYS_bpf,
        SYS_perf_event_open,
        SYS_userfaultfd,
        SYS_keyctl,
        SYS_add_key,
        SYS_request_key,
        SYS_unshare,
        SYS_setns,
        SYS_mount,
        SYS_umount2,
        SYS_pivot_root,
        SYS_chroot,
        SYS_open_tree,
        SYS_move_mount,
        SYS_fsopen,
        SYS_init_module,
        SYS_finit_module,
        SYS_delete_module,
        SYS_kexec_load,
        SYS_reboot,
        SYS_swapon,
        SYS_swapoff,
        SYS_quotactl,
        SYS_sethostname,
        SYS_setdomainname,
        SYS_settimeofday,
        SYS_clock_settime,
        SYS_adjtimex,
        SYS_acct,
        SYS_syslog,
        SYS_mknodat,
        SYS_personality,
        // Memory that outlives its process.
        SYS_shmget,
        SYS_msgget,
        SYS_semget,
        SYS_mq_open,
    ];
    // Processors with a longer history have older names for the same.
    #[cfg(target_arch = "x86_64")]
    calls.extend([
        SYS_chmod,
        SYS_chown,
        SYS_lchown,
        SYS_utime,
        SYS_utimes,
        SYS_futimesat,
        SYS_mknod,
        SYS_ioperm,
        SYS_iopl,
    ]);
    // Newer than the list of names: the same number on all processors.
    const FCHMODAT2: c_long = 452;
    calls.push(FCHMODAT2);
    denying(&calls, EPERM)
}
