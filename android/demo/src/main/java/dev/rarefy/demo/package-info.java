// SPDX-License-Identifier: MIT OR Apache-2.0
/** The demo app: its screens. What they decide is in {@code dev.rarefy.demo.logic}. */
@NullMarked
package dev.rarefy.demo;

import org.jspecify.annotations.NullMarked;
