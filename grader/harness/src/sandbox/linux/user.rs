//! The unprivileged user that submissions run as when the grader is root.

use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::sync::OnceLock;

use rustix::process::geteuid;
use rustix::process::{Gid, Uid};
use rustix::thread::{
    CapabilitiesSecureBits, CapabilitySet, CapabilitySets, configure_capability_in_ambient_set,
    set_capabilities, set_capabilities_secure_bits, set_thread_groups, set_thread_res_gid,
    set_thread_res_uid,
};

use super::super::Grants;

/// Number of ids for submissions: the maximum number that are compiled or run at a time on the whole machine.
pub(super) const IDS: u32 = 1024;

/// Possible first ids: the first is in a range that distributions do not assign, the others exist in containers with few
/// ids.
const FIRST_IDS: [u32; 2] = [0x7a00_0000, 64_000];

/// First id for submissions on this machine. A group has the same number as its user.
pub(super) fn first_id() -> u32 {
    static FIRST: OnceLock<u32> = OnceLock::new();
    *FIRST.get_or_init(|| {
        let maps = ["uid_map", "gid_map"].map(|map| std::fs::read_to_string(format!("/proc/self/{map}")));
        let known = |first: u32| maps.iter().all(|map| map.as_ref().is_ok_and(|map| has_ids(map, first)));
        FIRST_IDS.into_iter().find(|&first| known(first)).unwrap_or(FIRST_IDS[1])
    })
}

/// True if one line of an id map (first inside, first outside, count) contains all ids for submissions.
fn has_ids(map: &str, first: u32) -> bool {
    map.lines().any(|line| {
        let numbers: Vec<u64> = line.split_whitespace().filter_map(|number| number.parse().ok()).collect();
        let [inside, _, count] = numbers[..] else { return false };
        inside <= u64::from(first) && u64::from(first + IDS) <= inside + count
    })
}

/// User that submissions run as.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum User {
    /// The same user as the grader, which is not root.
    Same,
    /// Another user.
    Other,
    /// Root, with the reason why no other user is possible.
    Root(String),
}

impl User {
    /// The expected user on this machine.
    pub(super) fn here() -> Self {
        let folder = std::env::temp_dir();
        if !geteuid().is_root() {
            Self::Same
        } else if !folder.ancestors().all(|folder| anyone_may(folder, 0o001)) {
            Self::Root(format!(
                "the folder for temporary files, {}, is closed to others; set TMPDIR to one that is not",
                folder.display()
            ))
        } else {
            Self::Other
        }
    }

    /// Becomes that user in the calling thread only; stays root if that is not possible.
    pub(super) fn confirm(self) -> Self {
        if self != Self::Other {
            return self;
        }
        match switch_user(Switch { id: first_id(), reads_all: None }) {
            Ok(()) if !geteuid().is_root() => Self::Other,
            Ok(()) => Self::Root("the user id cannot be changed here".to_owned()),
            Err(error) => Self::Root(format!("the user id cannot be changed here ({error})")),
        }
    }
}

/// Everything needed to become the other user.
#[derive(Clone, Copy, Debug)]
pub(super) struct Switch {
    /// Id of the user and of its group.
    pub(super) id: u32,
    /// Root's capability to read all files, if it is to be kept.
    pub(super) reads_all: Option<CapabilitySet>,
}

/// Makes the calling thread run as the other user for good. Does not allocate.
pub(super) fn switch_user(switch: Switch) -> std::io::Result<()> {
    let (user, group) = (Uid::from_raw(switch.id), Gid::from_raw(switch.id));
    if switch.reads_all.is_some() {
        // Rights outlive the change, and count for `access`, too, by which gcc looks for its parts.
        set_capabilities_secure_bits(CapabilitiesSecureBits::NO_SETUID_FIXUP)?;
    }
    set_thread_groups(&[])?;
    set_thread_res_gid(group, group, group)?;
    set_thread_res_uid(user, user, user)?;
    if let Some(read) = switch.reads_all {
        set_capabilities(None, CapabilitySets { effective: read, permitted: read, inheritable: read })?;
        configure_capability_in_ambient_set(read, true)?;
    }
    Ok(())
}

/// Root's capability by which the other user can read all files; `None` if root does not have it here.
pub(super) fn right_to_read_all() -> Option<CapabilitySet> {
    static RIGHT: OnceLock<Option<CapabilitySet>> = OnceLock::new();
    // A container's root has often only the second, which is more than is needed, and less than to stay root.
    let works = |right: &CapabilitySet| {
        let switch = Switch { id: first_id(), reads_all: Some(*right) };
        // In a thread of its own, which ends with what it has become.
        matches!(std::thread::spawn(move || switch_user(switch)).join(), Ok(Ok(())))
    };
    *RIGHT
        .get_or_init(|| [CapabilitySet::DAC_READ_SEARCH, CapabilitySet::DAC_OVERRIDE].into_iter().find(works))
}

/// True if the modes of these files let every user read them.
pub(super) fn anyone_reads(grants: &Grants) -> bool {
    grants.read.iter().all(|path| {
        anyone_may(path, 0o004) && path.ancestors().skip(1).all(|folder| anyone_may(folder, 0o001))
    })
}

/// True if the mode of a file gives others these permissions.
fn anyone_may(path: &Path, rights: u32) -> bool {
    std::fs::metadata(path).is_ok_and(|metadata| metadata.mode() & rights == rights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_those_that_the_kernel_knows() {
        let [high, low] = FIRST_IDS;
        let everything = "         0          0 4294967295\n";
        assert!(has_ids(everything, high) && has_ids(everything, low));
        let container = "         0     100000      65536\n";
        assert!(!has_ids(container, high) && has_ids(container, low));
        assert!(!has_ids("0 1000 1\n", low) && !has_ids("", low));
    }
}
