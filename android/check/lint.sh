# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# Android Lint on the demo app and the library. Sourced by android/check.sh.

android_lint=com.android.tools.lint:lint:32.5.1

# Prints the description that Lint wants of a project; every Java file by its name, since it ignores folders without a word.
lint_project() { # DEMO-FOLDER
    local file
    echo '<?xml version="1.0" encoding="utf-8"?><project>'
    echo "<module name=\"demo\" android=\"true\" compile-sdk-version=\"34\" min-sdk-version=\"$min_sdk\" target-sdk-version=\"$target_sdk\">"
    # The merged one, which has the versions.
    echo "<manifest file=\"$work/demo/merged.xml\"/>"
    find "$1/src/main/res" -type f | LC_ALL=C sort | sed 's|.*|<resource file="&"/>|'
    find "$1/src/main/java" "$PWD/$main_java" -name '*.java' | LC_ALL=C sort | sed 's|.*|<src file="&"/>|'
    for file in "$(artifact $jspecify)" "$(artifact $android_all)"; do echo "<classpath jar=\"$file\"/>"; done
    echo '</module></project>'
}

run_lint() { # DEMO-FOLDER OUT
    mkdir -p "$2/home"
    lint_project "$1" >"$2/project.xml"
    # It writes a folder into the home folder.
    java -Xmx1g -Duser.home="$2/home" -cp "$(tool_path $android_lint)" com.android.tools.lint.Main --offline --project "$2/project.xml" \
        --config "$PWD/$demo/lint.xml" --text "$2/findings" -Werror --exitcode >"$2/log" 2>&1
}

check_lint() {
    local out=$work/demo/lint bad
    rm -rf "$out"
    run_lint "$PWD/$demo" "$out" || fail "Android Lint: $(cat "$out/findings" "$out/log")"
    grep -q 'No issues found' "$out/findings" || fail "Android Lint says nothing: $(cat "$out/findings" "$out/log")"
    # The control: a copy with a picture that nobody describes, a word in a layout, and a text that nothing uses.
    bad=$out/bad/demo
    mkdir -p "$bad/src/main/res/layout"
    cp -r "$demo/src" "$bad"
    cat >"$bad/src/main/res/layout/broken.xml" <<'EOX'
<LinearLayout xmlns:android="http://schemas.android.com/apk/res/android" android:layout_width="match_parent" android:layout_height="match_parent">
    <ImageView android:layout_width="48dp" android:layout_height="48dp" />
    <TextView android:layout_width="wrap_content" android:layout_height="wrap_content" android:text="Hello" />
</LinearLayout>
EOX
    ! run_lint "$bad" "$out/bad" || fail "Android Lint finds nothing in a broken app"
    for bad in ContentDescription HardcodedText UnusedResources; do
        grep -q "\[$bad\]" "$out/bad/findings" || fail "Android Lint misses $bad: $(cat "$out/bad/findings")"
    done
    say "Android Lint: no findings; in a broken copy it has some"
}
