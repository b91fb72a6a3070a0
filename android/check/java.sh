# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# Checks of the Java side with tools from Maven Central: nullness, common mistakes, format, API level, and a program in Kotlin.
# Sourced by android/check.sh.

# The versions are pinned: newer ones may not be served, or want a newer JDK than 17.
android_all=org.robolectric:android-all:14-robolectric-10818077
jspecify=org.jspecify:jspecify:1.0.0
error_prone=com.google.errorprone:error_prone_core:2.42.0
null_away=com.uber.nullaway:nullaway:0.14.3
java_format=com.google.googlejavaformat:google-java-format:1.28.0:jar:all-deps
kotlin=org.jetbrains.kotlin:kotlin-compiler-embeddable:2.2.21
kotlin_library=org.jetbrains.kotlin:kotlin-stdlib:2.2.21
api_signature_group=net.sf.androidscents.signature
api_signature_artifact=android-api-level-23
api_signature_version=6.0_r3

main_java=android/library/src/main/java
desktop_library() { echo "$PWD/target/debug/librarefy_jni.so"; }
# As cargo has it: an old one would be another library's.
need_desktop_library() { (unset RUSTC RUSTDOC RUSTC_BOOTSTRAP && PATH=$desktop_path cargo build --quiet --workspace); }

run_maven() {
    have mvn || need_packages "the Java checks" maven || fail "the Java checks need maven"
    mvn -B -ntp -q -Dstyle.color=never "$@"
}

