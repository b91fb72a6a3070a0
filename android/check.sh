#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Cross-compiles and links librarefy_jni.so for the Android ABIs without an NDK, checks what came out, runs it in a Java VM of each ABI
# under qemu, and makes and checks the AAR and the demo app.
#
#   android/check.sh               all checks; `--self-check`, `--aar` and `--apk` are part of it
#   android/check.sh --self-check  only: do the checks notice what they are there for? (seconds, no Rust)
#   android/check.sh --aar         only: builds the AAR with its sources, documentation and POM, and has it consumed
#   android/check.sh --apk         only: builds the demo app as a package (APK) and a bundle, checks them and prints what is in them
#
# How it works without an NDK: the linker gets stub libraries that define nothing but the symbols in stubs/*.txt, all of
# which Android has had since API 21 (Android 5). With --no-undefined, whatever else the code needs is a link error, so
# the stubs are the test of the API level. The unwinder is LLVM's, linked statically as an NDK does (check/unwind.sh).
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/lib.sh
. android/check/unwind.sh
. android/check/qemu.sh
. android/check/java.sh
. android/check/aar.sh
. android/check/demo.sh
. android/check/lint.sh

api=21
page=0x4000 # 16 KiB pages: required of new apps since November 2025; 4 KiB phones take them as well
size_limit=$((3 * 1024 * 1024))
work=$PWD/target-android
# The last one is that of emulators and Chromebooks.
abis="arm64-v8a armeabi-v7a x86_64"

rust_target() {
    case $1 in
    arm64-v8a) echo aarch64-linux-android ;;
    armeabi-v7a) echo armv7-linux-androideabi ;;
    x86_64) echo x86_64-linux-android ;;
    esac
}
clang_target() {
    case $1 in
    arm64-v8a) echo aarch64-linux-android$api ;;
    armeabi-v7a) echo armv7a-linux-androideabi$api ;;
    x86_64) echo x86_64-linux-android$api ;;
    esac
}
machine() { case $1 in arm64-v8a) echo AArch64 ;; armeabi-v7a) echo ARM ;; x86_64) echo 'Advanced Micro Devices X86-64' ;; esac; }

# The symbols in a stub list: a word a line, after which an ABI in brackets may say that only that one has it.
symbols() { # LIST ABI
    sed 's/#.*//' "$1" | awk -v abi="[$2]" 'NF && (NF == 1 || $2 == abi) {print $1}'
}

make_stubs() { # ABI FROM-FOLDER TO-FOLDER
    local list name
    mkdir -p "$3"
    for list in "$2"/lib*.txt; do
        name=$(basename "$list" .txt)
        # `%function`, since `@` begins a comment in ARM assembly.
        symbols "$list" "$1" | awk '{printf ".globl %s\n.type %s,%%function\n%s:\n.long 0\n", $1, $1, $1}' >"$3/$name.s"
        clang --target="$(clang_target "$1")" -c "$3/$name.s" -o "$3/$name.o"
        ld.lld -shared --soname="$name.so" -o "$3/$name.so" "$3/$name.o"
    done
}

make_linker() { # ABI STUBS FILE [FOLDER]: the compiler driver that cargo links with; the folder has the unwinder
    cat >"$3" <<EOT
#!/bin/sh
exec clang --target=$(clang_target "$1") -fuse-ld=lld -nostdlib "-L$2" "-L${4-$2}" -Wl,-z,max-page-size=$page -Wl,--no-undefined -Wl,--error-limit=0 "\$@"
EOT
    chmod +x "$3"
}

