// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

/** Sees a frame in low resolution, long before it is done. */
public interface PreviewListener {
  /**
   * Called as soon as the first pixels of a frame have rays: a quarter of them with blocks of 2, a
   * sixteenth with blocks of 4. Threads and exceptions are those of {@link
   * ProgressListener#onProgress}. A frame that does not fit the memory budget is drawn in bands,
   * each of which gives a preview.
   *
   * @param width width of the whole preview in pixels
   * @param height height of the whole preview in pixels
   * @param firstRow the row of the preview at which {@code argb} begins
   * @param argb whole rows of pixels as in {@link Picture#getArgb}; the listener may keep it
   */
  void onPreview(int width, int height, int firstRow, int[] argb);
}
