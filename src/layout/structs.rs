// SPDX-License-Identifier: MIT OR Apache-2.0
//! Structs that host and kernels share: the mirror of `kernels/types.h`, which is the truth. Sizes are asserted here, sizes
//! and offsets by a probe kernel in the tests and in `rarefy selftest`.

use bytemuck::{Pod, Zeroable};

use super::flags::{FailMask, StepFlags};

/// `FrameParams` of `kernels/types.h`: what stays the same for a whole frame or one window of it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct FrameParams {
    pub eye: [f32; 4],
    pub forward: [f32; 4],
    pub right: [f32; 4],
    pub up: [f32; 4],
    pub ambient: [f32; 4],
    pub background: [f32; 4],
    pub bounds_min: [f32; 4],
    pub bounds_max: [f32; 4],
    pub width: u32,
    pub height: u32,
    pub block: u32,
    pub phase_width: u32,
    pub phase_height: u32,
    pub plane_pitch: u32,
    pub light_count: u32,
    pub depth_limit: u32,
    pub epsilon: f32,
    pub window_begin: u32,
    pub window_end: u32,
    pub interior_begin: u32,
    pub interior_end: u32,
    pub pad: [u32; 3],
}
const _: () = assert!(size_of::<FrameParams>() == 192);

/// `StepParams` of `kernels/types.h`: what one launch works on.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct StepParams {
    pub origin_x: u32,
    pub origin_y: u32,
    pub step_x: u32,
    pub step_y: u32,
    pub grid_width: u32,
    pub grid_height: u32,
    pub reference_dx: u32,
    pub reference_dy: u32,
    pub item_count: u32,
    pub list_offset: u32,
    pub source_offset: u32,
    pub sums_offset: u32,
    pub t_pos: f32,
    pub t_norm: f32,
    pub t_conv: f32,
    pub t_tex: f32,
    pub t_gcol: f32,
    pub tests: FailMask,
    pub flags: StepFlags,
    pub scan_group: u32,
    pub t_visible: u32,
    pub list_end: u32,
    pub pixel_class: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<StepParams>() == 96);

/// `Light` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Light {
    pub position: [f32; 4],
    pub intensity: [f32; 4],
}
const _: () = assert!(size_of::<Light>() == 32);

/// `Material` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Material {
    pub diffuse: [f32; 4],
    pub specular: [f32; 4],
    pub reflectance: [f32; 4],
    pub transmission: [f32; 4],
    pub emission: [f32; 4],
    pub surface: u32,
    pub diffuse_texture: u32,
    pub cutout_texture: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<Material>() == 96);

/// `Texture` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Texture {
    pub offset: u32,
    pub width: u32,
    pub height: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<Texture>() == 16);

/// A triangle as traversal reads it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    /// The corners. The first one's fourth float holds `TRIANGLE_*` bits and, from `TRIANGLE_AXIS_SHIFT` on, the axis
    /// along which the plane's normal is longest; those of the others hold the normal's components along the next axis
    /// and the one after, over that along the longest.
    pub corners: [[f32; 4]; 3],
}
const _: () = assert!(size_of::<Triangle>() == 48);

/// `TriangleShading` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct TriangleShading {
    pub normals: [u32; 3],
    pub object: u32,
    /// `s` and `t` of the three corners in turn.
    pub texcoords: [f32; 6],
    pub material: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<TriangleShading>() == 48);

/// A size or an offset that host and device must agree about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayoutEntry {
    /// `FrameParams` for the size of a struct, `FrameParams.eye` for the offset of a member.
    pub name: &'static str,
    /// Bytes.
    pub bytes: u32,
}

/// Size and member offsets of a struct; `member = field[i]` for an element of an array that is a member in kernels.
macro_rules! layout_of {
    ($type:ident { $($member:ident $(= $field:ident[$at:literal])?),* $(,)? }) => {
        [
            LayoutEntry { name: stringify!($type), bytes: size_of::<$type>() as u32 },
            $(LayoutEntry {
                name: concat!(stringify!($type), ".", stringify!($member)),
                bytes: layout_of!(@offset $type $member $($field $at)?),
            }),*
        ]
    };
    (@offset $type:ident $member:ident) => { std::mem::offset_of!($type, $member) as u32 };
    (@offset $type:ident $member:ident $field:ident $at:literal) => {
        (std::mem::offset_of!($type, $field) + $at * size_of::<u32>()) as u32
    };
}

