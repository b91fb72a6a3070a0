// SPDX-License-Identifier: MIT OR Apache-2.0
/**
 * Rarefy: a ray tracer for phones that shoots rays through a part of the pixels and rebuilds the
 * others.
 *
 * <p>Begin with {@link dev.rarefy.RayTracer}. Nothing here is null unless it says {@code Nullable}.
 * Lengths are in scene units, angles in degrees, times in milliseconds, sizes in pixels or bytes.
 */
@NullMarked
package dev.rarefy;

import org.jspecify.annotations.NullMarked;
