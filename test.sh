#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Builds and tests. `./test.sh` is quick (minutes on 2 cores); `./test.sh --long` runs what takes longer instead: tests
# marked `#[ignore = "long: ..."]` and each .ci/long-*.sh. Installs what is missing; see .ci/setup.sh.
set -euo pipefail
cd "$(dirname "$0")"
. .ci/lib.sh

build_all() { cargo build --workspace; }
log=$(mktemp)
trap 'rm -f "$log"' EXIT
tests() { cargo test --workspace "$@" 2>&1 | tee -a "$log"; }

case ${1-} in
"")
    . .ci/setup.sh test
    section "build" build_all
    section "tests" tests
    test_counts "$log"
    say "all quick tests passed (./test.sh --long runs the others)"
    ;;
--long)
    . .ci/setup.sh long
    section "build" build_all
    section "long tests" tests -- --ignored
    covered="long tests of the workspace"
    for script in .ci/long-*.sh; do
        section "$script" "$script" | tee -a "$log"
        # Its second line of comment, after the licence, says what it covers.
        covered="$covered
$(sed -n '3s/^# //p' "$script") ($script)"
    done
    test_counts "$log"
    say "all long tests passed:"
    say "$covered"
    ;;
*) fail "usage: ./test.sh [--long]" ;;
esac