/// What the probe kernel must report, in its order: the size of each shared struct and the offset of every member.
pub fn struct_layout() -> Vec<LayoutEntry> {
    [
        &layout_of!(FrameParams {
            eye, forward, right, up, ambient, background, bounds_min, bounds_max, width, height, block, phase_width,
            phase_height, plane_pitch, light_count, depth_limit, epsilon, window_begin, window_end, interior_begin,
            interior_end, pad0 = pad[0], pad1 = pad[1], pad2 = pad[2],
        })[..],
        &layout_of!(StepParams {
            origin_x,
            origin_y,
            step_x,
            step_y,
            grid_width,
            grid_height,
            reference_dx,
            reference_dy,
            item_count,
            list_offset,
            source_offset,
            sums_offset,
            t_pos,
            t_norm,
            t_conv,
            t_tex,
            t_gcol,
            tests,
            flags,
            scan_group,
            t_visible,
            list_end,
            pixel_class,
            pad0,
        }),
        &layout_of!(Light { position, intensity }),
        &layout_of!(Material {
            diffuse,
            specular,
            reflectance,
            transmission,
            emission,
            surface,
            diffuse_texture,
            cutout_texture,
            pad0,
        }),
        &layout_of!(Texture { offset, width, height, pad0 }),
        &layout_of!(TriangleShading {
            normal0 = normals[0], normal1 = normals[1], normal2 = normals[2], object, s0 = texcoords[0],
            t0 = texcoords[1], s1 = texcoords[2], t1 = texcoords[3], s2 = texcoords[4], t2 = texcoords[5], material,
            pad0,
        }),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The structs of a header and their members, named as in [`struct_layout`].
    fn declared(header: &str) -> Vec<String> {
        let mut names = Vec::new();
        for body in header.split("typedef struct {").skip(1) {
            let (members, rest) = body.split_once('}').unwrap();
            let name = rest.split(';').next().unwrap().trim();
            names.push(name.to_owned());
            let lines = members.lines().map(|line| line.split("//").next().unwrap());
            for member in lines.filter_map(|line| line.trim().strip_suffix(';')) {
                names.push(format!("{name}.{}", member.rsplit(' ').next().unwrap()));
            }
        }
        names
    }

    /// What the probe kernel writes, in order.
    fn probed(kernel: &str) -> Vec<String> {
        let (mut names, mut of) = (Vec::new(), String::new());
        for line in kernel.lines() {
            let argument = |of: &str| Some(line.trim().strip_prefix(of)?.strip_suffix(");")?.to_owned());
            if let Some(name) = argument("SIZE(") {
                of = name;
                names.push(of.clone());
            } else if let Some(member) = argument("AT(") {
                names.push(format!("{of}.{member}"));
            }
        }
        names
    }

    #[test]
    fn every_member_of_every_shared_struct_is_probed() {
        let header = include_str!("../../kernels/types.h");
        let listed: Vec<String> = struct_layout().iter().map(|entry| entry.name.to_owned()).collect();
        let shared = |names: Vec<String>| -> Vec<String> {
            names.into_iter().filter(|name| name.split('.').next() != Some("Work")).collect()
        };
        assert_eq!(shared(declared(header)), listed, "kernels/types.h has other members");
        assert_eq!(probed(include_str!("../../kernels/probe.cl")), listed, "kernels/probe.cl reports something else");
        // A member that nobody lists is seen, and so are two in another order.
        let more = header.replace("  uint tests;", "  uint tests;\n  uint more;");
        assert_eq!(declared(&more).len(), declared(header).len() + 1);
        let swapped = header.replace("float t_pos;", "float x;").replace("float t_norm;", "float t_pos;");
        assert_ne!(shared(declared(&swapped.replace("float x;", "float t_norm;"))), listed);
    }
}
