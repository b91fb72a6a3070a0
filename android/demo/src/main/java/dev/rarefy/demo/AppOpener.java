// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.content.Context;
import android.content.res.AssetManager;
import dev.rarefy.Cancellation;
import dev.rarefy.OpenOptions;
import dev.rarefy.ProgressListener;
import dev.rarefy.RayTracer;
import dev.rarefy.demo.logic.Opener;
import dev.rarefy.demo.logic.SceneChoice;
import java.io.File;

/** Opens scenes from the app's assets and files, on the phone's best device. */
final class AppOpener implements Opener {
  /** As {@link OpenOptions.Builder#device}; tests choose another one. */
  static volatile String device = "auto";

  private final AssetManager assets;
  private final File cache;

  AppOpener(Context context) {
    assets = context.getApplicationContext().getAssets();
    cache = cacheFolder(context);
  }

  /** Where compiled programs and what was learnt of drivers are kept. */
  static File cacheFolder(Context context) {
    return new File(context.getCacheDir(), "rarefy");
  }

  @Override
  public RayTracer open(
      SceneChoice scene,
      boolean retryCrashed,
      ProgressListener progress,
      Cancellation cancellation) {
    OpenOptions options =
        OpenOptions.builder()
            .device(device)
            .cacheFolder(cache)
            .retryCrashed(retryCrashed)
            .progress(progress)
            .cancellation(cancellation)
            .build();
    return RayTracer.open(scene.source(assets::open), options);
  }
}
