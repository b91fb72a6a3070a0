// SPDX-License-Identifier: MIT OR Apache-2.0
// probe: what this device's compiler makes of the shared structs. Not a step of the method.
// Inputs: none. Outputs: sizes and member offsets in bytes, in the order of rarefy::layout::expected_probe().
// Invariant: equal to the host's layout. Cost: one work-item. Twin: src/layout/structs.rs (expected_probe).
#include "types.h"

#define OFFSET(type, member) ((uint)((__private char *)&((type *)p)->member - (__private char *)p))

__kernel void probe(__global uint *out) {
  FrameParams frame;
  StepParams step;
  Light light;
  Material material;
  Texture texture;
  TriangleShading shading;
  uint n = 0u;
  void *p;
  out[n++] = sizeof(FrameParams);
  p = &frame;
  out[n++] = OFFSET(FrameParams, up);
  out[n++] = OFFSET(FrameParams, bounds_max);
  out[n++] = OFFSET(FrameParams, width);
  out[n++] = OFFSET(FrameParams, plane_pitch);
  out[n++] = OFFSET(FrameParams, epsilon);
  out[n++] = OFFSET(FrameParams, interior_end);
  out[n++] = sizeof(StepParams);
  p = &step;
  out[n++] = OFFSET(StepParams, reference_dx);
  out[n++] = OFFSET(StepParams, item_count);
  out[n++] = OFFSET(StepParams, t_pos);
  out[n++] = OFFSET(StepParams, tests);
  out[n++] = OFFSET(StepParams, scan_group);
  out[n++] = sizeof(Light);
  p = &light;
  out[n++] = OFFSET(Light, intensity);
  out[n++] = sizeof(Material);
  p = &material;
  out[n++] = OFFSET(Material, transmission);
  out[n++] = OFFSET(Material, surface);
  out[n++] = OFFSET(Material, cutout_texture);
  out[n++] = sizeof(Texture);
  p = &texture;
  out[n++] = OFFSET(Texture, height);
  out[n++] = sizeof(TriangleShading);
  p = &shading;
  out[n++] = OFFSET(TriangleShading, object);
  out[n++] = OFFSET(TriangleShading, t2);
  out[n++] = OFFSET(TriangleShading, material);
}
