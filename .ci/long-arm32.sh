#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# 32 bits: the library's unit tests as ARMv7, with the struct alignment of phones, under qemu
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/lib.sh

# Some machines have them from elsewhere.
have arm-linux-gnueabihf-gcc && have qemu-arm && [ -e /usr/arm-linux-gnueabihf/lib/ld-linux-armhf.so.3 ] ||
    need_packages "the 32-bit tests" gcc-arm-linux-gnueabihf libc6-dev-armhf-cross qemu-user ||
    fail "the 32-bit tests need an ARM cross compiler and qemu"
need_rust_with_source "the 32-bit test"
export CARGO_TARGET_ARMV7_UNKNOWN_LINUX_GNUEABIHF_LINKER=arm-linux-gnueabihf-gcc
export CARGO_TARGET_ARMV7_UNKNOWN_LINUX_GNUEABIHF_RUNNER="qemu-arm -L /usr/arm-linux-gnueabihf"
# There is no 32-bit OpenCL here: the kernels' tests run on the machine's own architecture.
export RAREFY_TEST_OPENCL=none RAREFY_TEST_CLANG=none
cargo test --quiet --package rarefy --lib --no-default-features -Zbuild-std \
    --target armv7-unknown-linux-gnueabihf --target-dir target-arm32
