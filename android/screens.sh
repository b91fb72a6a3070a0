#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Starts the demo app in a desktop Java VM with Android's own framework code, touches it, turns it, and compares its screens with stored
# ones. Needs a JDK, Maven and pip, and what those fetch; host-tests/tests/demo_screens.rs runs it.
#
#   android/screens.sh quick [LIBRARY]   some of the tests
#   android/screens.sh long [LIBRARY]    all others
#   android/screens.sh bless [LIBRARY]   stores all screens anew; look at them before they are committed
#
# LIBRARY is the librarefy_jni.so that cargo built, with the command beside it. The screens in their full size are in
# target-android/screens/seen afterwards.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/lib.sh
. android/check/java.sh
. android/check/aar.sh
. android/check/demo.sh
. android/check/screens.sh

work=$PWD/target-android
out=$work/screens
library=${2-$PWD/target/debug/librarefy_jni.so}
rarefy=$(dirname "$library")/rarefy
[ -f "$library" ] && [ -x "$rarefy" ] || fail "no $library with the command beside it: run \`cargo build --workspace\`"

quick_classes="QuickScreensTest"
long_classes="ScreensTest LifecycleTest TouchTest NewestPhoneTest OldestPhoneTest"
case ${1-} in
quick) apis=34 classes=$quick_classes options= ;;
long) apis="23 34 35" classes=$long_classes options= ;;
bless) apis="23 34 35" classes="$quick_classes $long_classes" options=-Drarefy.screens.bless=true ;;
# For work on the app: some classes alone.
only) apis="23 34 35" classes=$3 options=${4-} ;;
*) fail "usage: android/screens.sh quick | long | bless [LIBRARY]" ;;
esac

mkdir -p "$out"
# Two of them would write the same files.
exec 9>"$out/lock"
flock 9
# shellcheck disable=SC2086 # several versions are meant
fetch_screens $apis
path=$(screens_path)
# shellcheck disable=SC2086 # several versions are meant
frameworks "$out/frameworks" $apis
compile_screens "$out" "$path"
# shellcheck disable=SC2086 # several classes are meant
run_screens "$out" "$path" "$library" "$options" $classes
