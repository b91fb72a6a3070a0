#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# 32 bits: as ARMv7, with the struct alignment of phones, under qemu: the library's unit tests, and scenes from files drawn adaptively, byte for byte as by 64 bits
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/lib.sh

# The 64-bit command first: what follows takes another compiler. All of the workspace, since a package alone has other
# features, with which everything would be built again.
need_rust
cargo build --quiet --workspace
native=$PWD/target/debug/rarefy

target=armv7-unknown-linux-gnueabihf
need_arm "the 32-bit tests" $target arm-linux-gnueabihf qemu-arm ld-linux-armhf.so.3 \
    gcc-arm-linux-gnueabihf libc6-dev-armhf-cross qemu-user
cross() { cargo "$@" --quiet --package rarefy -Zbuild-std --target $target --target-dir target-arm32; }
cross test --lib --no-default-features

cross build
arm() { qemu-arm -L /usr/arm-linux-gnueabihf target-arm32/$target/debug/rarefy "$@"; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# draw FOLDER COMMAND...: a scene from OBJ, MTL, PNG and view.json, with two layers.
draw() {
    local out=$scratch/$1
    shift
    mkdir "$out"
    "$@" render "$scratch/scene" --device cpu --size "$size" -o "$out/color.png" \
        --layer class="$out/class.png" --layer rays="$out/rays.png" >/dev/null
}

for scene in mirror-room:96x72 cafe:64x48; do
    size=${scene#*:} scene=${scene%:*}
    rm -rf "${scratch:?}"/*
    # The scene's files are the same, too.
    arm make-scene "$scene" -o "$scratch/scene" >/dev/null
    "$native" make-scene "$scene" -o "$scratch/scene-64" >/dev/null
    diff -r "$scratch/scene" "$scratch/scene-64"
    [ -n "$(find "$scratch/scene" -name '*.png' -print -quit)" ] || fail "$scene has no PNG texture"
    draw arm arm
    draw native "$native"
    for picture in color class rays; do
        cmp "$scratch/arm/$picture.png" "$scratch/native/$picture.png"
    done
    # The control: another view of it is another picture.
    size=40x30 draw other "$native"
    ! cmp -s "$scratch/other/color.png" "$scratch/native/color.png" || fail "the comparison sees nothing"
    say "$scene at $size on 32-bit ARM: picture, classes and cost as on 64 bits"
done
