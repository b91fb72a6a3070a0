// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes from files: OBJ, MTL, textures, `view.json`; triangulation, normals, fitted views.

mod assemble;
pub(super) mod fit;
mod lines;
mod load;
mod locate;
mod mtl;
pub(super) mod normals;
mod obj;
mod texture;
mod triangulate;
mod view;

pub use load::load;
pub(crate) use view::complete as complete_view;
