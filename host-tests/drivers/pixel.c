// SPDX-License-Identifier: MIT OR Apache-2.0
// What Pixel phones have in place of an OpenCL library: functions are asked for by name.
void enableOpenCL(void) {}
void *loadOpenCLPointer(const char *name) { return (void *)0; }
