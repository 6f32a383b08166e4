#!/usr/bin/env bash
# Gradescope runs this once, when it builds the image in which submissions are graded.
set -euo pipefail
root=${AUTOGRADER_ROOT:-/autograder}

# Readable by all users: submissions are compiled by a user who has no access to root's home.
export RUSTUP_HOME=/opt/rustup CARGO_HOME=/opt/cargo PATH=/opt/cargo/bin:$PATH
apt-get update
apt-get install -y --no-install-recommends ca-certificates curl gcc libc6-dev
# From the server of the toolchains, so that this asks for one address only.
curl --proto '=https' --tlsv1.2 -sSf https://static.rust-lang.org/rustup/rustup-init.sh |
  sh -s -- -y --no-modify-path --profile minimal --default-toolchain 1.95.0

# Contains the solution.
chmod -R go= "$root/source"
cd "$root/source"
# Not --locked: Cargo removes from Cargo.lock what only packages needed that are not here, and keeps all versions.
cargo build --release -p grader
target/release/grader doctor
# Builds the framework and caches the results of the solution, so that no submission waits for them. Fails if the sandbox
# is too weak: the code of students could read the solution.
target/release/grader grade "@SOLUTION@" --allow-sandbox=medium --no-report --out=/tmp/solution
