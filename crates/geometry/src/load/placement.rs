//! Where a file's geometry stands in the world.

use super::LoadError;
use glam::{DAffine3, DMat3, DVec3};
use std::path::Path;

/// The axis that points up in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// Y, as glTF prescribes and Blender's OBJ exporter writes by default.
    #[default]
    Y,
    /// Z, as in the world.
    Z,
}

impl Up {
    /// The rotation from the file's axes to the world's: (x, y, z) → (x, −z, y) for [`Up::Y`]. Exact.
    #[must_use]
    pub fn turn(self) -> DMat3 {
        match self {
            Self::Y => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
            Self::Z => DMat3::IDENTITY,
        }
    }
}

/// Where a file's geometry stands in the world: first turned, then scaled, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Metres per unit of the file, > 0.
    pub scale: f64,
    /// The file's up axis.
    pub up: Up,
    /// Shift in the world, in metres.
    pub translate: DVec3,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            scale: 1.0,
            up: Up::Y,
            translate: DVec3::ZERO,
        }
    }
}

impl Placement {
    /// The map from the file's coordinates to the world's.
    #[must_use]
    pub fn transform(&self) -> DAffine3 {
        DAffine3 {
            matrix3: self.up.turn() * self.scale,
            translation: self.translate,
        }
    }

    pub(super) fn check(&self, file: &Path) -> Result<(), LoadError> {
        if !(self.scale.is_finite() && self.scale > 0.0) {
            return Err(LoadError::invalid(
                file,
                "scale",
                format!("{}", self.scale),
                "metres per unit of the file must be finite and above 0",
            ));
        }
        if !self.translate.is_finite() {
            return Err(LoadError::invalid(
                file,
                "translate",
                format!("{}", self.translate),
                "a shift must be finite",
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_up_is_turned_as_the_contract_says_then_scaled_then_moved() {
        let placement = Placement {
            scale: 0.5,
            up: Up::Y,
            translate: DVec3::new(10.0, 20.0, 30.0),
        };
        let point = placement
            .transform()
            .transform_point3(DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(point, DVec3::new(10.5, 18.5, 31.0));
    }

    #[test]
    fn z_up_is_left_as_it_is() {
        let placement = Placement {
            up: Up::Z,
            ..Placement::default()
        };
        let point = DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(placement.transform().transform_point3(point), point);
    }

    #[test]
    fn a_scale_that_is_no_length_is_refused() {
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let placement = Placement {
                scale,
                ..Placement::default()
            };
            assert!(placement.check(Path::new("room.glb")).is_err(), "{scale}");
        }
    }
}
