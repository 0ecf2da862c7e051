//! Looking for an emitter from a point of a walk.

use super::Walk;
use crate::emitters::Choice;
use crate::lookout::share_of;
use crate::medium::{Medium, target};
use crate::mirrors::Viewer;
use crate::path::{Connection, Path};
use crate::random::Purpose;
use crate::sight::Seen;
use glam::DVec3;

/// Who looks for an emitter, and for which.
pub(super) struct Look {
    pub viewer: Viewer,
    pub choice: Choice,
    /// What is not looked for straight.
    pub known: Seen,
    /// Probability with which the walk goes on from there into a random direction.
    pub diffuse: f64,
}

impl<'a> Walk<'a> {
    /// Appends what a point sees of one emitter, straight and in mirrors, weighted against other techniques.
    ///
    /// `coupling` is what [`Lookout::coupling`] says of the point.
    pub(super) fn connect(
        &self,
        path: &mut Path<'a>,
        look: &Look,
        coupling: &dyn Fn(DVec3) -> f64,
    ) {
        let Look {
            viewer,
            choice,
            known,
            diffuse,
        } = *look;
        let Medium {
            emitters, mirrors, ..
        } = self.medium;
        let uniforms = self.uniforms.at(self.depth, Purpose::Connect);
        let Some((site, preference)) = emitters.look(choice, &viewer, uniforms) else {
            return;
        };
        let area_density = site.area_density();
        // Light received, weighted, for a chain of this probability that was drawn with 1/inverse.
        let weighted =
            |toward: DVec3, leaving, square, odds: f64, probability: f64, inverse: f64| {
                let cos = toward.dot(viewer.normal);
                let by_chance = site.launched(leaving, square) * cos * odds;
                let density = area_density.unwrap_or(1.0);
                let looked = probability * preference * density;
                if looked <= 0.0 {
                    return 0.0;
                }
                let met = if area_density.is_some() {
                    diffuse * by_chance
                } else {
                    0.0
                };
                let local = coupling(toward) * by_chance * density;
                let weight = share_of(met / looked, local / looked);
                site.irradiance(leaving, square) * cos * inverse / preference * weight
            };
        let first = path.steps.len();
        let span = site
            .from
            .map_or(-site.direction(), |from| from - viewer.point);
        let square = span.length_squared();
        let toward = span / square.sqrt();
        let direct = !viewer.sensor || area_density.is_some() && !known.holds(site.patch);
        // A point at the source itself has no direction to it.
        if direct
            && toward.dot(viewer.normal) > 0.0
            && site.irradiance(-toward, square) > 0.0
            && square > 0.0
            && let Some(passage) =
                self.medium
                    .passage(viewer.point, site.from, toward, &mut path.steps)
        {
            path.connections.push(Connection {
                origin: site.origin,
                state: site.state,
                toward,
                leaving: -toward,
                irradiance: weighted(toward, -toward, square, passage.odds, 1.0, 1.0),
                steps: first..path.steps.len(),
                mirrored: false,
            });
        } else {
            path.steps.truncate(first);
        }
        if !self.looks_into_mirrors() {
            return;
        }
        let strength = |leaving, square| site.irradiance(leaving, square);
        let target = target(&site, self.medium.surfaces.radius(), &strength);
        mirrors.draw(
            &viewer,
            &target,
            self.uniforms,
            self.depth,
            |drawn, inverse| {
                let first = path.steps.len();
                let found = self.medium.drawn(&viewer, &target, drawn, &mut path.steps);
                let Some((way, probability)) = found else {
                    path.steps.truncate(first);
                    return;
                };
                let (toward, leaving) = (way.start, -way.arriving);
                path.connections.push(Connection {
                    origin: site.origin,
                    state: site.state,
                    toward,
                    leaving,
                    irradiance: weighted(
                        toward,
                        leaving,
                        way.square,
                        way.odds,
                        probability,
                        inverse / way.drawn,
                    ),
                    steps: first..path.steps.len(),
                    mirrored: true,
                });
            },
        );
    }
}
