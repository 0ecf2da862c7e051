//! What the user describes: a scene file with its meshes becomes a checked [`Scene`].
//!
//! [`Scene::load`] reads the TOML, the mesh files and the point files it names, gives custom properties and material
//! fields their meaning, and refuses what is wrong with the place where it stands. `docs/scene-format.md` is the
//! reference of every key. [`Report`] is what `malus check` prints.
//!
//! This crate computes no light and prints nothing.
//!
//! ```
//! use malus_scene::{Override, Scene};
//!
//! # let folder = tempfile::tempdir()?;
//! let path = folder.path().join("room.toml");
//! std::fs::write(&path, r#"
//!     [[shape]]
//!     kind = "box"
//!     min = [0, 0, 0]
//!     max = [1, 1, 1]
//!     inward = true
//!     material = "plaster"
//!
//!     [material.plaster]
//!     rho = 0.5
//!
//!     [[source]]
//!     kind = "point"
//!     position = [0.5, 0.5, 0.9]
//!     intensity = 10
//!
//!     [[sensor]]
//!     name = "floor"
//!     grid = { origin = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0], counts = [9, 9] }
//! "#)?;
//! let glossy = Override { key: "material.plaster.a".into(), value: "0.6".into() };
//! let scene = Scene::load(&path, &[glossy])?;
//! assert_eq!(scene.sensors[0].points.len(), 81);
//! assert_eq!(scene.surfaces.len(), 12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod allowed;
mod appearance;
mod assembly;
mod camera;
mod check;
mod defects;
mod document;
mod enclosed;
mod error;
mod file;
mod fingerprint;
mod flush;
mod foundation;
mod import;
mod leaks;
mod material;
mod nearest;
mod need;
mod overrides;
mod panes;
mod place;
mod placing;
mod polarisation;
mod properties;
mod reader;
mod scene;
mod sensor;
mod settings;
mod shape;
mod source;
mod study;
mod unit;

pub use camera::Camera;
pub use check::{CameraReport, EmitterReport, MaterialReport, Report, SensorReport, ValueReport};
pub use error::Error;
pub use fingerprint::Fingerprint;
pub use material::{Emission, Material, Origin, Value};
pub use need::Need;
pub use overrides::Override;
pub use scene::Scene;
pub use sensor::{Frame, Layout, Quantity, Sensor, SensorPoint};
pub use settings::{Estimator, Model, Settings};
pub use source::{Distribution, Source, SourceKind};
pub use study::{Base, Study, Variant};
pub use unit::Unit;
