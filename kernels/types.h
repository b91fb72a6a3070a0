// SPDX-License-Identifier: MIT OR Apache-2.0
// Structs shared with the host, and the macros that every kernel file builds on.
// This file is the truth; src/layout/structs.rs mirrors it and a probe kernel compares every size and offset.
// Numbers that both sides need (PLANE_*, CLASS_*, FAIL_*, SURFACE_*, ...) are build options made by src/layout/flavour.rs.
#ifndef RAREFY_TYPES_H
#define RAREFY_TYPES_H

#ifndef PLANE_COUNT
#error "build with the options of rarefy::layout::build_options()"
#endif

// No fused multiply-add, in strict and in fast builds: it gains 2 % under PoCL and moves one hit in ten thousand to
// another side of an edge (bathroom: 39 pixels of 512x512). Strict builds ask for correctly rounded division and square
// root besides, where the device has a choice.
#pragma OPENCL FP_CONTRACT OFF

// Members are 16-byte vectors or 32-bit scalars; sizes are multiples of 16.

// What stays the same for a whole frame, or for a window of its rows where it does not fit into memory.
typedef struct {
  float4 eye;           // xyz: position
  float4 forward;       // xyz: unit line of sight
  float4 right;         // xyz: from the middle of the image plane at distance 1 to its right border
  float4 up;            // xyz: likewise to its upper border
  float4 ambient;       // rgb: ambient light
  float4 background;    // rgb: what a ray that hits nothing sees
  float4 bounds_min;    // xyz: lower corner of the kd-tree's box
  float4 bounds_max;    // xyz: upper corner
  uint width;           // samples in a row
  uint height;          // rows of samples
  uint block;           // side of the base block: 1 (full tracing), 2 or 4
  uint phase_width;     // ceil(width / block)
  uint phase_height;    // ceil((window_end - window_begin) / block)
  uint plane_pitch;     // words of one attribute plane: block * block * phase_width * phase_height
  uint light_count;     // at most 32
  uint depth_limit;     // most secondary rays in a chain, straight ones through panes not counted
  float epsilon;        // thickness of the tree's cells around flat surfaces; anchor builds: offset of secondary rays
  uint window_begin;    // first row that the buffers hold, a multiple of block
  uint window_end;      // row behind the last that they hold
  uint interior_begin;  // rows of the window that step4 may trace; the others are context for checks and correction
  uint interior_end;
  uint pad0;
  uint pad1;
  uint pad2;
} FrameParams;

// What a launch works on. A grid launch covers the pixels origin + step * item; a list launch covers
// list[list_offset .. list_offset + item_count).
typedef struct {
  uint origin_x;
  uint origin_y;
  uint step_x;
  uint step_y;
  uint grid_width;      // items in a row of the grid
  uint grid_height;
  uint reference_dx;    // the two references of a pixel lie at minus and plus this many pixels
  uint reference_dy;
  uint item_count;      // items of a list launch; elements of a scan
  uint list_offset;     // first list entry to read (trace, mark) or to write (scatter)
  uint source_offset;   // correct: first list entry whose neighbours are looked at
  uint sums_offset;     // scan: first word of this level in the sums buffer
  float t_pos;          // G2, scene units
  float t_norm;         // G3
  float t_conv;         // G4, sine of an angle
  float t_tex;          // TX
  float t_gcol;         // GC
  uint tests;           // bit i set: test i is on
  uint flags;           // STEP_*
  uint scan_group;      // work-items of a scan's work-group, a power of two
  uint t_visible;       // correct: smallest difference of a channel of 0..255 treated as visible; 0: all pixels differ
  uint list_end;        // scatter, correct_tail: the first list entry that may not be written
  uint pixel_class;     // trace: what its pixels become; CLASS_BASE: those of the grid, another CLASS_*: those of the list
  uint pad0;
} StepParams;

// One light; position.w and intensity.w are unused.
typedef struct {
  float4 position;
  float4 intensity;
} Light;

// One material.
typedef struct {
  float4 diffuse;       // rgb: Kd; w: Ns
  float4 specular;      // rgb: Ks; w: index of refraction
  float4 reflectance;   // rgb: weight of a mirror's reflection; w: weight of the surface's own colour
  float4 transmission;  // rgb: Tf; w unused
  float4 emission;      // rgb: Ke, light that the surface sends of its own; w unused
  uint surface;         // SURFACE_*
  uint diffuse_texture; // index, or NO_TEXTURE
  uint cutout_texture;  // index, or NO_TEXTURE
  uint pad0;
} Material;

// One texture: where its texels lie.
typedef struct {
  uint offset;          // first word in the texel buffer
  uint width;
  uint height;
  uint pad0;
} Texture;

// What shading needs of a triangle, read once per hit.
typedef struct {
  uint normal0;         // packed corner normals
  uint normal1;
  uint normal2;
  uint object;
  float s0;             // texture coordinates of the corners
  float t0;
  float s1;
  float t1;
  float s2;
  float t2;
  uint material;
  uint pad0;
} TriangleShading;

// Every global pointer a ray needs. A triangle is three float4, its corners. The first w holds TRIANGLE_* bits and, from
// TRIANGLE_AXIS_SHIFT on, the axis along which its plane's normal is longest; the second and third w hold the normal's
// components along the next axis and the one after, over that along the longest.
#define SCENE_PARAMS                                                                                          \
  __constant FrameParams *frame, __constant Light *lights, __global const uint *nodes,                        \
      __global const uint *leaf_triangles, __global const float4 *triangles,                                  \
      __global const TriangleShading *triangle_shading, __global const Material *materials,                   \
      __global const uint *object_materials, __global const Texture *textures, __global const uint *texels,   \
      __global const uint *tables
#define SCENE_ARGS                                                                                            \
  frame, lights, nodes, leaf_triangles, triangles, triangle_shading, materials, object_materials, textures,   \
      texels, tables

// Work counters of one item, kept only in counting builds.
typedef struct {
  uint traversal_steps;
  uint triangle_tests;
  uint shadow_rays;
  uint reflection_rays;
  uint refraction_rays;
  uint shaded;
} Work;
#ifdef RAREFY_COUNT
#define COUNT(field) (work->field++)
#else
#define COUNT(field) ((void)0)
#endif

#endif
