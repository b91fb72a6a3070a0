// SPDX-License-Identifier: MIT OR Apache-2.0
//! The JNI library: a thin bridge from `dev.rarefy` to the Rarefy library.
