#!/usr/bin/env bash
# Gradescope runs this once, when it builds the image in which submissions are graded.
set -euo pipefail
root=${AUTOGRADER_ROOT:-/autograder}

# Readable by all users: submissions are compiled by a user who has no access to root's home.
export RUSTUP_HOME=/opt/rustup CARGO_HOME=/opt/cargo PATH=/opt/cargo/bin:$PATH
apt-get update
apt-get install -y --no-install-recommends ca-certificates curl gcc libc6-dev
curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs |
  sh -s -- -y --no-modify-path --profile minimal --default-toolchain 1.95.0

# Contains the solution.
chmod -R go= "$root/source"
cd "$root/source"
cargo build --release --locked -p grader
target/release/grader doctor
# Builds the framework and caches the results of the solution, so that no submission waits for them. Fails if the sandbox
# is too weak: the code of students could read the solution.
target/release/grader grade "@SOLUTION@" --allow-sandbox=medium --no-report --out=/tmp/solution