# One file of Maven Central, by its coordinates; prints its path.
artifact() { # COORDINATES
    local folder=$work/maven/${1//:/_}
    if [ ! -d "$folder" ]; then
        rm -rf "$folder.part"
        run_maven org.apache.maven.plugins:maven-dependency-plugin:3.8.1:copy "-Dartifact=$1" "-DoutputDirectory=$folder.part" >&2
        mv "$folder.part" "$folder"
    fi
    ls "$folder"/*
}

# A tool with all that it needs; prints the class path.
tool_path() { # COORDINATES...
    local name folder coordinates group rest
    name=$(printf '%s_' "$@")
    folder=$work/maven/path_${name//:/_}
    if [ ! -f "$folder/path" ]; then
        mkdir -p "$folder"
        {
            echo '<project><modelVersion>4.0.0</modelVersion><groupId>a</groupId><artifactId>a</artifactId><version>1</version>'
            echo '<packaging>pom</packaging><dependencies>'
            for coordinates in "$@"; do
                group=${coordinates%%:*}
                rest=${coordinates#*:}
                echo "<dependency><groupId>$group</groupId><artifactId>${rest%%:*}</artifactId><version>${rest#*:}</version></dependency>"
            done
            echo '</dependencies></project>'
        } >"$folder/pom.xml"
        run_maven -f "$folder/pom.xml" org.apache.maven.plugins:maven-dependency-plugin:3.8.1:build-classpath \
            "-Dmdep.outputFile=$folder/path.part" >&2
        mv "$folder/path.part" "$folder/path"
    fi
    cat "$folder/path"
}

# javac with the plug-in that finds common mistakes and null where it may not be; its options, a line each.
careful_javac_options() { # PROCESSOR-PATH
    local name
    for name in api file main model parser processing tree util; do
        echo "-J--add-exports=jdk.compiler/com.sun.tools.javac.$name=ALL-UNNAMED"
    done
    for name in code comp; do echo "-J--add-opens=jdk.compiler/com.sun.tools.javac.$name=ALL-UNNAMED"; done
    printf '%s\n' -XDcompilePolicy=simple --should-stop=ifError=FLOW -processorpath "$1" \
        "-Xplugin:ErrorProne -Xep:NullAway:ERROR -XepOpt:NullAway:AnnotatedPackages=dev.rarefy"
}

careful_javac() { # OUT CLASSES-BESIDE FILE...
    local out=$1 beside=$2 options
    shift 2
    mapfile -t options < <(careful_javac_options "$(tool_path $error_prone $null_away)")
    rm -rf "$out"
    mkdir -p "$out"
    # The class file of jspecify names an element of Java 9, about which Java 8 warns.
    javac "${options[@]}" -source 8 -target 8 -Xlint:all,-options,-classfile -cp "$beside:$(artifact $jspecify):$(artifact $android_all)" \
        -d "$out" "$@"
}

# The library compiled as it ships: with the real annotations and Android's real classes.
java_library() {
    mkdir -p "$work/java"
    careful_javac "$work/java/classes" "" "$main_java"/dev/rarefy/*.java 2>"$work/java/warnings" ||
        fail "the library does not compile carefully: $(cat "$work/java/warnings")"
    ! grep -q 'warning:' "$work/java/warnings" || fail "the library compiles with warnings: $(cat "$work/java/warnings")"
}

nullness_control() {
    local bad=$work/java/bad/dev/rarefy
    mkdir -p "$bad"
    cat >"$bad/Bad.java" <<'EOT'
package dev.rarefy;
import org.jspecify.annotations.NullMarked;
import org.jspecify.annotations.Nullable;
@NullMarked
final class Bad {
  static int length(@Nullable String text) { return text.length(); }
}
EOT
    ! careful_javac "$work/java/bad/out" "" "$bad/Bad.java" 2>"$work/java/bad/log" || fail "a null that is used is not noticed"
    grep -q NullAway "$work/java/bad/log" || fail "a null that is used is refused for another reason: $(cat "$work/java/bad/log")"
}

check_format() {
    local options=() name files
    for name in api code file parser tree util; do
        options+=("--add-exports" "jdk.compiler/com.sun.tools.javac.$name=ALL-UNNAMED")
    done
    mapfile -t files < <(find android -name '*.java' -not -path '*/build/*')
    java "${options[@]}" -jar "$(artifact $java_format)" --dry-run --set-exit-if-changed "${files[@]}" >"$work/java/format" ||
        fail "not formatted by google-java-format: $(cat "$work/java/format")"
}

# Whether classes ask for something that API 23 does not have, but where they are marked as newer, as Android Lint reads it.
sniff() { # CLASSES LOG
    cat >"$work/java/sniff.xml" <<EOT
<project><modelVersion>4.0.0</modelVersion><groupId>a</groupId><artifactId>a</artifactId><version>1</version>
<build><outputDirectory>$1</outputDirectory><plugins><plugin><groupId>org.codehaus.mojo</groupId>
<artifactId>animal-sniffer-maven-plugin</artifactId><version>1.24</version><configuration><signature><groupId>$api_signature_group</groupId>
<artifactId>$api_signature_artifact</artifactId><version>$api_signature_version</version></signature>
<annotations><annotation>android.annotation.TargetApi</annotation></annotations></configuration></plugin></plugins></build></project>
EOT
    run_maven -f "$work/java/sniff.xml" org.codehaus.mojo:animal-sniffer-maven-plugin:1.24:check >"$2" 2>&1
}

check_api_level() {
    sniff "$work/java/classes" "$work/java/sniff.log" || fail "the library needs more than API 23: $(cat "$work/java/sniff.log")"
    mkdir -p "$work/java/new"
    echo 'class New { static Object list() { return java.util.List.of(1); } }' >"$work/java/New.java"
    javac --release 11 -d "$work/java/new" "$work/java/New.java"
    ! sniff "$work/java/new" "$work/java/sniff.log" || fail "a call of API 30 is not noticed"
    grep -q 'List.of' "$work/java/sniff.log" || fail "no word of List.of: $(cat "$work/java/sniff.log")"
}

compile_kotlin() { # OUT FILE
    java -cp "$(tool_path $kotlin $kotlin_library)" org.jetbrains.kotlin.cli.jvm.K2JVMCompiler -no-stdlib -no-reflect -jvm-target 1.8 \
        -Werror -cp "$work/java/classes:$(artifact $kotlin_library):$(artifact $jspecify):$(artifact $android_all)" -d "$1" "$2"
}

check_kotlin() {
    local out=$work/java/kotlin
    rm -rf "$out"
    compile_kotlin "$out" android/library/src/kotlin/Use.kt >"$work/java/kotlin.log" 2>&1 || fail "Kotlin: $(cat "$work/java/kotlin.log")"
    need_desktop_library
    java -Xmx512m "-Ddev.rarefy.library=$(desktop_library)" -cp "$out:$work/java/classes:$(artifact $kotlin_library)" dev.rarefy.app.UseKt \
        >"$work/java/kotlin.log" 2>&1 || fail "the program in Kotlin: $(cat "$work/java/kotlin.log")"
    grep -q '640x480 in ' "$work/java/kotlin.log" || fail "the program in Kotlin says nothing: $(cat "$work/java/kotlin.log")"
    # The controls: what may be null is not used unchecked.
    sed 's/stats()?\./stats()./' android/library/src/kotlin/Use.kt >"$work/java/Bad.kt"
    ! cmp -s android/library/src/kotlin/Use.kt "$work/java/Bad.kt" || fail "Use.kt asks nothing that may be null"
    ! compile_kotlin "$work/java/kotlin-bad" "$work/java/Bad.kt" >"$work/java/kotlin.log" 2>&1 || fail "Kotlin does not see what may be null"
    grep -q 'nullable receiver' "$work/java/kotlin.log" || fail "Kotlin refuses for another reason: $(cat "$work/java/kotlin.log")"
}

check_java() {
    java_library
    say "nullness and common mistakes: none"
    nullness_control
    check_format
    say "format: google-java-format's"
    check_api_level
    say "API level: 23"
    check_kotlin
    say "a program in Kotlin compiles and runs"
}
