#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# NEON: as 64-bit ARM under qemu, every launch of the wide engine against the twin, bit for bit
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/lib.sh

target=aarch64-unknown-linux-gnu
need_arm "the NEON tests" $target aarch64-linux-gnu qemu-aarch64 ld-linux-aarch64.so.1 \
    gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cargo test --quiet --package rarefy --lib --no-default-features -Zbuild-std --target $target --target-dir target-arm64 -- \
    of_the_engine | tee "$log"
test_counts "$log" >/dev/null
