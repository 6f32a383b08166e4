#!/usr/bin/env bash
# Gradescope runs this once, when it makes the machine that hand-ins are graded on.
set -euo pipefail
root=${AUTOGRADER_ROOT:-/autograder}

apt-get update
apt-get install -y --no-install-recommends ca-certificates curl gcc libc6-dev
if ! command -v cargo >/dev/null && [ ! -x "$HOME/.cargo/bin/cargo" ]; then
  curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y --profile minimal
fi
export PATH="$HOME/.cargo/bin:$PATH"

cd "$root/source"
cargo build --release --locked -p grader
# Compiles the framework, so that the first hand-in does not wait for it.
target/release/grader doctor
