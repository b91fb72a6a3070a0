// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.File;
import java.net.URL;
import java.net.URLClassLoader;

/**
 * Runs a test's main in a class loader of its own, as an app's classes are on a phone: TEST ...
 * Itself it must be alone on the class path.
 */
public final class ChildLoader {
  private ChildLoader() {}

  public static void main(String[] arguments) throws Exception {
    URL[] path = {new File(System.getProperty("dev.rarefy.classes")).toURI().toURL()};
    try (URLClassLoader loader = new URLClassLoader(path)) {
      Class<?> test = Class.forName("dev.rarefy." + arguments[0], true, loader);
      if (test.getClassLoader() != loader) {
        throw new AssertionError("not a class of the child's: is it on the class path?");
      }
      String[] rest = java.util.Arrays.copyOfRange(arguments, 1, arguments.length);
      java.lang.reflect.Method main = test.getDeclaredMethod("main", String[].class);
      main.setAccessible(true);
      main.invoke(null, (Object) rest);
    }
  }
}
