// SPDX-License-Identifier: MIT OR Apache-2.0
package org.jspecify.annotations;

import java.lang.annotation.ElementType;
import java.lang.annotation.Target;

/** A stand-in of the same name; see {@link Nullable}. */
@Target({ElementType.PACKAGE, ElementType.TYPE})
public @interface NullMarked {}
