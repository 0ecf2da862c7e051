//! What a walk from a sensor knows of the other ways in which the light it meets might have been found.

use crate::emitters::Choice;
use crate::medium::Medium;
use crate::mirrors::{Chain, Viewer};
use crate::receiver::Receiver;
use crate::sight::Seen;
use crate::techniques::Techniques;
use glam::DVec3;
use malus_geometry::Hit;
use std::f64::consts::PI;

/// Mirrors and panes since a point, as a walk has passed them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Passed {
    /// The mirrors, where all of them can be looked into; `None` once one cannot.
    facets: Option<Chain>,
    /// Probability of the events on the way.
    pub odds: f64,
    /// Whether there was a pane.
    panes: bool,
    /// Length of the way, in m.
    length: f64,
}

impl Passed {
    /// Nothing passed yet.
    pub(crate) fn nothing() -> Self {
        Self {
            facets: Some(Chain::new()),
            odds: 1.0,
            panes: false,
            length: 0.0,
        }
    }

    /// Passes a mirror.
    pub(crate) fn reflect(&mut self, facet: Option<u32>, odds: f64) {
        self.odds *= odds;
        match (&mut self.facets, facet) {
            (Some(facets), Some(facet)) => facets.push(facet),
            (facets, _) => *facets = None,
        }
    }

    /// Passes a pane.
    pub(crate) fn pass(&mut self, odds: f64) {
        self.odds *= odds;
        self.panes = true;
    }

    /// Goes on by a distance in m.
    pub(crate) fn go(&mut self, distance: f64) {
        self.length += distance;
    }

    /// Whether no mirror has been passed.
    pub(crate) fn is_straight(&self) -> bool {
        self.facets.as_ref().is_some_and(Chain::is_empty)
    }

    /// Whether nothing has been passed.
    pub(crate) fn is_clear(&self) -> bool {
        self.is_straight() && !self.panes
    }

    /// The mirrors passed, if all can be looked into.
    pub(crate) fn facets(&self) -> Option<&[u32]> {
        self.facets.as_deref()
    }

    /// Square of the length of the way, in m².
    pub(crate) fn square(&self) -> f64 {
        self.length * self.length
    }
}

/// Weight of one way in which a walk from a sensor finds light, beside its `other` way and beside walks from emitters, the
/// densities of which are given in units of its own.
///
/// Sensors and emitters share the light by their densities (balance heuristic; Veach & Guibas 1995), looking and meeting
/// by the squares of theirs (power heuristic, ibid.): of a lamp that is looked at, what is met by rare chance is noise.
pub(crate) fn share_of(other: f64, launched: f64) -> f64 {
    let both = 1.0 + other;
    // Behind thousands of mirrors densities leave the range of numbers: what is never drawn answers for nothing.
    if !both.is_finite() {
        return 0.0;
    }
    both / (both + launched) * (1.0 / (1.0 + other * other))
}

/// The last point of a walk that could have looked for light, and the way since.
#[derive(Debug, Clone)]
pub(crate) struct Lookout {
    /// The point.
    pub viewer: Viewer,
    /// Where it looked.
    pub choice: Choice,
    /// True where it could not: a sensor of radiance.
    pub alone: bool,
    /// For a sensor: what it need not look for straight.
    pub seen: Seen,
    /// Mirrors and panes passed since.
    pub chain: Passed,
    /// Probability with which the walk went on from there into a random direction.
    diffuse: f64,
    /// Cosine of that direction to the normal.
    cos: f64,
    /// See [`Lookout::coupling`].
    local: f64,
    /// See [`Lookout::crossed`].
    bridged: f64,
    /// Whether the walk has first scattered here.
    bridge: bool,
    /// How often a walk that is aimed at small mirrors goes the way of this one, for one that is not.
    aimed: f64,
    /// Whether it is the sensor.
    sensor: bool,
    /// Its share in what is found behind the first vertex, beside its neighbours.
    share: f64,
}

impl Lookout {
    /// A sensor of irradiance, with the direction of the walk.
    pub(crate) fn of_sensor(receiver: &Receiver, direction: DVec3, choice: Choice) -> Self {
        let viewer = Viewer {
            point: receiver.origin,
            normal: receiver.normal,
            sensor: true,
        };
        Self {
            viewer,
            choice,
            alone: false,
            seen: receiver.seen,
            chain: Passed::nothing(),
            diffuse: 1.0,
            cos: viewer.normal.dot(direction),
            local: 0.0,
            bridged: 0.0,
            bridge: false,
            aimed: 0.0,
            sensor: true,
            share: 1.0,
        }
    }

    /// A sensor of radiance: nothing but the walk itself can find what arrives from its direction.
    pub(crate) fn along(receiver: &Receiver) -> Self {
        Self {
            alone: true,
            ..Self::of_sensor(receiver, receiver.normal, Choice::Areas)
        }
    }

    /// Goes on by a distance in m.
    pub(crate) fn go(&mut self, distance: f64) {
        self.chain.go(distance);
    }

    /// Passes a small mirror at which a companion is aimed with this density per solid angle.
    pub(crate) fn aimed(&mut self, density: f64) {
        self.aimed = density * PI / self.cos;
    }

