//! Joining the vertices of walks from the emitters to sensors.

use super::Sensors;
use crate::bridge::Landings;
use crate::evaluate::joined;
use crate::medium::{Medium, Step};
use crate::mirrors::{Target, Viewer};
use crate::pass::Effort;
use crate::path::{Path, Vertex};
use crate::random::Uniforms;
use crate::receiver::{Receiver, coupling};
use crate::site::Start;
use crate::techniques::Techniques;
use crate::trace::Walk;
use crate::variation::Variation;
use glam::DVec3;
use malus_geometry::Targets;
use malus_optics::angle_of_incidence;
use std::f64::consts::PI;

/// Joins the vertices of walks to sensors.
#[derive(Clone, Copy)]
pub(super) struct Joining<'r> {
    pub techniques: Techniques,
    pub sensors: &'r Sensors<'r>,
    pub uniforms: Uniforms,
}

/// A way on which a point is joined to a sensor.
pub(super) struct Joined {
    /// Direction at the point.
    pub direction: DVec3,
    /// cos θ cos θ′/(π r²), in 1/m².
    pub coupling: f64,
    /// Probability of passing the panes on the way.
    pub odds: f64,
}

/// Scattered light on its way from a vertex to a sensor.
pub(super) struct Arrival<'j> {
    receiver: &'j Receiver,
    vertex: &'j Vertex,
    /// Direction at the vertex.
    direction: DVec3,
    /// Irradiance for one unit of scattered flux, weighted against other techniques, in 1/m².
    weight: f64,
    /// Mirrors and panes on the way.
    steps: &'j [Step],
    /// Whether what is scattered there is polarised.
    polarised: bool,
}

impl Arrival<'_> {
    /// Adds the light of each variant's flux to its sums, of which there are `count`, from the `channel` on.
    pub fn add<const N: usize>(
        &self,
        sums: &mut [f64],
        count: usize,
        channel: usize,
        fluxes: &[f64],
        variations: &[Variation],
    ) {
        let of_variants = sums.chunks_mut(count).zip(fluxes.iter().zip(variations));
        if self.steps.is_empty() && !self.polarised {
            for (sums, (flux, _)) in of_variants {
                sums[channel] += flux * self.weight;
            }
            return;
        }
        for (sums, (flux, variation)) in of_variants {
            let Self {
                receiver,
                vertex,
                direction,
                steps,
                ..
            } = *self;
            let light = joined::<N>(receiver, vertex, direction, steps, variation);
            for (sum, component) in sums[channel..].iter_mut().zip(light.components()) {
                *sum += flux * self.weight * component;
            }
        }
    }
}

