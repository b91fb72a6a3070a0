// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy;

import java.io.File;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.ReadOnlyBufferException;
import java.util.ArrayList;
import java.util.Collections;
import java.util.List;
import java.util.concurrent.CountDownLatch;
import java.util.concurrent.atomic.AtomicReference;

/** Everything that one can do wrong: each gives the exception that is documented. */
final class MisuseTest {
  private static final RenderOptions SMALL = RenderOptions.ofSize(8, 8);

  /** One that takes seconds, if nobody ends it, and fits into 32 bits of addresses. */
  private static final RenderOptions LARGE =
      RenderOptions.builder().size(1000, 1000).samples(4).build();

  private MisuseTest() {}

  public static void main(String[] arguments) throws Exception {
    File folder = new File(arguments[0]);
    closing();
    nulls();
    buffers();
    options();
    scenes(folder);
    listeners();
    cancelling();
    closingWhileDrawing();
    openingCancelled();
    forgotten();
    Check.equal(0, Native.openCount());
    System.out.println("done");
  }

  private static void closing() {
    RayTracer tracer = Check.cpu("wall");
    ByteBuffer pixels = RayTracer.allocate(8, 8);
    tracer.close();
    tracer.close();
    tracer.cancel();
    for (Runnable use :
        new Runnable[] {
          () -> tracer.render(SMALL, pixels),
          () -> tracer.layer(Layer.DEPTH),
          tracer::getCamera,
          () -> tracer.setCamera(Camera.lookingAt(0, 0, 1, 0, 0, 0)),
          tracer::getLights,
          () -> tracer.setLights(Collections.emptyList()),
          tracer::deviceInfo
        }) {
      IllegalStateException e = Check.thrown(IllegalStateException.class, Check.call(use));
      Check.equal("this RayTracer is closed", e.getMessage());
    }
    // Handles that never were one.
    for (long handle : new long[] {0, -1, Long.MAX_VALUE, Long.MIN_VALUE}) {
      Native.close(handle);
      Native.release(handle);
      Native.cancel(handle);
      Check.thrown(IllegalStateException.class, () -> Native.camera(handle));
    }
  }

  private static void nulls() {
    Check.thrown(NullPointerException.class, () -> RayTracer.open(null));
    Check.thrown(NullPointerException.class, () -> SceneSource.builtin(null));
    Check.thrown(NullPointerException.class, () -> SceneSource.files(null));
    Check.thrown(NullPointerException.class, () -> SceneSource.assets("a.obj", null));
    try (RayTracer tracer = Check.cpu("wall")) {
      ByteBuffer pixels = RayTracer.allocate(8, 8);
      Check.thrown(NullPointerException.class, () -> tracer.render(null, pixels));
      Check.thrown(NullPointerException.class, () -> tracer.render(SMALL, (ByteBuffer) null));
      Check.thrown(NullPointerException.class, () -> tracer.render(SMALL, (RenderTarget) null));
      Check.thrown(NullPointerException.class, () -> tracer.layer(null));
      Check.thrown(NullPointerException.class, Check.call(() -> tracer.setCamera(null)));
      Check.thrown(NullPointerException.class, Check.call(() -> tracer.setLights(null)));
      Check.thrown(
          NullPointerException.class,
          Check.call(() -> tracer.setLights(Collections.singletonList(null))));
      // Below Java's own checks the natives have theirs.
      long handle = Native.create();
      String[] none = {};
      for (Runnable call :
          new Runnable[] {
            () -> Native.loadBuiltin(handle, null, none, null),
            () -> Native.loadBuiltin(handle, "wall", null, null),
            () -> Native.loadBuiltin(handle, "wall", new String[] {null, null}, null),
            () -> Native.loadFiles(handle, null, none, null),
            () -> Native.layer(handle, null),
            () -> Native.setCamera(handle, null),
            () -> Native.renderBuffer(handle, null, pixels, 0, null, null),
            () -> Native.renderBuffer(handle, new String[] {"size", "8,8"}, null, 0, null, null)
          }) {
        Check.thrown(NullPointerException.class, Check.call(call));
      }
      Check.thrown(
          RayTracerException.class,
          Check.call(() -> Native.loadAssets(handle, null, "a.obj", none, null)));
      Native.close(handle);
      Check.draw(tracer, SMALL, 8, 8);
    }
  }