# Prints what is wrong with an ELF file, a line each; nothing if all is well.
elf_problems() { # FILE ABI STUB-LISTS SIZE-LIMIT
    local file=$1 abi=$2 lists=$3 limit=$4 headers dynamic symbols names allowed index binding name align stripped size
    headers=$(llvm-readelf -h -lW "$file")
    dynamic=$(llvm-readelf -d "$file")
    symbols=$(llvm-readelf --dyn-symbols -W "$file" | awk '$1 ~ /^[0-9]+:$/ && $8 != "" {sub(/@.*/, "", $8); print $7, $5, $8}')

    grep -q "Machine: *$(machine "$abi")\$" <<<"$headers" || echo "it is not for $abi"
    # What Java sees, and nothing that could clash with another library's symbols.
    names=$(awk '$1 != "UND" {print $3}' <<<"$symbols" | sort | tr '\n' ' ')
    [ "$names" = "JNI_OnLoad " ] || echo "exported symbols: ${names:-none }(should be JNI_OnLoad alone)"
    for name in $(sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' <<<"$dynamic"); do
        case $name in
        libc.so | libm.so | libdl.so | liblog.so | libandroid.so | libjnigraphics.so) ;;
        *) echo "it needs $name, which not every phone has or lets an app open" ;;
        esac
    done
    # The linker has checked the strong ones; weak ones may be missing on old phones, so each must be known to cope.
    allowed=$(for list in "$lists"/lib*.txt; do symbols "$list" "$abi"; done | sort -u)
    while read -r index binding name; do
        [ "$index" = UND ] || continue
        if [ "$binding" = WEAK ]; then
            symbols "$lists/weak.txt" "$abi" | grep -qxF "$name" || echo "weak symbol $name is not in stubs/weak.txt"
        else
            grep -qxF "$name" <<<"$allowed" || echo "symbol $name is not in stubs/lib*.txt (API $api)"
        fi
    done <<<"$symbols"
    for align in $(awk '$1 == "LOAD" {print $NF}' <<<"$headers"); do
        [ $((align)) -ge $((page)) ] || echo "a segment is aligned to $align (should be $page)"
    done
    grep -q '(HASH)' <<<"$dynamic" || echo "no HASH table, the only one that Android 5 reads"
    ! grep -Eq '^ *TLS ' <<<"$headers" || echo "it has a TLS segment (needs API 29)"
    ! grep -Eq '\(TEXTREL\)|FLAGS.*TEXTREL' <<<"$dynamic" || echo "it has text relocations (refused since API 23)"
    ! grep -Eq '\((ANDROID_)?RELR\)' <<<"$dynamic" || echo "it has RELR relocations (needs API 28)"
    ! grep -Eq '\(ANDROID_RELA?\)' <<<"$dynamic" || echo "it has packed relocations (needs API 23)"
    ! awk '$1 == "GNU_STACK"' <<<"$headers" | grep -q 'RWE' || echo "its stack is executable"
    grep -q '(SONAME).*\[librarefy_jni.so\]' <<<"$dynamic" || echo "its SONAME is not librarefy_jni.so"
    stripped=$(mktemp)
    llvm-strip -o "$stripped" "$file"
    size=$(wc -c <"$stripped")
    rm -f "$stripped"
    [ "$size" -le "$limit" ] || echo "stripped it has $size bytes (limit $limit)"
}

# Crates that a phone must not carry, in a list of crates on stdin.
desktop_crates() {
    grep -E '^(clap|clap_builder|clap_derive|indicatif|console|winit|softbuffer|minifb|egui|eframe) ' | sort -u || true
}

tree() { # PACKAGE RUST-TARGET
    cargo tree --quiet --package "$1" --target "$2" --edges normal --prefix none
}

