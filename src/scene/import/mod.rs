// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes from files: OBJ, MTL, textures, `view.json`; triangulation, normals, fitted views.

mod assemble;
mod find;
pub(super) mod fit;
mod lines;
mod load;
mod locate;
mod material;
mod mtl;
pub(super) mod normals;
mod notices;
mod obj;
mod options;
mod origin;
mod source;
mod texture;
mod triangulate;
mod twins;
mod unused;
mod view;

pub use load::{load, load_from, load_listing, load_with};
pub use options::LoadOptions;
pub use source::FileSource;
pub(crate) use view::complete as complete_view;
