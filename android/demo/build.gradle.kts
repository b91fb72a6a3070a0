// SPDX-License-Identifier: MIT OR Apache-2.0
// The demo app in Android Studio. Not run by this project's checks: those make the package without Gradle (android/check/demo.sh), and
// host-tests/tests/android_project.rs holds the numbers and names here to be the same.
plugins {
    id("com.android.application") version "9.2.1"
}

val scenes = listOf("kitchen", "bathroom")
val sceneFolder = layout.buildDirectory.dir("scenes")

android {
    namespace = "dev.rarefy.demo"
    compileSdk = 35
    defaultConfig {
        applicationId = "dev.rarefy.demo"
        minSdk = 23
        targetSdk = 35
        versionCode = 1
        versionName = "0.1.0"
    }
    compileOptions {
        sourceCompatibility = JavaVersion.VERSION_1_8
        targetCompatibility = JavaVersion.VERSION_1_8
    }
    sourceSets["main"].assets.srcDir(sceneFolder)
    signingConfigs {
        // The key of releases is its owner's: ./gradlew :demo:assembleRelease -PrarefyKeyStore=FILE -PrarefyKeyPassword=...
        create("release") {
            storeFile = providers.gradleProperty("rarefyKeyStore").orNull?.let { file(it) }
            storePassword = providers.gradleProperty("rarefyKeyPassword").orNull
            keyAlias = providers.gradleProperty("rarefyKeyAlias").getOrElse("rarefy")
            keyPassword = storePassword
        }
    }
    buildTypes {
        release {
            isMinifyEnabled = true
            proguardFiles(getDefaultProguardFile("proguard-android-optimize.txt"))
            if (providers.gradleProperty("rarefyKeyStore").isPresent) signingConfig = signingConfigs["release"]
        }
    }
    lint { lintConfig = file("lint.xml") }
}

dependencies {
    implementation(project(":library"))
}

// The scenes among the assets are written by the command, and are the same every time.
val makeScenes = scenes.map { scene ->
    tasks.register<Exec>("makeScene-$scene") {
        val folder = sceneFolder.get().dir(scene).asFile
        outputs.dir(folder)
        workingDir = rootDir.parentFile
        doFirst { folder.deleteRecursively() }
        commandLine("cargo", "run", "--quiet", "--package", "rarefy", "--", "make-scene", scene, "--output", folder.path)
    }
}
tasks.named("preBuild") { dependsOn(makeScenes) }
