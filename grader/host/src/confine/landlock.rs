//! Landlock: a process gives up access to files, and to the network, for good.

use landlock::{
    ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, Ruleset, RulesetAttr, RulesetCreated,
    RulesetError, Scope,
};

/// The versions of its interface, the newest first. Version 7 and later ones bring nothing that is used here.
const VERSIONS: [(ABI, u32); 6] =
    [(ABI::V6, 6), (ABI::V5, 5), (ABI::V4, 4), (ABI::V3, 3), (ABI::V2, 2), (ABI::V1, 1)];

/// A set of rules that grants nothing yet, for the newest version that the kernel takes, and which one that is.
///
/// Some kernels claim a version that they do not have: versions are tried, not believed.
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

/// Holds the calling thread, and all that it starts, to the rules. It allocates nothing.
pub fn restrict(ruleset: &RulesetCreated) -> std::io::Result<()> {
    let failed = |_| std::io::Error::from(std::io::ErrorKind::PermissionDenied);
    ruleset.try_clone()?.restrict_self().map(|_| ()).map_err(failed)
}

/// Whether the calling thread can no longer read the root of all files, which anyone else can.
pub fn holds() -> bool {
    std::fs::File::open("/").is_err_and(|error| error.kind() == std::io::ErrorKind::PermissionDenied)
}
