//! What a surface does to light, and where each value of it comes from.

pub(crate) mod kind;
pub(crate) mod library;
pub(crate) mod resolve;

use glam::DVec3;
use std::fmt;

/// What one surface does to light.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the mesh file or the scene file.
    pub name: String,
    /// The object that this combination of values is for, where its custom properties or its axis matter.
    pub object: Option<String>,
    /// Reflection.
    pub optics: malus_optics::Material,
    /// False: the side away from the normal is black.
    pub two_sided: bool,
    /// Emission, always on the side of the normal only; `None` where the exitance is zero.
    pub emission: Option<Emission>,
    /// Every value with its origin, in the order of `docs/scene-format.md`.
    pub values: Vec<Value>,
}

/// Light emitted by a surface, as Lambert's law has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    /// Emitted flux per area M, in unit/m², > 0.
    pub exitance: f64,
    /// State of the emitted light as a Stokes vector with S0 = 1.
    pub state: [f64; 4],
    /// x axis of that state, a unit vector, to be made perpendicular to each emitted direction.
    pub axis: DVec3,
}

/// One value of a material, for `check`.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Key in the scene file.
    pub key: &'static str,
    /// The value in use, as text.
    pub value: String,
    /// Where it comes from.
    pub origin: Origin,
}

/// Where a value comes from, the most binding first.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// The scene file, under the material's exact name.
    Exact(String),
    /// The scene file, under a glob.
    Glob(String),
    /// A custom property of the object.
    Object(String),
    /// A custom property of the material.
    Property(String),
    /// A field of the mesh file's own material.
    Field(String),
    /// The default.
    Default,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact(at) => write!(f, "{at}"),
            Self::Glob(text) | Self::Object(text) | Self::Property(text) | Self::Field(text) => {
                write!(f, "{text}")
            }
            Self::Default => write!(f, "default"),
        }
    }
}
