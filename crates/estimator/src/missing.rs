//! Light that an estimator cannot see, as walks from the emitters tell it: what `choose::blind_spots` says in words.

use crate::path::{Event, Vertex};
use crate::site::Start;
use malus_scene::Estimator;

/// How light has come to where it is, as far as that decides whether an estimator can see it there.
#[derive(Debug, Clone)]
pub(crate) struct Trail {
    estimator: Estimator,
    /// It comes from a source without area, which no walk meets.
    pointlike: bool,
    /// It has been scattered.
    scattered: bool,
    /// A mirror that the estimator does not look into keeps its source from the first surface that scattered it.
    hidden: bool,
    /// Since it was last scattered, or emitted, it has passed such a mirror.
    mirrored: bool,
}

impl Trail {
    /// Light that starts.
    pub(crate) fn new(estimator: Estimator, start: &Start) -> Self {
        Self {
            estimator,
            pointlike: start.site.area_density().is_none(),
            scattered: false,
            hidden: false,
            mirrored: false,
        }
    }

    /// Goes past a vertex.
    pub(crate) fn pass(&mut self, vertex: &Vertex) {
        match vertex.event {
            Event::Absorbed | Event::Through => {}
            Event::Diffuse => {
                self.scattered = true;
                self.mirrored = false;
            }
            Event::Mirror => {
                let looked_into = self.estimator == Estimator::Auto && vertex.flat;
                self.mirrored |= !looked_into;
                self.hidden |= !looked_into && !self.scattered && self.pointlike;
            }
        }
    }

    /// Whether the estimator would miss this light at a sensor on the next surface.
    pub(crate) fn is_missing(&self) -> bool {
        match self.estimator {
            // Walks from the emitters are joined to sensors straight alone.
            Estimator::Local => self.mirrored,
            // Walks from the sensors look at sources straight alone.
            Estimator::Gather => self.hidden,
            Estimator::Auto => self.hidden && self.mirrored,
            Estimator::Direct => false,
        }
    }
}
