//! The ways in which walks of one run find light.

use crate::cover::Cover;

/// Which techniques are weighed against each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Techniques {
    /// Vertices look for emitters in flat mirrors too.
    pub mirrored: bool,
    /// Walks from emitters, each joined to every sensor, for one walk from each sensor; 0: none.
    pub local: f64,
    /// Walks from emitters that a walk from a sensor is joined to where it first scatters; 0: none.
    pub block: u64,
    /// What they count for in the weights, at the sensor that a walk starts from.
    pub bridged: f64,
    /// Walks are taken from the sensors.
    pub gather: bool,
    /// Sensors share them with their neighbours, by a pilot.
    pub shared: bool,
}

impl Techniques {
    /// Walks from emitters with nothing beside them.
    pub(crate) const ALONE: Self = Self {
        mirrored: false,
        local: 1.0,
        bridged: 0.0,
        block: 0,
        gather: false,
        shared: false,
    };

    /// By how much likelier than one from a sensor a walk from an emitter is scattered: one such walk serves many others.
    pub(crate) fn launched(self, cover: &Cover) -> f64 {
        if self.block > 0 {
            cover.launched()
        } else {
            1.0
        }
    }
}
