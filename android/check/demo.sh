# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# Makes the demo app's package (APK) and bundle (AAB) without an SDK, and checks them. Sourced by android/check.sh.

bundletool=com.android.tools.build:bundletool:1.18.3

demo=android/demo
demo_package=dev.rarefy.demo
demo_version_code=1
# The scenes among the app's assets, written by `rarefy make-scene`.
demo_scenes="kitchen bathroom"
apk_limit=$((25 * 1024 * 1024))

demo_sources() { find "$demo/src/main/java" -name '*.java' | LC_ALL=C sort; }
logic_sources() { find "$1/src/main/java/dev/rarefy/demo/logic" -name '*.java' | LC_ALL=C sort; }

# The manifest that an app's build makes of the app's own and the library's.
demo_manifest() { # FOLDER
    library_manifest "$1/library.xml"
    merge_manifests "$demo/src/main/AndroidManifest.xml" "$1/library.xml" "$1/merged.xml" "$1/merge.log" $demo_package $min_sdk \
        "$demo_version_code" "$(rarefy_version)" || fail "the app's manifest does not merge: $(cat "$1/merge.log")"
    # The libraries are read from the package itself, as Gradle arranges it.
    sed -i 's|<application|<application android:extractNativeLibs="false"|' "$1/merged.xml"
}

# Resources linked with the manifest: base.apk, R.java in gen/, and rules that keep what the XML names.
demo_resources() { # FOLDER [LINK-OPTION...]
    local out=$1
    shift
    mkdir -p "$out"
    demo_manifest "$out"
    "$work/tools/aapt2" compile --dir "$demo/src/main/res" -o "$out/res.zip" >"$out/link.log" 2>&1 &&
        "$work/tools/aapt2" link -I "$(artifact $android_all)" --manifest "$out/merged.xml" -o "$out/base.apk" --java "$out/gen" \
            --proguard "$out/resources.pro" --auto-add-overlay "$@" "$out/res.zip" >"$out/link.log" 2>&1 ||
        fail "the app's resources: $(cat "$out/link.log")"
}

demo_assets() { # FOLDER; by the command $rarefy
    local scene
    rm -rf "$1"
    mkdir -p "$1"
    for scene in $demo_scenes; do "$rarefy" make-scene "$scene" -o "$1/$scene" >/dev/null; done
}