  private static void buffers() {
    try (RayTracer tracer = Check.cpu("wall")) {
      ByteBuffer pixels = RayTracer.allocate(8, 8);
      Check.thrown(
          IllegalArgumentException.class, () -> tracer.render(SMALL, ByteBuffer.allocate(256)));
      Check.thrown(
          ReadOnlyBufferException.class, () -> tracer.render(SMALL, pixels.asReadOnlyBuffer()));
      IllegalArgumentException e =
          Check.thrown(
              IllegalArgumentException.class,
              () -> tracer.render(RenderOptions.ofSize(8, 9), pixels));
      Check.equal("8x9 pixels take 288 bytes, the ByteBuffer has 256", e.getMessage());
      pixels.position(1);
      Check.thrown(IllegalArgumentException.class, () -> tracer.render(SMALL, pixels));
      pixels.position(0).limit(255);
      Check.thrown(IllegalArgumentException.class, () -> tracer.render(SMALL, pixels));
      Check.thrown(
          IllegalArgumentException.class, () -> tracer.render(RenderOptions.defaults(), pixels));
      for (int offset : new int[] {-1, 1, 257, Integer.MAX_VALUE, Integer.MIN_VALUE}) {
        Check.thrown(
            IllegalArgumentException.class,
            () ->
                Native.renderBuffer(
                    0, new String[] {"size", "8,8"}, RayTracer.allocate(8, 8), offset, null, null));
      }
      for (int[] size : new int[][] {{0, 1}, {-1, -1}, {1 << 16, 1 << 16}}) {
        Check.thrown(RuntimeException.class, () -> RayTracer.allocate(size[0], size[1]));
      }
    }
  }

  private static void options() {
    try (RayTracer tracer = Check.cpu("wall")) {
      ByteBuffer pixels = RayTracer.allocate(8, 8);
      RenderOptions.Builder[] wrong = {
        RenderOptions.builder().size(8, 8).tPos(-1),
        RenderOptions.builder().size(8, 8).tNorm(Float.NaN),
        RenderOptions.builder().size(8, 8).tConv(1.5f),
        RenderOptions.builder().size(8, 8).samples(3),
        RenderOptions.builder().size(8, 8).depth(-1),
        RenderOptions.builder().size(8, 8).block(3),
        RenderOptions.builder().size(0, 8),
      };
      String[] methods = {"tPos", "tNorm", "tConv", "samples", "depth", "block", "size"};
      for (int at = 0; at < wrong.length; at++) {
        RenderOptions options = wrong[at].build();
        String name = "RenderOptions.Builder." + methods[at];
        RayTracerException e =
            Check.coded(
                RayTracerException.Code.INVALID_OPTION, name, () -> tracer.render(options, pixels));
        Check.equal(name, e.getPlace());
      }
      Check.coded(
          RayTracerException.Code.INVALID_ARGUMENT,
          "another version",
          () ->
              Native.renderBuffer(
                  0, new String[] {"colour", "red"}, RayTracer.allocate(8, 8), 0, null, null));
      Camera broken = tracer.getCamera();
      Check.coded(
          RayTracerException.Code.INVALID_SCENE,
          "camera",
          Check.call(() -> tracer.setCamera(Camera.lookingAt(0, 0, 3e38f, 0, 0, -3e38f))));
      Check.equal(broken, tracer.getCamera());
      List<Light> lights = Collections.nCopies(33, new Light(0, 0, 0, 1, 1, 1));
      Check.coded(
          RayTracerException.Code.INVALID_SCENE, "32", Check.call(() -> tracer.setLights(lights)));
      Check.draw(tracer, SMALL, 8, 8);
    }
  }

