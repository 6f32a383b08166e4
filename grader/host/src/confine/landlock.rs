//! Landlock: a process gives up access to files and to the network, irrevocably.

use landlock::{
    ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, Ruleset, RulesetAttr, RulesetCreated,
    RulesetError, Scope,
};

/// ABI versions, newest first. Later versions add nothing that is used here.
const VERSIONS: [(ABI, u32); 6] =
    [(ABI::V6, 6), (ABI::V5, 5), (ABI::V4, 4), (ABI::V3, 3), (ABI::V2, 2), (ABI::V1, 1)];

/// A ruleset that grants nothing yet, for the newest ABI version that the kernel accepts, and that version. `None` if
/// the kernel has no Landlock.
///
/// Some kernels report a version that they do not support, so that each version is tried.
pub fn ruleset() -> Option<(RulesetCreated, u32)> {
    VERSIONS.iter().find_map(|&(abi, number)| Some((create(abi).ok()?, number)))
}

fn create(abi: ABI) -> Result<RulesetCreated, RulesetError> {
    let mut ruleset = Ruleset::default()
        .set_compatibility(CompatLevel::HardRequirement)
        .handle_access(AccessFs::from_all(abi))?;
    if abi >= ABI::V4 {
        ruleset = ruleset.handle_access(AccessNet::from_all(abi))?;
    }
    if abi >= ABI::V6 {
        ruleset = ruleset.scope(Scope::from_all(abi))?;
    }
    ruleset.create()
}

/// Applies the ruleset to the calling thread and to everything it starts. Allocates nothing.
pub fn restrict(ruleset: &RulesetCreated) -> std::io::Result<()> {
    let failed = |_| std::io::Error::from(std::io::ErrorKind::PermissionDenied);
    ruleset.try_clone()?.restrict_self().map(|_| ()).map_err(failed)
}

/// True if the calling thread cannot read the root folder, which every unconfined process can.
pub fn holds() -> bool {
    std::fs::File::open("/").is_err_and(|error| error.kind() == std::io::ErrorKind::PermissionDenied)
}
