// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.demo.logic;

import java.util.Iterator;
import java.util.List;
import java.util.Map;
import org.jspecify.annotations.Nullable;

/** Values as JSON, indented as the command line writes it. */
final class Json {
  private final StringBuilder text = new StringBuilder();

  private Json() {}

  /**
   * Text of a map with names in order, a list, a text, a number, a truth value, or null. A number
   * that JSON does not know is null.
   */
  static String text(@Nullable Object value) {
    Json json = new Json();
    json.value(value, "\n");
    return json.text.append('\n').toString();
  }

  private void value(@Nullable Object value, String line) {
    if (value instanceof Map) {
      Iterator<? extends Map.Entry<?, ?>> entries = ((Map<?, ?>) value).entrySet().iterator();
      text.append('{');
      for (String comma = ""; entries.hasNext(); comma = ",") {
        Map.Entry<?, ?> entry = entries.next();
        text.append(comma).append(line).append("  ");
        quoted(String.valueOf(entry.getKey()));
        text.append(": ");
        value(entry.getValue(), line + "  ");
      }
      text.append(line).append('}');
    } else if (value instanceof List) {
      Iterator<?> values = ((List<?>) value).iterator();
      text.append('[');
      for (String comma = ""; values.hasNext(); comma = ",") {
        text.append(comma).append(line).append("  ");
        value(values.next(), line + "  ");
      }
      text.append(line).append(']');
    } else if (value instanceof Double || value instanceof Float) {
      double number = ((Number) value).doubleValue();
      text.append(Double.isNaN(number) || Double.isInfinite(number) ? "null" : "" + number);
    } else if (value == null || value instanceof Number || value instanceof Boolean) {
      text.append(value);
    } else {
      quoted(value.toString());
    }
  }

  private void quoted(String string) {
    text.append('"');
    for (int at = 0; at < string.length(); at++) {
      char c = string.charAt(at);
      if (c == '"' || c == '\\') {
        text.append('\\').append(c);
      } else if (c < ' ' || Character.isSurrogate(c)) {
        text.append(String.format("\\u%04x", (int) c));
      } else {
        text.append(c);
      }
    }
    text.append('"');
  }
}