  private static void scenes(File folder) throws IOException {
    Check.coded(
        RayTracerException.Code.INVALID_SCENE,
        "none-such",
        () -> RayTracer.open(SceneSource.files(new File(folder, "none-such"))));
    Check.coded(
        RayTracerException.Code.INVALID_OPTION,
        "cafe",
        () -> RayTracer.open(SceneSource.builtin("none-such")));
    Check.coded(
        RayTracerException.Code.INVALID_OPTION,
        "OpenOptions.Builder.device",
        () -> RayTracer.open(SceneSource.builtin("wall"), Check.on("gpu")));
    Check.thrown(
        RayTracerException.class,
        () ->
            RayTracer.open(
                SceneSource.builtin("wall"), OpenOptions.builder().profile("none-such").build()));
    RayTracerException limit =
        Check.coded(
            RayTracerException.Code.LIMIT_EXCEEDED,
            "memory",
            () -> {
              OpenOptions tiny =
                  OpenOptions.builder().device("cpu").memoryBudgetBytes(1000).build();
              try (RayTracer tracer = RayTracer.open(SceneSource.builtin("spheres"), tiny)) {
                return tracer.render(SMALL, RayTracer.allocate(8, 8));
              }
            });
    Check.that(limit.getPlace() != null, "a limit without a place");
    String[] texts = {"v 0 0 0\nv 1 0 0\nv 0 x 0\nf 1 2 3\n", "v 0 0 0\n"};
    RayTracerException.Code[] codes = {
      RayTracerException.Code.SYNTAX, RayTracerException.Code.INVALID_SCENE
    };
    for (int at = 0; at < texts.length; at++) {
      byte[] bytes = texts[at].getBytes("UTF-8");
      AssetReader reader =
          name -> name.equals("a.obj") ? new java.io.ByteArrayInputStream(bytes) : null;
      RayTracerException e =
          Check.coded(
              codes[at], "a.obj", () -> RayTracer.open(SceneSource.assets("a.obj", reader)));
      if (at == 0) {
        Check.equal("a.obj:3", e.getPlace());
      }
    }
    IOException lost = new IOException("the disk is gone");
    RayTracerException e =
        Check.coded(
            RayTracerException.Code.IO,
            "a.obj",
            () ->
                RayTracer.open(
                    SceneSource.assets(
                        "a.obj",
                        name -> {
                          throw lost;
                        })));
    Check.equal(lost, e.getCause());
    Check.equal("a.obj/scene.obj", e.getPlace());
    Check.coded(
        RayTracerException.Code.INVALID_SCENE,
        "a.obj",
        () -> RayTracer.open(SceneSource.assets("a.obj", name -> null)));
    IllegalStateException inner =
        (IllegalStateException)
            Check.thrown(
                    RayTracerException.class,
                    () ->
                        RayTracer.open(
                            SceneSource.assets(
                                "a.obj",
                                name -> {
                                  Check.cpu("wall").close();
                                  return null;
                                })))
                .getCause();
    Check.that(inner.getMessage().contains("listener"), inner.getMessage());
  }

  private static void listeners() {
    RuntimeException mine = new RuntimeException("mine");
    try (RayTracer tracer = Check.cpu("wall")) {
      tracer.setProgressListener(
          (phase, share) -> {
            throw mine;
          });
      Check.equal(
          mine, Check.thrown(RuntimeException.class, () -> Check.draw(tracer, SMALL, 8, 8)));
      tracer.setProgressListener(null);
      tracer.setPreviewListener(
          (width, height, firstRow, argb) -> {
            throw mine;
          });
      Check.equal(
          mine, Check.thrown(RuntimeException.class, () -> Check.draw(tracer, SMALL, 8, 8)));
      tracer.setPreviewListener(null);
      AtomicReference<Throwable> within = new AtomicReference<>();
      tracer.setProgressListener(
          (phase, share) -> {
            try {
              Check.draw(tracer, SMALL, 8, 8);
            } catch (Throwable e) {
              within.set(e);
            }
            tracer.setCamera(tracer.getCamera());
          });
      Check.draw(tracer, SMALL, 8, 8);
      Check.that(within.get() instanceof IllegalStateException, "drawn within a listener");
      tracer.setProgressListener((phase, share) -> tracer.close());
      try {
        Check.draw(tracer, SMALL, 8, 8);
      } catch (RayTracerException e) {
        Check.equal(RayTracerException.Code.CANCELLED, e.getCode());
      }
      Check.thrown(IllegalStateException.class, tracer::getCamera);
    }
    RuntimeException opening =
        Check.thrown(
            RuntimeException.class,
            () ->
                RayTracer.open(
                    SceneSource.builtin("wall"),
                    OpenOptions.builder()
                        .device("cpu")
                        .progress(
                            (phase, share) -> {
                              throw mine;
                            })
                        .build()));
    Check.equal(mine, opening);
  }

