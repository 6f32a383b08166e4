//! Sandboxes.

use verdict::report::Sandbox;
use verdict::sandbox::Layers;

/// What is missing for the best level; empty if nothing is.
pub fn missing_layers(sandbox: &Sandbox) -> String {
    missing(sandbox.compiler.and(sandbox.host)).join(", ")
}

/// What is missing of these layers for the best level.
fn missing(layers: Layers) -> Vec<&'static str> {
    let Layers { landlock, seccomp, limits, unprivileged } = layers;
    let mut missing = Vec::new();
    if landlock == 0 {
        missing.push("file access is not restricted (Landlock)");
    }
    if !seccomp {
        missing.push("system calls are not filtered (seccomp)");
    }
    if !limits {
        missing.push("memory is not limited");
    }
    if !unprivileged && cfg!(target_os = "linux") {
        missing.push("it runs as root");
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_missing_layer_is_named() {
        let all = Layers { landlock: 7, seccomp: true, limits: true, unprivileged: true };
        assert!(missing(all).is_empty());
        for (one, name) in [
            (Layers { landlock: 0, ..all }, "Landlock"),
            (Layers { seccomp: false, ..all }, "seccomp"),
            (Layers { limits: false, ..all }, "memory"),
        ] {
            let sandbox = Sandbox::new(all, one, Vec::new());
            assert!(missing_layers(&sandbox).contains(name), "{one:?}");
            assert_eq!(missing(one).len(), 1, "{one:?}");
        }
    }
}
