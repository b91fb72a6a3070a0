// SPDX-License-Identifier: MIT OR Apache-2.0
package dev.rarefy.app

import android.graphics.Bitmap
import android.view.Surface
import dev.rarefy.BitmapTarget
import dev.rarefy.Camera
import dev.rarefy.Cancellation
import dev.rarefy.Layer
import dev.rarefy.Light
import dev.rarefy.OpenClReport
import dev.rarefy.OpenOptions
import dev.rarefy.RayTracer
import dev.rarefy.RayTracerException
import dev.rarefy.RenderOptions
import dev.rarefy.SceneSource
import dev.rarefy.SurfaceTarget
import dev.rarefy.Test
import java.io.ByteArrayInputStream
import java.io.File
import java.nio.ByteBuffer

/** The example of README.md in Kotlin. */
fun example() {
    RayTracer.open(SceneSource.builtin("spheres")).use { tracer ->
        val pixels = RayTracer.allocate(640, 480)
        val stats = tracer.render(RenderOptions.ofSize(640, 480), pixels)
        println(stats)
    }
}

/** What needs Android: compiled, not run here. */
object OnAndroid {
    fun draw(tracer: RayTracer, bitmap: Bitmap, surface: Surface) {
        tracer.render(RenderOptions.defaults(), BitmapTarget.of(bitmap))
        tracer.render(RenderOptions.defaults(), SurfaceTarget.of(surface))
    }
}

/** Every source of a scene; nothing is read before it is opened. */
fun sources(): List<SceneSource> = listOf(
    SceneSource.files(File("kitchen")),
    SceneSource.baked(File("kitchen.baked")),
    SceneSource.baked(File("app.apk"), 4096, 1 shl 20),
    SceneSource.baked(3, 4096, 1 shl 20),
    SceneSource.assets("kitchen") { name -> if (name == "none") null else ByteArrayInputStream(ByteArray(0)) },
)

fun main() {
    check(RayTracer.version().isNotEmpty() && sources().size == 5)
    example()
    val options = OpenOptions.builder()
        .device("cpu").cacheFolder(File("out")).memoryBudgetBytes(1L shl 30).strict(true).retryCrashed(false)
        .progress { phase, share -> check(phase.isNotEmpty() && share <= 1f) }
        .cancellation(Cancellation())
        .build()
    RayTracer.open(SceneSource.builtin("spheres"), options).use { tracer ->
        var previews = 0
        tracer.setPreviewListener { width, height, firstRow, argb ->
            check(width * height == argb.size && firstRow == 0)
            previews++
        }
        tracer.setProgressListener(null)
        tracer.camera = tracer.camera.orbit(20.0, 5.0).dolly(0.9).pan(0.1, 0.0).walk(0.1, 0.0).turn(1.0, 0.0)
        tracer.lights = tracer.lights + Light(0f, 1f, 0f, 1f, 1f, 1f)
        check(tracer.camera.distance > 0 && tracer.lights.isNotEmpty())
        check(tracer.stats()?.traced == null)
        val frame = RenderOptions.builder()
            .method(RenderOptions.Method.FAST).size(64, 48).mode(RenderOptions.Mode.ADAPTIVE).samples(1).depth(3)
            .tPos(0.05f).tGcol(0.1f, 0.2f).disableTest(Test.TX).correction(RenderOptions.Correction.ALL)
            .keepLayer(Layer.CLASS).counters(true)
            .build()
        val pixels: ByteBuffer = RayTracer.allocate(64, 48)
        val stats = tracer.render(frame, pixels)
        check(stats.hasCounters() && stats.shadowRays > 0 && !stats.isFellBack && previews == 1)
        check(stats.stagesMillis.size == 8 && stats.tracedShare < 1.0)
        check(tracer.layer(Layer.CLASS).argb.size == 64 * 48)
        check(tracer.deviceInfo().backend == "cpu" && tracer.deviceInfo().passedOver.isEmpty())
        check(OpenClReport.look(options).toString().isNotEmpty() && tracer.deviceInfo().notices.isEmpty())
        try {
            tracer.render(frame.toBuilder().tPos(-1f).build(), pixels)
            error("a tolerance below 0 is drawn with")
        } catch (e: RayTracerException) {
            check(e.code == RayTracerException.Code.INVALID_OPTION && e.place?.contains("tPos") == true)
        }
        check(Camera.lookingAt(0f, 0f, 1f, 0f, 0f, 0f).withFovYDegrees(30f).fovYDegrees == 30f)
    }
}
