// SPDX-License-Identifier: MIT OR Apache-2.0
// The library in Android Studio. Not run by this project's checks: those make the AAR without Gradle (android/check/aar.sh), and
// host-tests/tests/android_project.rs holds the numbers and names here to be the same.
plugins {
    id("com.android.library") version "9.2.1"
    id("maven-publish")
}

group = "dev.rarefy"
version = "0.1.0"

val abis = listOf("arm64-v8a", "armeabi-v7a", "x86_64")

android {
    namespace = "dev.rarefy"
    compileSdk = 34
    ndkVersion = "28.2.13676358"
    defaultConfig {
        minSdk = 23
        consumerProguardFiles("consumer-rules.pro")
        ndk { abiFilters += abis }
    }
    compileOptions {
        sourceCompatibility = JavaVersion.VERSION_1_8
        targetCompatibility = JavaVersion.VERSION_1_8
    }
    publishing { singleVariant("release") { withSourcesJar() } }
}

dependencies {
    api("org.jspecify:jspecify:1.0.0")
}

// cargo-ndk (`cargo install cargo-ndk`) links with 16 KiB pages: by itself since NDK 28, and by its flags before.
val cargoNdk by tasks.registering(Exec::class) {
    workingDir = rootDir.parentFile
    val targets = abis.flatMap { listOf("-t", it) }
    commandLine(listOf("cargo", "ndk") + targets + listOf("-P", "21", "-o", "$projectDir/src/main/jniLibs", "build", "--release", "-p", "rarefy-jni"))
}
tasks.named("preBuild") { dependsOn(cargoNdk) }

publishing {
    publications {
        register<MavenPublication>("release") {
            artifactId = "rarefy"
            afterEvaluate { from(components["release"]) }
        }
    }
}
