// SPDX-License-Identifier: MIT OR Apache-2.0
package org.jspecify.annotations;

import java.lang.annotation.ElementType;
import java.lang.annotation.Target;

/**
 * A stand-in of the same name, to compile without a download: what ships is compiled with the real
 * one (android/check.sh).
 */
@Target(ElementType.TYPE_USE)
public @interface Nullable {}