impl Joining<'_> {
    /// Takes a walk to its end and joins each diffuse vertex to every sensor.
    ///
    /// `evaluate` fills in the `width` fluxes that each vertex of a path takes in, of all variants and models; `add`
    /// receives the index of a sensor, these fluxes, and how they arrive there.
    pub fn follow<'a>(
        &self,
        medium: Medium<'a>,
        start: &Start<'a>,
        width: usize,
        landings: &mut Landings,
        mut evaluate: impl FnMut(&Path<'a>, &mut [f64]),
        mut add: impl FnMut(usize, &[f64], &Arrival),
    ) -> Effort {
        let mut walk = Walk::from_emitter(medium, self.techniques, self.uniforms, start);
        let mut effort = Effort::default();
        let mut path = Path::default();
        let mut fluxes = Vec::new();
        let mut depth = 0;
        landings.start();
        loop {
            path.clear();
            let more = walk.advance(&mut path);
            effort.rays += path.vertices.len() as u64;
            fluxes.clear();
            fluxes.resize(path.vertices.len() * width, 0.0);
            evaluate(&path, &mut fluxes);
            for (vertex, fluxes) in path.vertices.iter().zip(fluxes.chunks(width)) {
                depth += 1;
                if fluxes.iter().any(|&f| f > 0.0) {
                    if self.techniques.block > 0 {
                        landings.push(&medium, vertex, fluxes, self.uniforms, depth);
                    }
                    // What has been scattered before is found where walks from sensors are joined to it, or by these alone,
                    // unless nothing but this can find it.
                    let rival = &vertex.rival;
                    if !self.techniques.gather || rival.first || rival.alone {
                        effort.joins += self.sensors.receivers.len() as u64;
                        self.join(&medium, vertex, depth, |sensor, arrival| {
                            add(sensor, fluxes, arrival);
                        });
                    }
                }
            }
            if !more {
                effort.truncated += u64::from(walk.truncated);
                return effort;
            }
        }
    }

    fn join(
        &self,
        medium: &Medium,
        vertex: &Vertex,
        depth: u32,
        mut add: impl FnMut(usize, &Arrival),
    ) {
        if self.sensors.receivers.is_empty() {
            return;
        }
        let cover = &medium.covers[vertex.material as usize];
        let polarises = cover.polarises_scattering();
        let diffuse = |direction| {
            let (cos, sin2) = angle_of_incidence(direction, vertex.normal);
            cover.diffuse(cos, sin2)
        };
        let even = diffuse(vertex.normal);
        let Sensors {
            receivers,
            allocation,
            ..
        } = *self.sensors;
        let mut steps: Vec<Step> = Vec::new();
        let seen = seen(medium, vertex.position, vertex.normal, self.sensors.targets);
        let ways = |sensor: usize, steps: &mut Vec<Step>| {
            steps.clear();
            if !seen.as_ref().is_none_or(|seen| seen[sensor]) {
                return None;
            }
            let clear = seen.is_some();
            let Vertex {
                position, normal, ..
            } = *vertex;
            straight(medium, position, normal, &receivers[sensor], clear, steps)
        };
        // Where neighbours share, no pane is on the way, and the density with which walks from all neighbours of a sensor come
        // here is to be known for each.
        let memberships = &allocation.memberships;
        let share = self.sensors.share && self.techniques.gather && !polarises;
        let mut known: Vec<Option<Joined>> = Vec::new();
        let mut reached = vec![0.0; if share { receivers.len() } else { 0 }];
        if share {
            known.extend((0..receivers.len()).map(|sensor| ways(sensor, &mut steps)));
            for (sensor, way) in known.iter().enumerate() {
                if let Some(way) = way {
                    let times = f64::from(allocation.times()[sensor]);
                    reached[memberships[sensor]] += times * way.coupling * way.odds;
                }
            }
        }
        for (sensor, receiver) in receivers.iter().enumerate() {
            let way = match known.get_mut(sensor) {
                Some(way) => way.take(),
                None => ways(sensor, &mut steps),
            };
            if let Some(way) = way {
                let mut weight = way.coupling;
                if self.techniques.gather {
                    let coupling = if share {
                        reached[memberships[sensor]]
                    } else {
                        f64::from(allocation.times()[sensor]) * way.coupling * way.odds
                    };
                    let diffuse = if polarises {
                        diffuse(way.direction)
                    } else {
                        even
                    };
                    let rivalry = allocation.rivalry(sensor);
                    weight *= vertex.rival.weight(coupling, diffuse, rivalry);
                }
                let arrival = Arrival {
                    receiver,
                    vertex,
                    direction: way.direction,
                    weight,
                    steps: &steps,
                    polarised: polarises,
                };
                add(sensor, &arrival);
            }
            if vertex.rival.alone && self.techniques.mirrored && !receiver.enclosed {
                self.mirrored(medium, vertex, depth, receiver, |way, steps| {
                    let arrival = Arrival {
                        receiver,
                        vertex,
                        direction: way.direction,
                        weight: way.coupling,
                        steps,
                        polarised: polarises,
                    };
                    add(sensor, &arrival);
                });
            }
        }
    }

    /// Joins a vertex to a sensor by chains of flat mirrors: only where no walk from the sensor can find its light.
    fn mirrored(
        &self,
        medium: &Medium,
        vertex: &Vertex,
        depth: u32,
        receiver: &Receiver,
        mut found: impl FnMut(&Joined, &[Step]),
    ) {
        if !receiver.is_irradiance() {
            return;
        }
        let viewer = Viewer {
            point: vertex.position,
            normal: vertex.normal,
            sensor: false,
        };
        let strength = |leaving: DVec3, square: f64| leaving.dot(receiver.normal).max(0.0) / square;
        let target = Target {
            at: receiver.origin,
            finite: true,
            area: false,
            strength: &strength,
        };
        medium
            .mirrors
            .draw(&viewer, &target, self.uniforms, depth, |drawn, inverse| {
                let mut steps = Vec::new();
                if let Some((way, _)) = medium.drawn(&viewer, &target, drawn, &mut steps) {
                    let cosines = way.start.dot(vertex.normal) * -way.arriving.dot(receiver.normal);
                    let joined = Joined {
                        direction: way.start,
                        coupling: cosines.max(0.0) / (PI * way.square) * inverse / way.drawn,
                        odds: way.odds,
                    };
                    found(&joined, &steps);
                }
            });
    }
}

/// Which receivers a point sees, all asked for at once; `None` where panes leave more than yes and no.
pub(super) fn seen(
    medium: &Medium,
    from: DVec3,
    normal: DVec3,
    targets: &Targets,
) -> Option<Vec<bool>> {
    if medium.panes {
        return None;
    }
    let mut seen = Vec::new();
    medium
        .surfaces
        .visible_from(from, normal, targets, &mut seen);
    Some(seen)
}

/// The way straight from a point to a receiver, by panes at most: irradiance there per flux scattered by Lambert's law,
/// cos θ cos θ′ Θ/(π |r − r′|²) (eq. 16). Whether it is `clear` may be known already.
pub(super) fn straight(
    medium: &Medium,
    from: DVec3,
    normal: DVec3,
    receiver: &Receiver,
    clear: bool,
    steps: &mut Vec<Step>,
) -> Option<Joined> {
    if receiver.enclosed || !receiver.is_irradiance() {
        return None;
    }
    let segment = receiver.origin - from;
    let coupling = coupling(segment, normal, receiver.normal);
    if coupling <= 0.0 {
        return None;
    }
    let direction = segment / segment.length();
    let odds = if clear {
        1.0
    } else {
        medium
            .passage(from, Some(receiver.origin), direction, steps)?
            .odds
    };
    Some(Joined {
        direction,
        coupling,
        odds,
    })
}
