#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Oclgrind: every kernel interpreted, with checks for data races, accesses beyond buffers, reads of uninitialised memory, and a phone's limits
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/lib.sh

runtime=/usr/lib/oclgrind/liboclgrind-rt-icd.so
[ -e "$runtime" ] || need_packages "the Oclgrind tests" oclgrind || fail "the Oclgrind tests need oclgrind"
[ -e "$runtime" ] || runtime=$(find / -xdev -name liboclgrind-rt-icd.so -print -quit 2>/dev/null)
[ -n "$runtime" ] || fail "oclgrind has no ICD library here"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/icd"
echo "$runtime" >"$scratch/icd/oclgrind.icd"
export OCL_ICD_VENDORS=$scratch/icd
export OCLGRIND_DATA_RACES=1
# Optimised kernels use an LLVM intrinsic (copysign) that Oclgrind 21.10 cannot interpret.
export OCLGRIND_BUILD_OPTIONS=-cl-opt-disable
# The limits of an Adreno 420.
export OCLGRIND_MAX_WGSIZE=1024 OCLGRIND_LOCAL_MEM_SIZE=32768 OCLGRIND_CONSTANT_MEM_SIZE=65536
export OCLGRIND_GLOBAL_MEM_SIZE=1073741824

# One process a test: Oclgrind opens its log once.
for test in no_kernel_races_or_leaves_its_buffers a_racing_kernel_is_found \
    no_kernel_reads_what_nobody_wrote a_read_of_what_nobody_wrote_is_found \
    no_frame_in_the_space_of_options_races_or_leaves_its_buffers; do
    # This check is right only where no buffer is released before and none is written in part: docs/implementations.md.
    unset OCLGRIND_UNINITIALIZED
    case $test in *nobody_wrote*) export OCLGRIND_UNINITIALIZED=1 ;; esac
    export OCLGRIND_LOG=$scratch/$test.log RAREFY_OCLGRIND_LOG=$scratch/$test.log
    rm -rf target/tmp/oclgrind target/tmp/option-space
    binary=oclgrind
    case $test in *space_of_options*) binary=option_space ;; esac
    cargo test --quiet --workspace --test $binary -- --ignored --exact --nocapture "$test"
done
