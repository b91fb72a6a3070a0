// SPDX-License-Identifier: MIT OR Apache-2.0
//! Do the Gradle project, the AAR's script, the Java classes and the code agree about versions, names and ABIs? Gradle itself is
//! not at hand, so that nothing else would notice.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;

use rarefy::Layer;
use rarefy::tuning::Test;
use rarefy_host_tests::command::root;

fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// What stands between two texts, the first time.
#[track_caller]
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    let (_, rest) = text.split_once(before).unwrap_or_else(|| panic!("no `{before}`"));
    rest.split_once(after).unwrap_or_else(|| panic!("no `{after}` after `{before}`")).0
}

#[test]
fn gradle_says_what_the_scripts_and_the_code_say() {
    let gradle = text("android/library/build.gradle.kts");
    let aar = text("android/check/aar.sh");
    let java = text("android/check/java.sh");
    let check = text("android/check.sh");
    let manifest = text("android/library/src/main/AndroidManifest.xml");
    assert_eq!(between(&gradle, "\nversion = \"", "\""), env!("CARGO_PKG_VERSION"));
    assert_eq!(between(&gradle, "group = \"", "\""), between(&aar, "\ngroup=", "\n"));
    assert_eq!(between(&gradle, "artifactId = \"", "\""), between(&aar, "\nname=", "\n"));
    assert_eq!(between(&gradle, "minSdk = ", "\n"), between(&aar, "\nmin_sdk=", "\n"));
    assert_eq!(between(&gradle, "\"-P\", \"", "\""), between(&check, "\napi=", "\n"));
    assert_eq!(between(&gradle, "api(\"", "\""), between(&java, "\njspecify=", "\n"));
    assert_eq!(between(&gradle, "namespace = \"", "\""), between(&manifest, "package=\"", "\""));
    let listed: Vec<&str> =
        between(&gradle, "val abis = listOf(", ")").split(", ").map(|abi| abi.trim_matches('"')).collect();
    assert_eq!(listed.join(" "), between(&check, "\nabis=\"", "\""));
    assert!(root().join("android/library").join(between(&gradle, "consumerProguardFiles(\"", "\"")).is_file());
    for module in text("android/settings.gradle.kts").split("include(\":").skip(1) {
        let folder = root().join("android").join(module.split_once('"').unwrap().0);
        assert!(folder.join("build.gradle.kts").is_file(), "{}", folder.display());
    }
    let package = between(&gradle, "\"-p\", \"", "\"");
    assert!(text("android/jni/Cargo.toml").contains(&format!("\nname = \"{package}\"\n")));
    let library = text("android/jni/Cargo.toml");
    let library = between(&library, "[lib]\nname = \"", "\"");
    assert!(
        text("android/library/src/main/java/dev/rarefy/Native.java").contains(&format!("loadLibrary(\"{library}\")"))
    );
    // What the AAR's minimum promises is what the API check checks.
    assert!(
        java.contains(&format!("api_signature_artifact=android-api-level-{}\n", between(&aar, "\nmin_sdk=", "\n")))
    );
}

#[test]
fn gradle_says_of_the_demo_app_what_its_script_says() {
    let gradle = text("android/demo/build.gradle.kts");
    let aar = text("android/check/aar.sh");
    let demo = text("android/check/demo.sh");
    let manifest = text("android/demo/src/main/AndroidManifest.xml");
    let package = between(&demo, "\ndemo_package=", "\n");
    assert_eq!(between(&gradle, "namespace = \"", "\""), package);
    assert_eq!(between(&gradle, "applicationId = \"", "\""), package);
    assert_eq!(between(&manifest, "package=\"", "\""), package);
    assert_eq!(between(&gradle, "versionName = \"", "\""), env!("CARGO_PKG_VERSION"));
    assert_eq!(between(&gradle, "versionCode = ", "\n"), between(&demo, "\ndemo_version_code=", "\n"));
    assert_eq!(between(&gradle, "minSdk = ", "\n"), between(&aar, "\nmin_sdk=", "\n"));
    assert_eq!(between(&gradle, "targetSdk = ", "\n"), between(&aar, "\ntarget_sdk=", "\n"));
    // Lint and Gradle take the same file, and the same plug-in builds library and app.
    assert!(demo.contains("check_lint") && text("android/check/lint.sh").contains(between(&gradle, "file(\"", "\"")));
    let plugin = |gradle: &str| between(gradle, ") version \"", "\"").to_owned();
    assert_eq!(plugin(&gradle), plugin(&text("android/library/build.gradle.kts")));
    // The scenes among the assets are built-in ones, and those that the app's list takes from its assets.
    let listed: Vec<&str> =
        between(&gradle, "val scenes = listOf(", ")").split(", ").map(|scene| scene.trim_matches('"')).collect();
    assert_eq!(listed.join(" "), between(&demo, "\ndemo_scenes=\"", "\""));
    let choices = text("android/demo/src/main/java/dev/rarefy/demo/logic/SceneChoice.java");
    for scene in &listed {
        assert!(rarefy::builtin(scene).is_ok(), "{scene}");
        assert!(choices.contains(&format!("Kind.ASSET, \"{scene}\"")), "{scene}");
    }
    assert_eq!(choices.matches("new SceneChoice(Kind.ASSET, \"").count(), listed.len());
}

/// The names in brackets of a Java enum's constants.
fn names(class: &str) -> BTreeSet<String> {
    let source = text(&format!("android/library/src/main/java/dev/rarefy/{class}.java"));
    source.lines().filter_map(|line| Some(line.trim().split_once("(\"")?.1.split_once("\")")?.0.to_owned())).collect()
}

#[test]
fn java_has_every_layer_and_test() {
    let layers: BTreeSet<String> =
        Layer::NAMES.iter().filter(|&&name| name != "color").map(|&n| n.to_owned()).collect();
    assert_eq!(names("Layer"), layers);
    assert_eq!(names("Test"), Test::NAMES.iter().map(|&name| name.to_owned()).collect());
}

#[test]
fn the_rules_for_r8_name_what_native_code_looks_up() {
    let rules = text("android/library/consumer-rules.pro");
    let classes = text("android/jni/src/classes.rs");
    let mut looked_up = 0;
    for part in classes.split("jni_str!(\"dev/rarefy/").skip(1) {
        let class = part.split_once('"').unwrap().0;
        assert!(rules.contains(&format!("dev.rarefy.{class} {{")), "{class}");
        looked_up += 1;
    }
    assert!(looked_up >= 7, "{looked_up}");
}
