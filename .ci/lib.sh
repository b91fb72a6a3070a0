# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# Shared by the scripts of this project: installing what is missing, finding Rust, telling how long things took.
# To be sourced, with `set -euo pipefail`, from the repository's root.

export DEBIAN_FRONTEND=noninteractive
# Nothing here may wait for somebody to type.
exec </dev/null

say() { printf '%s\n' "$*"; }
fail() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}
have() { command -v "$1" >/dev/null 2>&1; }

# section TITLE COMMAND...: runs a command between a title and the time it took.
section() {
    local title=$1 start=$SECONDS
    shift
    say "== $title"
    "$@"
    say "== $title: $((SECONDS - start)) s"
}

# test_counts LOG: adds up the `test result:` lines of cargo in a log; an error if no test ran at all.
test_counts() {
    awk '/^test result: / { for (i = 2; i <= NF; i++) { if ($i == "passed;") p += $(i - 1); if ($i == "failed;") f += $(i - 1) } }
        END { printf "tests: %d passed, %d failed\n", p, f; exit p + f == 0 }' "$1" || fail "no test ran"
}

# The words in front of a command that needs root; status 1 if there is no way to be root.
root_prefix() {
    if [ "$(id -u)" = 0 ]; then
        echo env
    elif have sudo && sudo -n true 2>/dev/null; then
        echo sudo -n --preserve-env=DEBIAN_FRONTEND
    else
        return 1
    fi
}

# Fetches the package lists, once in a run. A list that is stale or partly out of reach may do: the install decides.
apt_lists_are_fresh=no
fresh_package_lists() {
    local prefix
    [ $apt_lists_are_fresh = no ] && prefix=$(root_prefix) || return 0
    apt_lists_are_fresh=yes
    $prefix apt-get -qq -o DPkg::Lock::Timeout=300 update || say "apt-get update failed; going on with the old lists" >&2
}

# need_packages REASON PACKAGE...: installs those that are missing; quiet if none is. Status 1, with the reason and what
# a person can do, where that is not possible.
need_packages() {
    local reason=$1 package missing=() prefix
    shift
    if ! have apt-get; then
        say "no apt-get here; $reason needs what Debian calls: $*" >&2
        return 1
    fi
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    if ! prefix=$(root_prefix); then
        say "not root and no password-free sudo; $reason needs: apt-get install ${missing[*]}" >&2
        return 1
    fi
    say "installing for $reason: ${missing[*]}"
    fresh_package_lists
    if ! $prefix apt-get -qq -y -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 install --no-install-recommends \
        "${missing[@]}" >/dev/null; then
        say "apt-get could not install: ${missing[*]} ($reason)" >&2
        return 1
    fi
}

# at_least VERSION WANTED: whether a dotted version is new enough.
at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

# The version of a rustc, such as 1.88.0; empty if it does not run.
rustc_version() { "$1" --version 2>/dev/null | awk '{print $2}' || true; }

# The oldest Rust that the project builds with, from Cargo.toml.
rust_wanted() { sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml | head -n 1; }

# need_rust: a `cargo` and `rustc` on PATH that are new enough, or an error that says how to get them.
need_rust() {
    local wanted version pair
    wanted=$(rust_wanted)
    need_linker
    if have cargo && have rustc; then
        version=$(rustc_version rustc)
        [ -z "$version" ] || ! at_least "$version" "$wanted" || return 0
    fi
    # The distribution's. On Debian 12 the plain packages are old; those for building web browsers are not.
    for pair in "" "rustc-web cargo-web" "rustc cargo"; do
        if [ -n "$pair" ]; then
            have apt-cache || continue
            fresh_package_lists
            version=$(apt-cache policy "${pair% *}" 2>/dev/null | awk '/Candidate:/ {print $2}')
            [ -n "$version" ] && [ "$version" != "(none)" ] && at_least "${version%%[+-]*}" "$wanted" || continue
            # shellcheck disable=SC2086 # two words are meant
            need_packages "building Rarefy" $pair || continue
        fi
        version=$(rustc_version /usr/bin/rustc)
        if [ -x /usr/bin/cargo ] && [ -n "$version" ] && at_least "$version" "$wanted"; then
            export PATH="/usr/bin:$PATH"
            return 0
        fi
    done
    say "no Rust $wanted or newer, and the distribution has none. This line installs one:" >&2
    say "  curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y && . ~/.cargo/env" >&2
    exit 1
}

# need_linker: the C compiler driver that cargo links with.
need_linker() {
    have cc || need_packages "linking" gcc libc6-dev || fail "no C compiler driver \`cc\`: cargo needs one to link"
}

# need_rust_with_source REASON: cargo, rustc and the source of the standard library, all of one version, to build for targets
# whose standard library nobody has built. Sets PATH and what `-Zbuild-std` needs, so call it in a script of its own.
need_rust_with_source() {
    local reason=$1 rustc
    need_linker
    for rustc in "$(command -v rustc || true)" /usr/bin/rustc install /usr/bin/rustc; do
        if [ "$rustc" = install ]; then
            need_packages "$reason" rustc-web cargo-web rust-web-src ||
                need_packages "$reason" rustc cargo rust-src ||
                fail "$reason needs rustc, cargo and the standard library's source (rustup component add rust-src)"
        elif [ -x "$rustc" ] && [ -x "${rustc%rustc}cargo" ] && at_least "$(rustc_version "$rustc")" "$(rust_wanted)" &&
            [ -f "$("$rustc" --print sysroot)/lib/rustlib/src/rust/library/std/Cargo.toml" ]; then
            # RUSTC_BOOTSTRAP: building the standard library is not in stable Rust's options.
            export RUSTC=$rustc RUSTDOC=${rustc%rustc}rustdoc RUSTC_BOOTSTRAP=1 PATH="${rustc%/rustc}:$PATH"
            return 0
        fi
    done
    fail "no rustc with the source of its standard library (rustup component add rust-src)"
}

# need_arm REASON TARGET PREFIX QEMU LOADER PACKAGE...: a cross compiler and qemu for an ARM target of Rust's; cargo links
# with the one and runs with the other. PREFIX is what the compiler's name and its folder of libraries begin with, LOADER
# a file in there.
need_arm() {
    local reason=$1 target=${2//-/_} prefix=$3 qemu=$4 loader=$5
    shift 5
    # Some machines have them from elsewhere.
    have "$prefix-gcc" && have "$qemu" && [ -e "/usr/$prefix/lib/$loader" ] || need_packages "$reason" "$@" ||
        fail "$reason needs a cross compiler for ARM and qemu"
    need_rust_with_source "$reason"
    export "CARGO_TARGET_${target^^}_LINKER=$prefix-gcc" "CARGO_TARGET_${target^^}_RUNNER=$qemu -L /usr/$prefix"
    # There is no OpenCL of that architecture here: the kernels' tests run on the machine's own.
    export RAREFY_TEST_OPENCL=none RAREFY_TEST_CLANG=none
}
