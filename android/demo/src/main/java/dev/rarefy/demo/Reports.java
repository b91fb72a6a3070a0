// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.app.Activity;
import android.content.ActivityNotFoundException;
import android.content.Context;
import android.content.Intent;
import android.os.Build;
import dev.rarefy.DeviceInfo;
import dev.rarefy.OpenClReport;
import dev.rarefy.OpenOptions;
import dev.rarefy.RayTracer;
import dev.rarefy.RayTracerException;
import dev.rarefy.demo.logic.DeviceReport;
import dev.rarefy.demo.logic.Failure;
import java.util.Arrays;
import java.util.LinkedHashMap;
import java.util.Map;
import org.jspecify.annotations.Nullable;

/** What is told to others. */
final class Reports {
  private Reports() {}

  /** A report of this phone. */
  static final class Report {
    /** What one can read on a screen. */
    final String summary;

    /** That, and all limits of all devices. */
    final String all;

    Report(String summary, String all) {
      this.summary = summary;
      this.all = all;
    }
  }

  /** A report of this phone. Looks for OpenCL, which takes a while: not on the main thread. */
  static Report device(Context context, @Nullable DeviceInfo device, @Nullable Failure failure) {
    Map<String, String> phone = new LinkedHashMap<>();
    phone.put("phone", Build.MANUFACTURER + " " + Build.MODEL);
    phone.put("board", Build.BOARD + ", " + Build.HARDWARE);
    phone.put("Android", Build.VERSION.RELEASE + " (API " + Build.VERSION.SDK_INT + ")");
    phone.put("build", String.valueOf(Build.FINGERPRINT));
    phone.put("ABIs", Arrays.toString(Build.SUPPORTED_ABIS));
    String version;
    OpenClReport report = null;
    try {
      version = RayTracer.version();
      OpenOptions options =
          OpenOptions.builder().cacheFolder(AppOpener.cacheFolder(context)).build();
      report = OpenClReport.look(options);
    } catch (RayTracerException e) {
      version = "no report: " + e.getMessage();
    } catch (LinkageError e) {
      version = "the native library does not load: " + e;
    }
    String summary = DeviceReport.text(phone, version, report, device, failure);
    return new Report(summary, summary + DeviceReport.profiles(report));
  }

  /** Lets the user choose an app that takes this text. */
  static void share(Activity activity, String subject, String text) {
    Intent send = new Intent(Intent.ACTION_SEND);
    send.setType("text/plain");
    send.putExtra(Intent.EXTRA_SUBJECT, subject);
    send.putExtra(Intent.EXTRA_TEXT, text);
    try {
      activity.startActivity(Intent.createChooser(send, subject));
    } catch (ActivityNotFoundException e) {
      // A phone without any app to share with: there is nobody to tell.
      android.util.Log.w("rarefy", e);
    }
  }
}
