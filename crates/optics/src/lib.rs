//! Polarised light at one point: Stokes vectors, Mueller matrices, Fresnel reflection, reflectors.
//!
//! Everything here is a pure function of a few numbers and cannot fail. The crate knows nothing of
//! meshes, files, random numbers or units: a Stokes vector has the unit of whatever it describes.
//! The conventions (which axis is s, sense of rotation, sign of V and of κ) are those of
//! `docs/conventions.md`.
//!
//! A Stokes vector means nothing without the reference [`Basis`] of its beam. The *role* of that
//! basis is part of every type, so a product compiles only in the order in which light meets things:
//!
//! | role | the beam |
//! |---|---|
//! | [`Carried`] | on its way from one point to the next |
//! | [`Incidence`] | arriving at a surface, axis perpendicular to the plane of incidence |
//! | [`Emergence`] | leaving a surface |
//! | [`Sensor`] | arriving at a sensor, in the sensor's own frame: the only role in which beams add |
//!
//! Types tell kinds of basis apart, not two beams of one kind: which vector belongs to which beam
//! remains the caller's care.
//!
//! The number of components N is 1 (I), 3 (I, Q, U) or 4 (I, Q, U, V); a matrix is the leading block
//! of the textbook's 4 × 4, and fewer components give the same bits wherever nothing couples.
//!
//! Light reflected by glass at Brewster's angle, read by a sensor that faces it:
//!
//! ```
//! use glam::DVec3;
//! use malus_optics::{Basis, Carried, Incidence, Index, Rotator, Sensor, Stokes, angle_of_incidence};
//!
//! let glass = Index::new(1.5, 0.0);
//! let down = DVec3::new(1.5, 0.0, -1.0).normalize();
//! let lamp = Basis::<Carried>::new(down, DVec3::X);
//!
//! let (incidence, emergence) = Basis::<Incidence>::mirror(down, DVec3::Z);
//! let (cos_incidence, sin2_incidence) = angle_of_incidence(down, DVec3::Z);
//! let reflection = glass.reflection(cos_incidence, sin2_incidence);
//! let arriving = Rotator::new(&lamp, &incidence) * Stokes::<4, _>::unpolarised(1.0);
//! let leaving = (reflection * arriving).carried();
//!
//! let sensor = Basis::<Sensor>::new(emergence.direction(), DVec3::Y);
//! let [i, q, u, v] = (Rotator::new(&emergence.carried(), &sensor) * leaving).components();
//! assert!((i - 25.0 / 338.0).abs() < 1e-16 && (q - i).abs() < 1e-16);
//! assert!(u.abs() < 1e-16 && v.abs() < 1e-16);
//! ```

mod analyser;
mod basis;
#[cfg(test)]
mod chain;
#[cfg(test)]
mod field;
mod fresnel;
mod material;
mod mueller;
mod reflection;
mod representation;
mod rotator;
mod stokes;

pub use analyser::Analyser;
pub use basis::{Basis, Carried, Emergence, Incidence, Sensor, angle_of_incidence};
pub use fresnel::Index;
pub use material::{Coated, Material};
pub use mueller::Mueller;
pub use reflection::Reflection;
pub use representation::Representation;
pub use rotator::Rotator;
pub use stokes::Stokes;
