// SPDX-License-Identifier: MIT OR Apache-2.0
// probe: what this device's compiler makes of the shared structs. Not a step of the method.
// Inputs: none. Outputs: of each struct its size, then the offset of each member, in bytes, in the order of
// rarefy::layout::struct_layout(). Invariant: equal to the host's layout. Cost: one work-item.
// Twin: src/layout/structs.rs (struct_layout).
#include "types.h"

#define SIZE(type) out[n++] = sizeof(type)
#define AT(member) out[n++] = (uint)((__private char *)&p->member - (__private char *)p)

static uint probe_frame(__global uint *out, uint n) {
  FrameParams object, *p = &object;
  SIZE(FrameParams);
  AT(eye);
  AT(forward);
  AT(right);
  AT(up);
  AT(ambient);
  AT(background);
  AT(bounds_min);
  AT(bounds_max);
  AT(width);
  AT(height);
  AT(block);
  AT(phase_width);
  AT(phase_height);
  AT(plane_pitch);
  AT(light_count);
  AT(depth_limit);
  AT(epsilon);
  AT(window_begin);
  AT(window_end);
  AT(interior_begin);
  AT(interior_end);
  AT(pad0);
  AT(pad1);
  AT(pad2);
  return n;
}

static uint probe_step(__global uint *out, uint n) {
  StepParams object, *p = &object;
  SIZE(StepParams);
  AT(origin_x);
  AT(origin_y);
  AT(step_x);
  AT(step_y);
  AT(grid_width);
  AT(grid_height);
  AT(reference_dx);
  AT(reference_dy);
  AT(item_count);
  AT(list_offset);
  AT(source_offset);
  AT(sums_offset);
  AT(t_pos);
  AT(t_norm);
  AT(t_conv);
  AT(t_tex);
  AT(t_gcol);
  AT(tests);
  AT(flags);
  AT(scan_group);
  AT(t_visible);
  AT(list_end);
  AT(pixel_class);
  AT(pad0);
  return n;
}

static uint probe_light(__global uint *out, uint n) {
  Light object, *p = &object;
  SIZE(Light);
  AT(position);
  AT(intensity);
  return n;
}

static uint probe_material(__global uint *out, uint n) {
  Material object, *p = &object;
  SIZE(Material);
  AT(diffuse);
  AT(specular);
  AT(reflectance);
  AT(transmission);
  AT(emission);
  AT(surface);
  AT(diffuse_texture);
  AT(cutout_texture);
  AT(pad0);
  return n;
}

static uint probe_texture(__global uint *out, uint n) {
  Texture object, *p = &object;
  SIZE(Texture);
  AT(offset);
  AT(width);
  AT(height);
  AT(pad0);
  return n;
}

static uint probe_shading(__global uint *out, uint n) {
  TriangleShading object, *p = &object;
  SIZE(TriangleShading);
  AT(normal0);
  AT(normal1);
  AT(normal2);
  AT(object);
  AT(s0);
  AT(t0);
  AT(s1);
  AT(t1);
  AT(s2);
  AT(t2);
  AT(material);
  AT(pad0);
  return n;
}

__kernel void probe(__global uint *out) {
  uint n = 0u;
  n = probe_frame(out, n);
  n = probe_step(out, n);
  n = probe_light(out, n);
  n = probe_material(out, n);
  n = probe_texture(out, n);
  probe_shading(out, n);
}
