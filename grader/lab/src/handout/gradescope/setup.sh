#!/usr/bin/env bash
# Gradescope runs this once, when it makes the machine that submissions are graded on.
set -euo pipefail
root=${AUTOGRADER_ROOT:-/autograder}

# Where everybody may read: root's home is closed to the user that submissions are compiled by.
export RUSTUP_HOME=/opt/rustup CARGO_HOME=/opt/cargo PATH=/opt/cargo/bin:$PATH
apt-get update
apt-get install -y --no-install-recommends ca-certificates curl gcc libc6-dev
curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs |
  sh -s -- -y --no-modify-path --profile minimal --default-toolchain 1.95.0

# The solution is in there.
chmod -R go= "$root/source"
cd "$root/source"
cargo build --release --locked -p grader
target/release/grader doctor
# Builds the framework, and keeps what the solution answers, so that no submission waits for it. This fails where the sandbox is
# too weak to grade in: students' code could read the solution.
target/release/grader grade solution/src/algorithms/render_pt.rs --allow-sandbox=medium --no-report --out=/tmp/solution
