// SPDX-License-Identifier: MIT OR Apache-2.0
//! OpenCL contexts, and small kernels to launch in them.

use rarefy::internal::device::opencl::{
    Arg, CacheFolder, Context, DeviceLaunch, Kernel, OpenOptions, Profile, ProgramSource, build_log, open_with,
};

use crate::frames::WITHOUT_OPENCL;

/// Options without a cache.
pub fn options() -> OpenOptions {
    OpenOptions { cache: CacheFolder::Off, ..OpenOptions::default() }
}

/// Opens a context.
///
/// # Panics
/// If there is no OpenCL.
pub fn context_with(options: &OpenOptions) -> Context {
    open_with(options).unwrap_or_else(|error| panic!("{error} (or set {WITHOUT_OPENCL}=none)"))
}

/// A context without a cache.
pub fn context() -> Context {
    context_with(&options())
}

/// A profile called `tight` of these limits alone: key of the query, value as JSON.
pub fn profile(limits: &[(&str, &str)]) -> Profile {
    let limits: Vec<String> = limits
        .iter()
        .map(|(key, value)| format!(r#""{key}":{{"value":{value},"certainty":"inferred","source":"test"}}"#))
        .collect();
    Profile::from_json("tight", &format!(r#"{{"limits":{{{}}}}}"#, limits.join(","))).unwrap()
}

/// A context under [`profile`].
pub fn context_under(limits: &[(&str, &str)]) -> Context {
    context_with(&OpenOptions { profile: Some(profile(limits)), ..options() })
}

/// A program of four small kernels.
pub const SOURCE: &str = "
typedef struct { uint width, height; float scale; uint bias; } params_t;

kernel void count(global uint *out, uint width, uint height) {
    uint x = (uint)get_global_id(0), y = (uint)get_global_id(1);
    if (x >= width || y >= height) return;
    out[y * width + x] += y * width + x + 1u;
}

kernel void scale(global float *out, params_t p) {
    uint i = (uint)get_global_id(0);
    if (i < p.width * p.height) out[i] = (float)i * p.scale + (float)p.bias;
}

kernel void sum(global const uint *in, global uint *out, local uint *part, uint n) {
    uint i = (uint)get_global_id(0), l = (uint)get_local_id(0);
    part[l] = i < n ? in[i] : 0u;
    for (uint half_size = (uint)get_local_size(0) / 2u; half_size > 0u; half_size /= 2u) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (l < half_size) part[l] += part[l + half_size];
    }
    if (l == 0u) atomic_add(out, part[0]);
}

kernel void pick(constant uint *a, constant uint *b, global uint *out) {
    if (get_global_id(0) == 0) out[0] = a[0] + b[0];
}
";

/// A kernel of [`SOURCE`].
pub fn kernel(context: &Context, name: &str) -> Kernel {
    let source = build_log::assemble(&[("context-test.cl", SOURCE)]);
    context
        .program(&ProgramSource { name: "context-test", source: &source, options: "" })
        .unwrap()
        .kernel(name)
        .unwrap()
}

/// Runs `count` on a picture and returns it: index + 1 everywhere if each work-item ran once.
pub fn count(context: &Context, width: usize, height: usize, local: Option<[usize; 2]>) -> Vec<u32> {
    let kernel = kernel(context, "count");
    let out = context.buffer::<u32>("out", width * height).unwrap();
    context.fill_zero(&out).unwrap();
    let (w, h) = (width as u32, height as u32);
    let args = [Arg::Buffer(&out), Arg::Value(&w.to_ne_bytes()), Arg::Value(&h.to_ne_bytes())];
    context
        .launch(&DeviceLaunch {
            label: "count",
            kernel: &kernel,
            args: &args,
            global: [width, height],
            local,
            barrier: false,
        })
        .unwrap();
    context.read(&out, 0..width * height).unwrap()
}

/// Whether [`count`] found that each work-item ran once.
pub fn counted(values: &[u32]) -> bool {
    values.iter().enumerate().all(|(index, &value)| value == index as u32 + 1)
}

/// Sums the numbers below 1000 in work-groups of `local`: with barriers and local memory.
///
/// # Errors
/// A limit, or a failing call.
pub fn launch_sum(context: &Context, local: usize) -> rarefy::Result<u32> {
    let kernel = kernel(context, "sum");
    let values: Vec<u32> = (0..1000).collect();
    let input = context.buffer_from("in", &values)?;
    let out = context.buffer_from("out", &[0u32])?;
    let n = 1000u32.to_ne_bytes();
    let args = [Arg::Buffer(&input), Arg::Buffer(&out), Arg::Local(local * 4), Arg::Value(&n)];
    let local = Some([local, 1]);
    context.launch(&DeviceLaunch {
        label: "sum",
        kernel: &kernel,
        args: &args,
        global: [1000, 1],
        local,
        barrier: true,
    })?;
    Ok(context.read(&out, 0..1)?[0])
}
