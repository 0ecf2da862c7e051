//! What a walk from an emitter knows of the other ways in which its light might have reached a sensor.

use crate::lookout::Passed;
use crate::medium::Medium;
use crate::mirrors::{Chain, Viewer};
use crate::site::{Site, Start};
use crate::techniques::Techniques;
use glam::DVec3;

/// The techniques that compete with joining a point of a walk to a sensor, in units of that.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Rival {
    /// Walks from the sensor that look at the emitter at the end.
    looked: f64,
    /// Walks from the sensor that meet the emitter by chance.
    met: f64,
    /// Whether this is the first point that scatters.
    pub first: bool,
    /// Nothing else can have found this light: it comes from a source without area by a mirror that none looks into.
    pub alone: bool,
}

impl Rival {
    /// Weight of joining the point to a sensor by a way of the given coupling cos θ cos θ′/(π r²), in 1/m².
    ///
    /// A walk that came from the sensor would be scattered at the point with the probability `diffuse`, and there are
    /// `walks` walks from emitters for one such walk.
    #[inline]
    pub(crate) fn weight(&self, coupling: f64, diffuse: f64, walks: f64) -> f64 {
        1.0 / (1.0 + coupling / walks * self.searching(diffuse))
    }

    /// Walks from the sensor that find the emitter by themselves.
    #[inline]
    pub(crate) fn searching(&self, diffuse: f64) -> f64 {
        if self.first {
            self.looked + diffuse * self.met
        } else {
            diffuse * (self.looked + self.met)
        }
    }
}

/// A walk from an emitter, as other techniques would see it.
#[derive(Debug, Clone)]
pub(crate) struct Launched<'a> {
    site: Site<'a>,
    /// Direction in which it left.
    leaving: DVec3,
    /// Mirrors and panes passed since the last diffuse event.
    pub chain: Passed,
    /// After such an event: what competes at the next point, but for the probability of being scattered there.
    left: Option<Rival>,
}

impl<'a> Launched<'a> {
    /// A walk that starts.
    pub(crate) fn new(start: &Start<'a>) -> Self {
        Self {
            site: start.site,
            leaving: start.direction,
            chain: Passed::nothing(),
            left: None,
        }
    }

    /// Goes on by a distance in m.
    pub(crate) fn go(&mut self, distance: f64) {
        self.chain.go(distance);
    }

    /// What competes with joining a point that scatters, met under the cosine `cos`, to a sensor.
    pub(crate) fn rival(
        &self,
        medium: &Medium,
        techniques: Techniques,
        viewer: Viewer,
        cos: f64,
    ) -> Rival {
        if let Some(left) = self.left {
            return left;
        }
        let area_density = self.site.area_density();
        let seen = match self.chain.facets() {
            Some([]) => 1.0,
            Some(facets) if techniques.mirrored => {
                let seen: Chain = facets.iter().rev().copied().collect();
                medium.chain_probability(&viewer, &self.site, &seen)
            }
            _ => 0.0,
        };
        let probability = match seen > 0.0 {
            true => seen * medium.emitters.preference(&viewer, &self.site),
            false => 0.0,
        };
        let arrived = self.site.launched(self.leaving, self.chain.square()) * cos * self.chain.odds;
        Rival {
            // Over thousands of mirrors both may leave the range of numbers: what is never drawn is no rival.
            looked: if probability > 0.0 {
                probability / arrived
            } else {
                0.0
            },
            met: area_density.map_or(0.0, |density| 1.0 / density),
            first: true,
            alone: area_density.is_none() && probability <= 0.0,
        }
    }

    /// Passes a diffuse event at a point with this rival; `diffuse` is its probability, `reverse` that of the same event on
    /// the way back.
    pub(crate) fn scatter(&mut self, at: Rival, diffuse: f64, reverse: f64) {
        let rival = if at.first {
            Rival {
                looked: at.looked / diffuse,
                met: at.met * reverse / diffuse,
                first: false,
                ..at
            }
        } else {
            Rival {
                looked: at.looked * reverse / diffuse,
                met: at.met * reverse / diffuse,
                ..at
            }
        };
        self.left = Some(rival);
        self.chain = Passed::nothing();
    }
}