  /** Runs {@code end} once the frame has begun. */
  private static void interrupted(RayTracer tracer, Runnable end) throws Exception {
    CountDownLatch begun = new CountDownLatch(1);
    tracer.setProgressListener((phase, share) -> begun.countDown());
    Thread other =
        new Thread(
            () -> {
              try {
                begun.await();
                end.run();
              } catch (InterruptedException e) {
                throw new AssertionError(e);
              }
            });
    other.start();
    ByteBuffer pixels = RayTracer.allocate(1000, 1000);
    Check.coded(RayTracerException.Code.CANCELLED, "cancelled", () -> tracer.render(LARGE, pixels));
    other.join();
  }

  private static void cancelling() throws Exception {
    try (RayTracer tracer = Check.cpu("spheres")) {
      byte[] before = Check.draw(tracer, SMALL, 8, 8);
      interrupted(tracer, tracer::cancel);
      tracer.setProgressListener(null);
      // What was cancelled before does not touch what comes.
      tracer.cancel();
      Check.same(before, Check.draw(tracer, SMALL, 8, 8), "after a cancelled frame");
    }
  }

  private static void closingWhileDrawing() throws Exception {
    RayTracer tracer = Check.cpu("spheres");
    interrupted(tracer, tracer::close);
    Check.thrown(IllegalStateException.class, () -> Check.draw(tracer, SMALL, 8, 8));
  }

  private static void openingCancelled() throws Exception {
    Cancellation before = new Cancellation();
    before.cancel();
    Check.coded(
        RayTracerException.Code.CANCELLED,
        "cancelled",
        () ->
            RayTracer.open(
                SceneSource.builtin("cafe"),
                OpenOptions.builder().device("cpu").cancellation(before).build()));
    Cancellation during = new Cancellation();
    CountDownLatch begun = new CountDownLatch(1);
    Thread other =
        new Thread(
            () -> {
              try {
                begun.await();
              } catch (InterruptedException e) {
                throw new AssertionError(e);
              }
              during.cancel();
            });
    other.start();
    Check.coded(
        RayTracerException.Code.CANCELLED,
        "cancelled",
        () ->
            RayTracer.open(
                SceneSource.builtin("cafe"),
                OpenOptions.builder()
                    .device("cpu")
                    .cancellation(during)
                    .progress(
                        (phase, share) -> {
                          begun.countDown();
                          while (!during.isCancelled()) {
                            Thread.yield();
                          }
                        })
                    .build()));
    other.join();
  }

  private static void forgotten() throws Exception {
    Check.equal(0, Native.openCount());
    List<RayTracer> kept = new ArrayList<>();
    for (int at = 0; at < 4; at++) {
      RayTracer tracer = Check.cpu("wall");
      Check.draw(tracer, SMALL, 8, 8);
      if (at % 2 == 0) {
        kept.add(tracer);
      }
    }
    // The collector may take its time, but must get there; the test that runs this has a limit.
    while (Native.openCount() > kept.size()) {
      System.gc();
      Thread.sleep(5);
    }
    for (RayTracer tracer : kept) {
      Check.draw(tracer, SMALL, 8, 8);
      tracer.close();
    }
  }
}