# Every check must be able to fail: small libraries, each with one thing wrong.
self_check() {
    local abi dir good
    for abi in $abis; do
        dir=$work/self-check/$abi
        rm -rf "$dir"
        make_stubs "$abi" android/stubs "$dir/stubs"
        make_linker "$abi" "$dir/stubs" "$dir/cc"
        cat >"$dir/good.c" <<'EOT'
void *malloc(__SIZE_TYPE__);
__attribute__((visibility("default"))) int JNI_OnLoad(void *vm, void *unused) { return malloc(8) ? 0x10006 : -1; }
EOT
        good="-shared -fPIC -O1 -fno-builtin -fvisibility=hidden -Wl,--soname=librarefy_jni.so"
        (
            cd "$dir"
            { cat good.c; echo '__attribute__((visibility("default"))) int extra(void) { return 1; }'; } >export.c
            { cat good.c; echo '__thread int counter; __attribute__((used)) static int *tls(void) { return &counter; }'; } >tls.c
            { cat good.c; echo 'extern int getrandom(void) __attribute__((weak)); extern int memfd_create(void) __attribute__((weak));'
                echo '__attribute__((used)) static int weak(void) { return getrandom ? getrandom() : memfd_create ? 1 : 0; }'; } >weak.c
            echo 'int elsewhere(void) { return 1; }' >elsewhere.c
            { cat good.c; echo 'int elsewhere(void); __attribute__((used)) static int call(void) { return elsewhere(); }'; } >needs.c
            { cat good.c; echo '__asm__(".text\n.globl hidden_\n.hidden hidden_\nhidden_: .dc.a malloc");'; } >text.c
        )
        link() { (cd "$dir" && ./cc $good "$@" -lc) >"$dir/log" 2>&1; }
        must_pass() {
            link -o good.so good.c || fail "self-check, $abi: a sound library does not link: $(cat "$dir/log")"
            local problems
            problems=$(elf_problems "$dir/good.so" "$abi" android/stubs $size_limit)
            [ -z "$problems" ] || fail "self-check, $abi: a sound library is refused: $problems"
        }
        must_find() { # TEXT LIMIT LINKER-ARGUMENTS...
            local text=$1 limit=$2 problems
            shift 2
            link -o bad.so "$@" || fail "self-check, $abi: the library to be refused does not link: $(cat "$dir/log")"
            problems=$(elf_problems "$dir/bad.so" "$abi" android/stubs "$limit")
            grep -q -- "$text" <<<"$problems" || fail "self-check, $abi: not noticed: $text (got: ${problems:-nothing})"
        }
        must_pass
        must_find "exported symbols" $size_limit export.c
        must_find "aligned to" $size_limit good.c -Wl,-z,max-page-size=4096
        must_find "no HASH" $size_limit good.c -Wl,--hash-style=gnu
        must_find "SONAME" $size_limit good.c -Wl,--soname=other.so
        must_find "stripped it has" 100 good.c
        must_find "weak symbol memfd_create" $size_limit weak.c
        must_find "RELR\|packed" $size_limit text.c -Wl,-z,notext -Wl,--pack-dyn-relocs=android
        [ "$abi" = armeabi-v7a ] || must_find "TLS" $size_limit tls.c -fno-emulated-tls -ftls-model=initial-exec
        must_find "text relocations" $size_limit text.c -Wl,-z,notext
        must_find "executable" $size_limit good.c -Wl,-z,execstack
        (cd "$dir" && ./cc -shared -fPIC -Wl,--soname=libelsewhere.so -o libelsewhere.so elsewhere.c)
        must_find "needs libelsewhere.so" $size_limit needs.c -L. -lelsewhere
        # One symbol less in a stub list: the link itself must fail, and say which.
        mkdir -p "$dir/fewer"
        cp android/stubs/*.txt "$dir/fewer"
        sed -i '/^malloc$/d' "$dir/fewer/libc.txt"
        make_stubs "$abi" "$dir/fewer" "$dir/stubs"
        ! link -o bad.so good.c || fail "self-check, $abi: a symbol that is in no stub list does link"
        grep -q 'undefined symbol: malloc' "$dir/log" || fail "self-check, $abi: no word of malloc: $(cat "$dir/log")"
    done
    say "self-check: every check notices what it is there for"
}

library_file() { echo "$work/$(rust_target "$1")/release/librarefy_jni.so"; }
probe_file() { echo "$work/$(rust_target "$1")/release/examples/libguard_probe.so"; }

build() {
    local abi variable targets=()
    fetch_unwinder
    for abi in $abis; do
        rm -rf "$work/stubs/$abi"
        make_stubs "$abi" android/stubs "$work/stubs/$abi"
        make_unwinder "$abi" "$work/unwind/$abi"
        make_linker "$abi" "$work/stubs/$abi" "$work/cc-$abi" "$work/unwind/$abi"
        variable=CARGO_TARGET_$(rust_target "$abi" | tr 'a-z-' 'A-Z_')_LINKER
        export "$variable=$work/cc-$abi"
        targets+=(--target "$(rust_target "$abi")")
    done
    # The standard library without what turns addresses into names of functions: the file that ships is stripped of them.
    cargo build --quiet --release --package rarefy-jni --lib --example guard_probe -Zbuild-std -Zbuild-std-features=panic-unwind \
        --target-dir "$work" "${targets[@]}"
}

check_files() {
    local abi file problems bad=0
    for abi in $abis; do
        file=$(library_file "$abi")
        problems=$(elf_problems "$file" "$abi" android/stubs $size_limit)
        llvm-strip -o "$file.stripped" "$file"
        say "$abi: $(wc -c <"$file.stripped") bytes stripped; needs $(llvm-readelf -d "$file" |
            sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | tr '\n' ' ')"
        [ -z "$problems" ] || { say "$problems" | sed "s|^|$abi: |" >&2; bad=1; }
    done
    [ $bad = 0 ] || fail "librarefy_jni.so is not fit for Android $api"
}

check_tree() {
    local abi found
    for abi in $abis; do
        tree rarefy-jni "$(rust_target "$abi")" >"$work/tree"
        found=$(desktop_crates <"$work/tree")
        [ -z "$found" ] || fail "crates of the desktop in the library for $abi: $found"
        say "$abi: $(sort -u "$work/tree" | wc -l) crates, none of the desktop's"
    done
    # The control: the desktop command has them.
    [ -n "$(tree rarefy x86_64-unknown-linux-gnu | desktop_crates)" ] || fail "the search for the desktop's crates finds none where they are"
}

run_files() {
    local abi jobs=() at=0
    need_packages "running the files" qemu-user || fail "running the files needs qemu-user"
    java_for_qemu
    draw_on_desktop
    for abi in $abis; do
        fetch_foreign_java "$abi"
        make_stand_ins "$abi"
    done
    # All at once: for most of its time a Java VM under qemu keeps one core busy.
    for abi in $abis; do
        run_in_qemu "$abi" &
        jobs+=($!)
    done
    for abi in $abis; do
        wait "${jobs[at]}" || fail "$abi: librarefy_jni.so fails in a Java VM; the reason is above"
        at=$((at + 1))
    done
}

need_rust
desktop_path=$PATH # where the desktop's Rust is: another one would build all of the desktop's library again
need_packages "the Android check" clang lld llvm || fail "the Android check needs clang, lld and llvm"
have javac || need_packages "the Android check" default-jdk-headless || fail "the Android check needs a JDK"
mkdir -p "$work"
case ${1-} in
"")
    section "Android: self-check" self_check
    need_rust_with_source "the Android check"
    section "Android: build ($("$RUSTC" --version))" build
    section "Android: ELF files" check_files
    section "Android: crates" check_tree
    section "Android: the files in a Java VM of each ABI" run_files
    section "Android: Java" check_java
    section "Android: AAR" check_aar
    section "Android: demo app" check_demo
    ;;
--self-check) section "Android: self-check" self_check ;;
--aar)
    need_rust_with_source "the Android check"
    section "Android: build ($("$RUSTC" --version))" build
    section "Android: the Java library" java_library
    section "Android: AAR" check_aar
    ;;
--apk)
    need_rust_with_source "the Android check"
    section "Android: build ($("$RUSTC" --version))" build
    section "Android: the Java library" java_library
    section "Android: demo app" check_demo
    ;;
*) fail "usage: android/check.sh [--self-check | --aar | --apk]" ;;
esac
