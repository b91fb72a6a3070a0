#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# rusticl on llvmpipe, a compiler of its own: every launch against the twin bit for bit, every way of walking, half limits, self-test
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/lib.sh

library() { /sbin/ldconfig -p | awk '/libRusticlOpenCL\.so\.1 / { print $NF; exit }'; }
[ -n "$(library)" ] || need_packages "the rusticl tests" mesa-opencl-icd || fail "the rusticl tests need mesa-opencl-icd"
[ -n "$(library)" ] || fail "this machine's Mesa has no rusticl"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/icd"
library >"$scratch/icd/rusticl.icd"
export OCL_ICD_VENDORS=$scratch/icd RUSTICL_ENABLE=llvmpipe
export RAREFY_CACHE_DIR=$scratch/cache MESA_SHADER_CACHE_DIR=$scratch/mesa

cargo build --quiet --workspace
device=$(target/debug/rarefy devices | grep '^opencl:0 ') || fail "rusticl shows no device"
say "$device"
case $device in *llvmpipe*) ;; *) fail "that is not llvmpipe" ;; esac
# Not the tests of the context itself, which ask for work-groups of 64: rusticl 22.3 allows a kernel 32 work-items. Nor the one that
# builds kernels with checks of bounds, at which its compiler works for more than a quarter of an hour.
cargo test --quiet --workspace \
    --test stage_parity --test traversal --test half_limits --test quick_test -- \
    --skip auto_prefers_the_engine_to_opencl_on_a_cpu
