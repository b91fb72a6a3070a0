#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# From a fresh clone to pictures: installs what is missing (see .ci/setup.sh), builds, draws the built-in café with full
# and with adaptive tracing, and prints where the pictures are.
set -euo pipefail
cd "$(dirname "$0")"
. .ci/lib.sh
. .ci/setup.sh run

say "building"
cargo build --release --quiet
# The kernels, which are what a phone runs; `auto` would take the engine for CPUs where OpenCL is no GPU.
device=(--device opencl)
if [ "$opencl" = no ]; then
    say "no OpenCL on this machine: drawing on the CPU"
    device=(--device cpu)
fi
mkdir -p out
started=$(mktemp)
trap 'rm -f "$started"' EXIT
target/release/rarefy compare cafe --size 1024x1024 "${device[@]}" -o out
pictures=$(find "$PWD/out" -name '*.png' -newer "$started" | sort)
[ -n "$pictures" ] || fail "no picture was written to $PWD/out"
say "pictures:"
say "$pictures"
