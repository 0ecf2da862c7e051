//! Where surfaces are and what sees what.
//!
//! A [`Mesh`] is the whole scene as triangles in file order; [`Surfaces`] answers which of them a ray meets first
//! and whether two points see each other. [`shape`] makes geometry without a file, [`load`] reads files, [`defects`]
//! tells what is wrong with a mesh and [`solid`] which points lie inside closed objects.
//!
//! This crate knows nothing of light: materials, sources and sensors are indices and names to it.
//! Coordinates are metres, right-handed, Z up, in `f64`; single precision only culls, inside the tree of boxes.
//!
//! ```
//! use glam::DVec3;
//! use malus_geometry::{Mesh, Surfaces, shape};
//!
//! let mut mesh = Mesh::default();
//! let (positions, triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, true);
//! mesh.append(&positions, &triangles, 0, 0);
//! let room = Surfaces::new(mesh)?;
//!
//! let hit = room.nearest(DVec3::splat(0.5), DVec3::NEG_Z).expect("a closed room");
//! assert!((hit.distance - 0.5).abs() < 1e-12);
//! assert!(room.normal(hit.triangle).z > 0.99);
//! assert!(room.visible(DVec3::splat(0.25), DVec3::splat(0.75)));
//! assert!(!room.escapes(DVec3::splat(0.5), DVec3::X));
//! # Ok::<(), malus_geometry::Error>(())
//! ```

pub mod defects;
pub mod load;
pub mod shape;
pub mod solid;

mod bvh;
mod clean;
mod coincidence;
mod contour;
mod crossing;
mod edges;
mod error;
mod facets;
mod holes;
mod mesh;
mod patches;
mod planes;
mod polygon;
mod pyramid;
mod surfaces;
#[cfg(test)]
mod testing;
mod tiles;
mod triangle;
mod weld;

pub use bvh::{Layout, Preset, Targets, Tree, TreeFacts};
pub use clean::Cleaned;
pub use coincidence::Coincidence;
pub use error::Error;
pub use facets::{Facet, Facets};
pub use mesh::Mesh;
pub use patches::Patches;
pub use surfaces::{Hit, Surfaces};
pub use tiles::{Field, Grid, Tile, Tiles, jump};
pub use triangle::Triangle;