    /// Shares what is found behind the first vertex with neighbours.
    pub(crate) fn share(&mut self, share: f64) {
        self.share = share;
    }

    /// How often walks from emitters come by a point that this walk has reached and are joined to the sensor there, or
    /// from there to this walk, for one walk from the sensor that looks at an emitter from it: multiplied by the density
    /// with which such a walk arrives, it competes with the probability of looking.
    ///
    /// The walk arrives under the cosine `cos`; a walk that came the other way would be scattered with the probability
    /// `diffuse`.
    pub(crate) fn coupling(&self, cos: f64, diffuse: f64, techniques: Techniques) -> f64 {
        self.joined(cos, techniques) + self.crossed(cos, diffuse, techniques)
    }

    /// Of those, the walks that are joined to the sensor.
    fn joined(&self, cos: f64, techniques: Techniques) -> f64 {
        if !self.sensor || self.alone || !self.chain.is_straight() || techniques.local <= 0.0 {
            0.0
        } else {
            techniques.local * self.apart(cos) * self.share / self.chain.odds
        }
    }

    /// Of those, the walks that are joined to this walk where it first scattered.
    fn crossed(&self, cos: f64, diffuse: f64, techniques: Techniques) -> f64 {
        if !self.bridge {
            self.bridged * diffuse
        } else if self.chain.is_clear() {
            techniques.bridged * self.apart(cos) / self.diffuse
        } else {
            0.0
        }
    }

    /// π r²/(cos cos′) of the way from the last point, in m².
    fn apart(&self, cos: f64) -> f64 {
        PI * self.chain.square() / (self.cos * cos)
    }

    /// Whether the walk has not been scattered yet.
    pub(crate) fn is_sensor(&self) -> bool {
        self.sensor
    }

    /// Passes a diffuse event, which has the probability `diffuse` this way and `reverse` the other way.
    pub(crate) fn scatter(
        &mut self,
        viewer: Viewer,
        arriving_cos: f64,
        direction: DVec3,
        diffuse: f64,
        reverse: f64,
        techniques: Techniques,
    ) {
        // Between the last point and this one, both ways pass the same distances: only the ends differ.
        self.local = self.joined(arriving_cos, techniques) / diffuse;
        self.bridged = self.crossed(arriving_cos, reverse, techniques) / diffuse;
        self.bridge = self.sensor;
        self.aimed = 0.0;
        self.sensor = false;
        self.alone = false;
        self.viewer = viewer;
        self.choice = Choice::All;
        self.chain = Passed::nothing();
        self.diffuse = diffuse;
        self.cos = viewer.normal.dot(direction);
    }

    /// Weight of the light that a surface of this exitance sends to the walk, met under the cosine `cos`.
    pub(crate) fn emission_share(
        &self,
        medium: &Medium,
        techniques: Techniques,
        hit: &Hit,
        cos: f64,
        exitance: f64,
    ) -> f64 {
        if self.alone {
            return 1.0;
        }
        if self.sensor
            && self.chain.is_straight()
            && self.seen.holds(medium.emitters.patch(hit.triangle))
        {
            return 0.0;
        }
        let probability = match self.chain.facets() {
            Some(facets) if facets.is_empty() || techniques.mirrored => {
                let total = medium.emitters.flux(self.choice);
                let site = medium.emitters.site_on(hit.triangle, hit.position, total);
                let seen = match facets {
                    [] => 1.0,
                    _ => medium.chain_probability(&self.viewer, &site, facets),
                };
                medium.emitters.preference(&self.viewer, &site) * seen
            }
            _ => 0.0,
        };
        let distance = self.chain.length + hit.distance;
        // All as densities per solid angle at the last point, divided by that of meeting the light by chance but for the
        // events on the way: over thousands of them their probability leaves the range of numbers.
        let density = medium.emitters.density(self.choice, exitance);
        let by_chance = self.diffuse * self.cos / PI;
        let local = (self.local + self.bridged) * density;
        if probability <= 0.0 {
            return 1.0 / (1.0 + local + self.aimed);
        }
        let met = by_chance * self.chain.odds;
        let looked = probability * density * distance * distance / cos;
        share_of(looked / met, local)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ways_of_finding_light_share_it_without_rest() {
        // Densities of looking, of meeting by chance, and of walks from emitters.
        for [looked, met, launched] in [
            [1.0, 1.0, 1.0],
            [1e3, 1e-2, 5.0],
            [1e-9, 4.0, 0.0],
            [2.0, 7.0, 1e6],
        ] {
            let by_looking = share_of(met / looked, launched / looked);
            let by_chance = share_of(looked / met, launched / met);
            let from_emitters = launched / (looked + met + launched);
            assert!((by_looking + by_chance + from_emitters - 1.0).abs() < 1e-14);
            assert!(by_looking >= 0.0 && by_chance >= 0.0);
        }
        // What walks were never drawn for, or not to be told from that, answers for nothing.
        for (other, launched, share) in [
            (f64::INFINITY, f64::INFINITY, 0.0),
            (f64::NAN, 0.0, 0.0),
            (0.0, f64::INFINITY, 0.0),
            (0.0, 0.0, 1.0f64),
        ] {
            assert_eq!(
                share_of(other, launched).to_bits(),
                share.to_bits(),
                "{other} {launched}"
            );
        }
    }
}
