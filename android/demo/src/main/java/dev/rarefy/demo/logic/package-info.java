// SPDX-License-Identifier: MIT OR Apache-2.0
/**
 * What the demo app decides, without Android's classes, so that a desktop's Java VM can test it.
 */
@NullMarked
package dev.rarefy.demo.logic;

import org.jspecify.annotations.NullMarked;
