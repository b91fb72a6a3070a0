// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo;

import android.app.Activity;
import android.content.ActivityNotFoundException;
import android.content.ContentResolver;
import android.content.Context;
import android.content.Intent;
import android.database.Cursor;
import android.net.Uri;
import android.os.Handler;
import android.os.Looper;
import android.provider.OpenableColumns;
import android.widget.Toast;
import dev.rarefy.demo.logic.OpenedFile;
import dev.rarefy.demo.logic.RenderLoop;
import dev.rarefy.demo.logic.SceneChoice;
import java.io.File;
import java.io.FileNotFoundException;
import java.io.IOException;
import java.io.InputStream;
import org.jspecify.annotations.Nullable;

/** Opens a file that the user chooses with the system's picker. */
final class Picker {
  static final int REQUEST = 1;

  private Picker() {}

  static void ask(Activity activity) {
    Intent open = new Intent(Intent.ACTION_OPEN_DOCUMENT);
    open.addCategory(Intent.CATEGORY_OPENABLE);
    // There is no type that all phones know for OBJ, and none at all for baked scenes.
    open.setType("*/*");
    try {
      activity.startActivityForResult(open, REQUEST);
    } catch (ActivityNotFoundException e) {
      Toast.makeText(activity, R.string.no_picker, Toast.LENGTH_LONG).show();
    }
  }

  /** Copies what was chosen, on a thread of its own, and shows it. */
  static void take(Context any, Uri uri, RenderLoop loop) {
    Context context = any.getApplicationContext();
    // Texts in the app's language, which the application's own context need not have.
    String tooLarge =
        any.getString(R.string.file_too_large, String.valueOf(OpenedFile.MOST_BYTES >> 20));
    String failed = any.getString(R.string.file_failed);
    Thread thread =
        new Thread(
            () -> {
              try {
                loop.setScene(copy(context, uri));
              } catch (OpenedFile.TooLarge e) {
                tell(context, tooLarge);
              } catch (IOException | RuntimeException e) {
                // Whatever another app's provider throws.
                tell(context, failed);
              }
            },
            "rarefy-copy");
    thread.start();
  }

  private static SceneChoice copy(Context context, Uri uri) throws IOException {
    ContentResolver resolver = context.getContentResolver();
    try (InputStream stream = resolver.openInputStream(uri)) {
      if (stream == null) {
        throw new FileNotFoundException(uri.toString());
      }
      File folder = new File(context.getCacheDir(), "opened");
      return OpenedFile.copy(stream, name(resolver, uri), folder, OpenedFile.MOST_BYTES);
    }
  }

  private static @Nullable String name(ContentResolver resolver, Uri uri) {
    String[] columns = {OpenableColumns.DISPLAY_NAME};
    try (Cursor cursor = resolver.query(uri, columns, null, null, null)) {
      return cursor != null && cursor.moveToFirst() ? cursor.getString(0) : null;
    }
  }

  private static void tell(Context context, String text) {
    Runnable toast = () -> Toast.makeText(context, text, Toast.LENGTH_LONG).show();
    new Handler(Looper.getMainLooper()).post(toast);
  }
}
