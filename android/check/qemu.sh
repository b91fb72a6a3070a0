# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# Runs the very files that ship in a Java VM of each ABI under qemu: glibc and stand-ins of android/qemu take bionic's place, so this
# tests the files' own code, relocations and unwinding, and not bionic. Sourced by android/check.sh.

# As often a scene is opened, drawn and closed.
rounds=1000

debian_architecture() { case $1 in arm64-v8a) echo arm64 ;; armeabi-v7a) echo armel ;; x86_64) echo amd64 ;; esac; }
gnu_target() { case $1 in arm64-v8a) echo aarch64-linux-gnu ;; armeabi-v7a) echo arm-linux-gnueabi ;; x86_64) echo x86_64-linux-gnu ;; esac; }
# Android's calls pass floats in integer registers, as Debian's armel does and armhf does not.
qemu_binary() { case $1 in arm64-v8a) echo qemu-aarch64 ;; armeabi-v7a) echo qemu-arm ;; x86_64) echo qemu-x86_64 ;; esac; }
foreign_packages() {
    case $1 in
    arm64-v8a | x86_64) echo openjdk-17-jre-headless openjdk-17-jre-zero libc6 libgcc-s1 libstdc++6 zlib1g ;;
    armeabi-v7a) echo openjdk-17-jre-headless libc6 libgcc-s1 libstdc++6 libatomic1 zlib1g ;;
    esac
}

# Unpacks a Java VM of another architecture into a folder, with an apt state of its own: this machine's packages and
# architectures stay as they are.
fetch_foreign_java() { # ABI
    local abi=$1 folder architecture options
    folder=$work/qemu/$abi
    architecture=$(debian_architecture "$abi")
    [ ! -d "$folder/root" ] || return 0
    rm -rf "$folder"
    mkdir -p "$folder/lists/partial" "$folder/cache/archives/partial" "$folder/unpacked"
    : >"$folder/status"
    options=(-qq -o "APT::Architecture=$architecture" -o "APT::Architectures=$architecture" -o "Dir::State::Lists=$folder/lists"
        -o "Dir::State::status=$folder/status" -o "Dir::Cache=$folder/cache" -o APT::Sandbox::User=root)
    apt-get "${options[@]}" update
    # shellcheck disable=SC2046 # several words are meant
    (cd "$folder" && apt-get "${options[@]}" download $(foreign_packages "$abi"))
    local package
    for package in "$folder"/*.deb; do dpkg -x "$package" "$folder/unpacked"; done
    # Its list of Java VMs is a link to a file of a machine that it is installed on.
    for package in "$folder"/unpacked/usr/lib/jvm/*/lib; do
        rm -f "$package/jvm.cfg"
        printf '%s\n' '-server KNOWN' '-zero KNOWN' >"$package/jvm.cfg"
    done
    rm -rf "$folder"/*.deb "$folder/lists" "$folder/cache"
    mv "$folder/unpacked" "$folder/root"
}

make_stand_ins() { # ABI
    local abi=$1 folder=$work/qemu/$1/stand-ins root=$work/qemu/$1/root libc libm compile
    libc=$(find "$root" -name libc.so.6 | head -n 1)
    libm=$(find "$root" -name libm.so.6 | head -n 1)
    [ -n "$libc" ] && [ -n "$libm" ] || fail "no libc in $root"
    mkdir -p "$folder"
    compile=(clang "--target=$(gnu_target "$abi")" -O1 -fPIC -shared -nostdlib -fno-builtin -fuse-ld=lld -w)
    : >"$folder/empty.c"
    "${compile[@]}" -Wl,-soname,libc.so -o "$folder/libc.so" android/qemu/libc.c "$libc" 2>/dev/null
    "${compile[@]}" -Wl,-soname,libdl.so -o "$folder/libdl.so" "$folder/empty.c" "$libc"
    "${compile[@]}" -Wl,-soname,libm.so -Wl,--no-as-needed -o "$folder/libm.so" "$folder/empty.c" "$libm"
    "${compile[@]}" -Wl,-soname,libandroid.so -o "$folder/libandroid.so" android/qemu/targets.c "$libc" 2>/dev/null
    "${compile[@]}" -Wl,-soname,libjnigraphics.so -o "$folder/libjnigraphics.so" android/qemu/targets.c "$libc" 2>/dev/null
    "${compile[@]}" '-DVARIABLE="RAREFY_LIBRARY"' -o "$folder/load_library.so" android/qemu/loader.c "$libc"
    "${compile[@]}" '-DVARIABLE="RAREFY_PROBE"' -o "$folder/load_probe.so" android/qemu/loader.c "$libc"
}

# Compiles the library, its tests and the fakes of Android's classes.
java_for_qemu() {
    local classes=$work/qemu/classes
    rm -rf "$classes"
    mkdir -p "$classes"
    find android/library/annotations android/library/src -name '*.java' -print0 |
        xargs -0 javac --release 8 -Xlint:all,-options,-try -Werror -d "$classes"
}

in_qemu() { # ABI CLASS ARGUMENTS...
    local abi=$1 class=$2 root=$work/qemu/$1/root folder=$work/qemu/$1/stand-ins java vm
    shift 2
    java=$(find "$root" -path '*/bin/java' | head -n 1)
    # A Java VM without a compiler of its own, where there is one: qemu compiles already.
    vm=-zero
    [ "$abi" != armeabi-v7a ] || vm=-server
    RAREFY_LIBRARY=$(library_file "$abi") RAREFY_PROBE=$(probe_file "$abi") \
        timeout 1200 "$(qemu_binary "$abi")" -L "$root" -E "LD_LIBRARY_PATH=$folder" "$java" $vm -Xmx256m -XX:+UseSerialGC \
        -Xshare:off -Dfile.encoding=UTF-8 "-Ddev.rarefy.library=$folder/load_library.so" \
        "-Ddev.rarefy.probe=$folder/load_probe.so" -cp "$work/qemu/classes" "dev.rarefy.$class" "$@"
}