# Code without widgets is compiled without Android, so that a desktop can run it.
compile_logic() { # DEMO OUT
    local sources
    mapfile -t sources < <(logic_sources "$1")
    [ ${#sources[@]} -gt 0 ] || fail "no Java file in $1's logic"
    mkdir -p "$2"
    javac --release 8 -Xlint:-options -proc:none -cp "$work/java/classes:$(artifact $jspecify)" -d "$2" "${sources[@]}" >"$2/log" 2>&1
}

demo_java() {
    local out=$work/demo sources
    mapfile -t sources < <(demo_sources)
    careful_javac "$out/classes" "$work/java/classes" "${sources[@]}" "$out/gen/${demo_package//.//}/R.java" 2>"$out/warnings" ||
        fail "the app does not compile carefully: $(cat "$out/warnings")"
    ! grep -q 'warning:' "$out/warnings" || fail "the app compiles with warnings: $(cat "$out/warnings")"
    compile_logic "$demo" "$out/logic" || fail "the app's logic needs Android: $(cat "$out/logic/log")"
    # The control: a class of Android's in it is noticed.
    rm -rf "$out/bad-logic"
    mkdir -p "$out/bad-logic/src/main/java/dev/rarefy/demo"
    cp -r "$demo/src/main/java/dev/rarefy/demo/logic" "$out/bad-logic/src/main/java/dev/rarefy/demo"
    echo 'package dev.rarefy.demo.logic; final class Bad { android.view.View view; }' \
        >"$out/bad-logic/src/main/java/dev/rarefy/demo/logic/Bad.java"
    ! compile_logic "$out/bad-logic" "$out/bad-logic/out" || fail "a view among the app's logic is not noticed"
    grep -q 'android.view' "$out/bad-logic/out/log" || fail "a view is refused for another reason: $(cat "$out/bad-logic/out/log")"

    # With the library's classes beside them, which are Android's as little as these.
    rm -rf "$out/sniffed"
    mkdir -p "$out/sniffed"
    cp -r "$work/java/classes"/. "$out/classes"/. "$out/sniffed"
    sniff "$out/sniffed" "$out/sniff.log" || fail "the app needs more than API $min_sdk: $(cat "$out/sniff.log")"
    # The controls: what is newer is noticed, unless it is marked as newer.
    mkdir -p "$out/newer/out"
    echo 'class New { @MARK Object name(android.content.Context c) { return c.getMainExecutor(); } }' >"$out/newer/New.java"
    sed -i.bak 's/@MARK //' "$out/newer/New.java"
    javac --release 8 -Xlint:-options -proc:none -cp "$(artifact $android_all)" -d "$out/newer/out" "$out/newer/New.java"
    ! sniff "$out/newer/out" "$out/sniff.log" || fail "a call of API 28 is not noticed"
    grep -q getMainExecutor "$out/sniff.log" || fail "no word of getMainExecutor: $(cat "$out/sniff.log")"
    sed 's/@MARK/@android.annotation.TargetApi(28)/' "$out/newer/New.java.bak" >"$out/newer/New.java"
    javac --release 8 -Xlint:-options -proc:none -cp "$(artifact $android_all)" -d "$out/newer/out" "$out/newer/New.java"
    sniff "$out/newer/out" "$out/sniff.log" || fail "a call marked as newer is refused: $(cat "$out/sniff.log")"
    say "the app's code: no mistakes found, logic apart from Android, API $min_sdk but for $(
        cat "${sources[@]}" | grep -c '@TargetApi' || true) marked places"
}

# The app's and the library's code, shrunk as a release is.
demo_dex() { # FOLDER
    local out=$1 rules=() file
    for file in android/library/consumer-rules.pro "$work/demo/resources.pro" "$demo/proguard-rules.pro"; do
        [ ! -f "$file" ] || rules+=(--pg-conf "$file")
    done
    rm -rf "$out"
    mkdir -p "$out"
    zip_folder "$work/java/classes" "$work/demo/library.jar"
    zip_folder "$work/demo/classes" "$work/demo/app.jar"
    java -Xmx1500m -cp "$(artifact $r8)" com.android.tools.r8.R8 --release --min-api $min_sdk --lib "$(jdk_home)" \
        --lib "$(artifact $android_all)" "${rules[@]}" --pg-map-output "$work/demo/mapping.txt" --output "$out" "$work/demo/library.jar" \
        "$work/demo/app.jar" >"$work/demo/r8.log" 2>&1 || fail "R8: $(cat "$work/demo/r8.log")"
    find "$out" -name '*.dex' -exec touch -d 2020-01-01T00:00:00Z {} +
}

demo_libraries() { # FOLDER: lib/ABI/librarefy_jni.so
    local abi
    rm -rf "$1"
    for abi in $abis; do
        mkdir -p "$1/lib/$abi"
        llvm-strip -o "$1/lib/$abi/librarefy_jni.so" "$(library_file "$abi")"
    done
    find "$1" -exec touch -d 2020-01-01T00:00:00Z {} +
}

# A key that nobody else has, for this folder of build results alone.
throw_away_key() {
    [ -f "$work/demo/key.p12" ] ||
        keytool -genkeypair -keystore "$work/demo/key.p12" -storetype PKCS12 -storepass throwaway -alias key -keyalg RSA -keysize 2048 \
            -validity 30 -dname "CN=Rarefy check, O=not for release" >"$work/demo/key.log" 2>&1 || fail "no key: $(cat "$work/demo/key.log")"
}

sign_apk() { # IN OUT
    apksigner sign --ks "$work/demo/key.p12" --ks-pass pass:throwaway --ks-key-alias key --min-sdk-version $min_sdk \
        --v4-signing-enabled false --in "$1" --out "$2"
}

# Resources, code and native libraries in one package, not yet signed; what is stored lies on 16 KiB.
assemble_apk() { # DEX-FOLDER LIBRARY-FOLDER OUT [ZIP-OPTION-OF-LIBRARIES [ALIGNMENT]]
    local part=$3.part
    cp "$work/demo/base.apk" "$part"
    (cd "$1" && TZ=UTC zip -q -X "$part" ./*.dex)
    (cd "$2" && find lib -type f | LC_ALL=C sort | TZ=UTC zip -q "${4--0}" -X -@ "$part")
    zipalign -f "${5-16384}" "$part" "$3"
    rm "$part"
}

# What is wrong with a package's files, a line each; nothing if all is well.
apk_file_problems() { # APK SIZE-LIMIT
    local list size abi scene
    size=$(wc -c <"$1")
    [ "$size" -le "$2" ] || echo "it has $size bytes (limit $2)"
    list=$(unzip -v "$1")
    for abi in $abis; do
        grep -q "Stored .* lib/$abi/librarefy_jni.so\$" <<<"$list" || echo "lib/$abi/librarefy_jni.so is not there, or not stored"
        unzip -p "$1" "lib/$abi/librarefy_jni.so" 2>/dev/null | cmp -s - "$work/demo/libraries/lib/$abi/librarefy_jni.so" ||
            echo "lib/$abi/librarefy_jni.so is not the stripped library"
    done
    # Refused by Android 11 and later if it is compressed.
    grep -q 'Stored .* resources.arsc$' <<<"$list" || echo "resources.arsc is not stored"
    grep -q ' classes.dex$' <<<"$list" || echo "there is no classes.dex"
    for scene in $demo_scenes; do
        unzip -p "$1" "assets/$scene/scene.obj" 2>/dev/null | cmp -s - "$work/demo/assets/$scene/scene.obj" || echo "no scene $scene"
        grep -q " assets/$scene/view.json\$" <<<"$list" || echo "no view of $scene"
    done
    zipalign -c -v 16384 "$1" | grep -E '\(BAD' | sed 's/^/not aligned: /' || true
}

apk_signature_problems() { # APK
    local text
    text=$(apksigner verify --verbose --min-sdk-version $min_sdk "$1" 2>&1) || { echo "its signature does not verify: $text"; return 0; }
    grep -q 'Verified using v2 scheme.*true' <<<"$text" || echo "no v2 signature"
    # Android 6 knows no other.
    grep -q 'Verified using v1 scheme.*true' <<<"$text" || echo "no v1 signature"
}

dex_problems() { # DEX
    local classes class
    [ "$(head -c 7 "$1" | tr -d '\n')" = dex035 ] || echo "$(basename "$1") is not DEX 035, all that Android 6 reads"
    classes=$(dexdump "$1" | sed -n "s/^  Class descriptor  : '\(.*\)'/\1/p")
    for class in demo/MainActivity Native RayTracerException FrameStats; do
        grep -qx "Ldev/rarefy/$class;" <<<"$classes" || echo "no class dev.rarefy.${class//\//.}"
    done
    dexdump "$1" | grep -A3 "name *: 'renderSurface'" | grep -q NATIVE || echo "no native method renderSurface"
}

badging_problems() { # BADGING
    local part
    for part in "package: name='$demo_package' versionCode='$demo_version_code' versionName='$(rarefy_version)'" \
        "sdkVersion:'$min_sdk'" "targetSdkVersion:'$target_sdk'" "launchable-activity: name='$demo_package.MainActivity'" \
        "uses-native-library-not-required:'libOpenCL.so'" "uses-native-library-not-required:'libOpenCL-pixel.so'" \
        "uses-native-library-not-required:'libOpenCL-car.so'" "supports-any-density: 'true'"; do
        grep -qF "$part" <<<"$1" || echo "its manifest does not say $part"
    done
    for part in $abis; do grep "^native-code:" <<<"$1" | grep -q "'$part'" || echo "no native code of $part"; done
    # Nothing that a user must grant, and no look into a release by a debugger.
    ! grep -E '^uses-permission|^application-debuggable' <<<"$1" || true
}

# must_find TEXT COMMAND...: a check that is there for TEXT finds it.
must_find_text() {
    local text=$1 found
    shift
    found=$("$@" 2>&1) || true
    grep -q -- "$text" <<<"$found" || fail "control: not noticed: $text (got: ${found:-nothing})"
}

# Broken packages, each with one thing wrong.
apk_controls() { # APK BADGING
    local apk=$1 badging=$2 out=$work/demo/controls bad=$work/demo/controls/bad.apk
    rm -rf "$out"
    mkdir -p "$out/dex"
    must_find_text "it has .* bytes" apk_file_problems "$apk" 1000
    assemble_apk "$work/demo/dex" "$work/demo/libraries" "$bad" -6
    must_find_text "arm64-v8a/librarefy_jni.so is not there, or not stored" apk_file_problems "$bad" $apk_limit
    must_find_text "DOES NOT VERIFY" apk_signature_problems "$bad"
    assemble_apk "$work/demo/dex" "$work/demo/libraries" "$bad" -0 4
    must_find_text "not aligned: .*librarefy_jni.so" apk_file_problems "$bad" $apk_limit
    cp "$apk" "$bad"
    zip -q -d "$bad" "assets/${demo_scenes%% *}/scene.obj" classes.dex lib/armeabi-v7a/librarefy_jni.so
    must_find_text "no scene ${demo_scenes%% *}" apk_file_problems "$bad" $apk_limit
    must_find_text "no classes.dex" apk_file_problems "$bad" $apk_limit
    must_find_text "armeabi-v7a/librarefy_jni.so is not the stripped" apk_file_problems "$bad" $apk_limit
    # Changed after it was signed.
    must_find_text "does not verify" apk_signature_problems "$bad"
    java -cp "$(artifact $r8)" com.android.tools.r8.D8 --release --min-api 30 --lib "$(jdk_home)" --lib "$(artifact $android_all)" \
        --output "$out/dex" "$work/demo/library.jar" >"$out/d8.log" 2>&1 || fail "D8: $(cat "$out/d8.log")"
    must_find_text "no class dev.rarefy.demo.MainActivity" dex_problems "$out/dex/classes.dex"
    must_find_text "not DEX 035" dex_problems "$out/dex/classes.dex"
    must_find_text "uses-permission: name='android.permission.INTERNET'" badging_problems "$badging
uses-permission: name='android.permission.INTERNET'"
    must_find_text "does not say targetSdkVersion" badging_problems "${badging/targetSdkVersion/}"
    must_find_text "no native code of armeabi-v7a" badging_problems "${badging//\'armeabi-v7a\'/}"
}

check_apk() {
    local out=$work/demo apk badging problems dex
    apk=$out/rarefy-demo-$(rarefy_version).apk
    throw_away_key
    demo_libraries "$out/libraries"
    demo_dex "$out/dex"
    assemble_apk "$out/dex" "$out/libraries" "$out/unsigned.apk"
    sign_apk "$out/unsigned.apk" "$apk"
    badging=$("$work/tools/aapt2" dump badging "$apk")
    problems=$(
        apk_file_problems "$apk" $apk_limit
        apk_signature_problems "$apk"
        for dex in "$out"/dex/*.dex; do dex_problems "$dex"; done
        badging_problems "$badging"
    )
    [ -z "$problems" ] || fail "the package is not fit: $problems"
    apk_controls "$apk" "$badging"
    say "$badging"
    say "dex: $(dexdump "$out"/dex/classes.dex | grep -c 'Class descriptor') classes, $(wc -c <"$out/dex/classes.dex") bytes"
    apksigner verify --verbose --min-sdk-version $min_sdk "$apk" | grep -E '^Verif|^Number'
    unzip -v "$apk"
    say "${apk#"$PWD"/}: $(wc -c <"$apk") bytes, verified (limit $apk_limit); signed with a throw-away key, for trying it out alone"
}

# The bundle, from which a shop makes the packages of each kind of phone.
check_bundle() {
    local out=$work/demo/bundle aab tool list abi
    aab=$work/demo/rarefy-demo-$(rarefy_version).aab
    tool=$(tool_path $bundletool)
    rm -rf "$out" "$aab"
    mkdir -p "$out/module/manifest" "$out/module/dex"
    "$work/tools/aapt2" link --proto-format -I "$(artifact $android_all)" --manifest "$work/demo/merged.xml" -o "$out/proto.apk" \
        --auto-add-overlay -A "$work/demo/assets" "$work/demo/res.zip" >"$out/log" 2>&1 || fail "the bundle's resources: $(cat "$out/log")"
    unzip -q "$out/proto.apk" -d "$out/module"
    mv "$out/module/AndroidManifest.xml" "$out/module/manifest"
    cp "$work/demo/dex"/*.dex "$out/module/dex"
    cp -r "$work/demo/libraries/lib" "$out/module/lib"
    zip_folder "$out/module" "$out/base.zip"
    bundle_tool() { java -Xmx1g -cp "$tool" com.android.tools.build.bundletool.BundleToolMain "$@" >"$out/log" 2>&1; }
    bundle_tool build-bundle "--modules=$out/base.zip" "--output=$aab" || fail "the bundle: $(cat "$out/log")"
    bundle_tool validate "--bundle=$aab" || fail "the bundle is not valid: $(cat "$out/log")"
    bundle_tool build-apks --mode=universal "--bundle=$aab" "--output=$out/app.apks" "--aapt2=$work/tools/aapt2" \
        "--ks=$work/demo/key.p12" --ks-pass=pass:throwaway --ks-key-alias=key || fail "packages of the bundle: $(cat "$out/log")"
    unzip -q "$out/app.apks" universal.apk -d "$out"
    [ -z "$(apk_signature_problems "$out/universal.apk")" ] || fail "the bundle's package: $(apk_signature_problems "$out/universal.apk")"
    # The libraries' lines alone: bundletool puts resources.arsc on 4 bytes, as is right, and this asks for 16 KiB of all.
    list=$(zipalign -c -v 16384 "$out/universal.apk" || true)
    for abi in $abis; do
        grep -q "lib/$abi/librarefy_jni.so (OK)" <<<"$list" || fail "the bundle's package has lib/$abi/librarefy_jni.so not on 16 KiB"
    done
    badging_problems "$("$work/tools/aapt2" dump badging "$out/universal.apk")" >"$out/log"
    [ ! -s "$out/log" ] || fail "the bundle's package: $(cat "$out/log")"
    # The control: a module without its manifest is no bundle.
    (cd "$out/module" && zip -q -d "$out/base.zip" manifest/AndroidManifest.xml)
    ! bundle_tool build-bundle "--modules=$out/base.zip" "--output=$out/bad.aab" || fail "a bundle without a manifest is taken"
    say "${aab#"$PWD"/}: $(wc -c <"$aab") bytes, valid; its package for all phones has $(wc -c <"$out/universal.apk") bytes and verifies"
}

check_demo() {
    local out=$work/demo
    need_packages "the demo app" zip unzip zipalign apksigner dexdump || fail "the demo app needs zip, unzip, zipalign, apksigner and dexdump"
    [ -f "$work/java/classes/dev/rarefy/RayTracer.class" ] || fail "the Java library must be compiled first"
    need_desktop_library
    rarefy=$PWD/target/debug/rarefy
    fetch_aapt2
    mkdir -p "$out"
    demo_assets "$out/assets"
    demo_assets "$out/assets-again"
    diff -r "$out/assets" "$out/assets-again" || fail "the scenes have other bytes when they are made again"
    rm -rf "$out/assets-again" "$out/gen"
    demo_resources "$out" -A "$out/assets"
    demo_java
    check_apk
    check_bundle
    check_lint
}