run_in_qemu() { # ABI
    local abi=$1 out=$work/qemu/$1/pictures output class name start
    rm -rf "$out"
    mkdir -p "$out"
    for class in "PictureTest cpu $work/qemu/spheres $work/qemu/spheres.baked $out" GuardProbe TargetTest "MisuseTest $out" \
        "ThreadsTest cpu $rounds"; do
        start=$SECONDS
        # shellcheck disable=SC2086 # the class and its arguments
        output=$(in_qemu "$abi" $class 2>&1) || fail "$abi: $class: $output"
        grep -qx done <<<"$output" || fail "$abi: $class did not come to its end: $output"
        say "$abi: ${class%% *}: as it should be, in $((SECONDS - start)) s"
    done
    for name in balanced fast paper full; do
        cmp "$out/$name" "$work/qemu/desktop/$name" || fail "$abi: the picture $name is not the desktop's"
    done
    say "$abi: four pictures are the desktop's, byte for byte"
}

# The desktop's pictures, to compare with.
draw_on_desktop() {
    need_desktop_library
    rm -rf "$work/qemu/spheres" "$work/qemu/desktop"
    mkdir -p "$work/qemu/desktop"
    target/debug/rarefy make-scene spheres -o "$work/qemu/spheres" >/dev/null
    target/debug/rarefy bake "$work/qemu/spheres" -o "$work/qemu/spheres.baked" >/dev/null
    java -Xmx512m "-Ddev.rarefy.library=$(desktop_library)" -cp "$work/qemu/classes" dev.rarefy.PictureTest cpu \
        "$work/qemu/spheres" "$work/qemu/spheres.baked" "$work/qemu/desktop" | grep -qx done || fail "the desktop does not draw"
}
