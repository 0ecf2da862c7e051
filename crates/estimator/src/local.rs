//! The paper's estimator (eqs. 19–21): walks from the emitters, and at every vertex a local estimate to every sensor.

use crate::emitters::Start;
use crate::evaluate::{Carrying, joined, sent};
use crate::medium::{Medium, Step};
use crate::mirrors::{Target, Viewer};
use crate::pass::{Channels, Effort, Passes};
use crate::random::{Stream, Uniforms};
use crate::receiver::Receiver;
use crate::trace::{Path, Techniques, Vertex, Walk};
use glam::DVec3;
use malus_geometry::{Surfaces, Targets};
use malus_optics::angle_of_incidence;
use std::f64::consts::PI;
use std::ops::Range;

/// Adds the walks `range` to the sums of all sensors.
pub(crate) fn local<'a, const N: usize>(
    passes: &Passes<'a>,
    channels: &Channels,
    receivers: &[Receiver],
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
) -> Effort {
    let mut effort = Effort::default();
    let targets = targets(passes.main.surfaces, receivers);
    for index in range {
        let uniforms = stream.walk(index);
        // A start on a hidden part of an emitter carries nothing.
        let Some(start) = passes.main.emitters.start(uniforms) else {
            continue;
        };
        // Where walks from the sensors look at emitters, they alone answer for light that comes straight.
        if !passes.techniques.gather {
            effort += emit::<N>(passes, channels, receivers, &targets, &start, sums);
        }
        let joining = Joining {
            techniques: passes.techniques,
            receivers,
            targets: &targets,
            uniforms,
        };
        let mut main = Carrying::<N>::new(&start);
        if let Some(channel) = channels.along {
            let mut scalar = Carrying::<1>::new(&start);
            effort += joining.follow::<N, 2>(
                passes.main,
                &start,
                |path, fluxes| {
                    main.follow(&path.vertices, passes.main.materials, |i, flux| {
                        fluxes[i][0] = flux
                    });
                    scalar.follow(&path.vertices, passes.main.materials, |i, flux| {
                        fluxes[i][1] = flux
                    });
                },
                |sensor, [one, two], light, scalar| {
                    let sums = &mut sums[sensor * channels.count..];
                    add(sums, one, light);
                    sums[channel] += two * scalar;
                },
            );
        } else {
            effort += joining.follow::<N, 1>(
                passes.main,
                &start,
                |path, fluxes| {
                    main.follow(&path.vertices, passes.main.materials, |i, flux| {
                        fluxes[i][0] = flux
                    });
                },
                |sensor, [one], light, _| add(&mut sums[sensor * channels.count..], one, light),
            );
        }
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let mut apart = Carrying::<1>::new(&start);
            effort += joining.follow::<1, 1>(
                medium,
                &start,
                |path, fluxes| {
                    apart.follow(&path.vertices, medium.materials, |i, flux| {
                        fluxes[i][0] = flux
                    });
                },
                |sensor, [one], [light], _| sums[sensor * channels.count + channel] += one * light,
            );
        }
    }
    effort
}

fn add<const N: usize>(sums: &mut [f64], flux: f64, light: [f64; N]) {
    for (sum, component) in sums.iter_mut().zip(light) {
        *sum += flux * component;
    }
}

/// The local estimate at the point of emission itself. A source without geometry has none: it is summed exactly.
fn emit<const N: usize>(
    passes: &Passes,
    channels: &Channels,
    receivers: &[Receiver],
    targets: &Targets,
    start: &Start,
    sums: &mut [f64],
) -> Effort {
    let Some(normal) = start.normal else {
        return Effort::default();
    };
    let mut steps = Vec::new();
    let seen = seen(&passes.main, start.origin, normal, targets);
    let sums = sums.chunks_mut(channels.count);
    for (sensor, (receiver, sums)) in receivers.iter().zip(sums).enumerate() {
        if !seen.as_ref().is_none_or(|seen| seen[sensor]) {
            continue;
        }
        steps.clear();
        let way = straight(
            &passes.main,
            start.origin,
            normal,
            receiver,
            seen.is_some(),
            &mut steps,
        );
        let Some(way) = way else {
            continue;
        };
        let flux = start.flux * way.coupling;
        let light = sent::<N>(receiver, way.direction, start.site.state, &steps);
        add(sums, flux, light.components());
        for channel in [channels.along, channels.apart].into_iter().flatten() {
            let light = sent::<1>(receiver, way.direction, None, &steps);
            sums[channel] += flux * light.i();
        }
    }
    Effort {
        rays: receivers.len() as u64,
        truncated: 0,
    }
}

/// Joins the vertices of walks to sensors.
#[derive(Clone, Copy)]
struct Joining<'r> {
    techniques: Techniques,
    receivers: &'r [Receiver],
    targets: &'r Targets,
    uniforms: Uniforms,
}

/// A way on which a point is joined to a sensor.
struct Joined {
    /// Direction at the point.
    direction: DVec3,
    /// cos θ cos θ′/(π r²), in 1/m².
    coupling: f64,
    /// Probability of passing the panes on the way.
    odds: f64,
}

impl Joining<'_> {
    /// Takes a walk to its end and joins each diffuse vertex to every sensor.
    ///
    /// `evaluate` fills in the flux that each vertex of a path takes in, for K models; `add` receives the index of a
    /// sensor, the flux per area there, and the Stokes vector and the intensity that arrive for one unit of it.
    fn follow<'a, const N: usize, const K: usize>(
        &self,
        medium: Medium<'a>,
        start: &Start<'a>,
        mut evaluate: impl FnMut(&Path<'a>, &mut [[f64; K]]),
        mut add: impl FnMut(usize, [f64; K], [f64; N], f64),
    ) -> Effort {
        let mut walk = Walk::from_emitter(medium, self.techniques, self.uniforms, start);
        let mut effort = Effort::default();
        let mut path = Path::default();
        let mut fluxes = Vec::new();
        let mut depth = 0;
        loop {
            path.clear();
            let more = walk.advance(&mut path);
            effort.rays += path.vertices.len() as u64;
            fluxes.clear();
            fluxes.resize(path.vertices.len(), [0.0; K]);
            evaluate(&path, &mut fluxes);
            for (vertex, flux) in path.vertices.iter().zip(&fluxes) {
                depth += 1;
                if flux.iter().any(|&f| f > 0.0) {
                    effort.rays += self.receivers.len() as u64;
                    self.join(&medium, vertex, depth, |sensor, weight, light, scalar| {
                        add(sensor, flux.map(|f| f * weight), light, scalar);
                    });
                }
            }
            if !more {
                effort.truncated += u64::from(walk.truncated);
                return effort;
            }
        }
    }

    fn join<const N: usize>(
        &self,
        medium: &Medium,
        vertex: &Vertex,
        depth: u32,
        mut add: impl FnMut(usize, f64, [f64; N], f64),
    ) {
        let material = &medium.materials[vertex.material as usize];
        let polarises = material.optics.polarises_scattering();
        let diffuse = |direction| {
            let (cos, sin2) = angle_of_incidence(direction, vertex.normal);
            material.optics.diffuse_bound(cos, sin2)
        };
        let even = diffuse(vertex.normal);
        let mut steps: Vec<Step> = Vec::new();
        let read = |receiver: &Receiver, way: &Joined, steps: &[Step]| {
            if steps.is_empty() && !polarises {
                let mut light = [0.0; N];
                light[0] = 1.0;
                return (light, 1.0);
            }
            let (normal, direction) = (vertex.normal, way.direction);
            let light = joined::<N>(receiver, material, normal, direction, steps);
            let scalar = joined::<1>(receiver, material, normal, direction, steps);
            (light.components(), scalar.i())
        };
        let seen = seen(medium, vertex.position, vertex.normal, self.targets);
        for (sensor, receiver) in self.receivers.iter().enumerate() {
            steps.clear();
            let way = if seen.as_ref().is_none_or(|seen| seen[sensor]) {
                straight(
                    medium,
                    vertex.position,
                    vertex.normal,
                    receiver,
                    seen.is_some(),
                    &mut steps,
                )
            } else {
                None
            };
            if let Some(way) = way {
                let mut weight = way.coupling;
                if self.techniques.gather {
                    let diffuse = if polarises {
                        diffuse(way.direction)
                    } else {
                        even
                    };
                    let coupling = way.coupling * way.odds;
                    weight *= vertex
                        .rival
                        .weight(coupling, diffuse, self.techniques.local);
                }
                let (light, scalar) = read(receiver, &way, &steps);
                add(sensor, weight, light, scalar);
            }
            if vertex.rival.alone && self.techniques.mirrored && !receiver.enclosed {
                self.mirrored(medium, vertex, depth, receiver, |way, steps| {
                    let (light, scalar) = read(receiver, way, steps);
                    add(sensor, way.coupling, light, scalar);
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
                if let Some((way, _)) = medium.drawn(&viewer, &target, &drawn, &mut steps) {
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

/// The receivers as targets; those that light cannot be joined to straight are seen from nowhere.
fn targets(surfaces: &Surfaces, receivers: &[Receiver]) -> Targets {
    let targets = receivers.iter().map(|receiver| {
        let joined = receiver.is_irradiance() && !receiver.enclosed;
        (receiver.origin, receiver.normal * f64::from(joined))
    });
    surfaces.targets(&targets.collect::<Vec<_>>())
}

/// Which receivers a point sees, all asked for at once; `None` where panes leave more than yes and no.
fn seen(medium: &Medium, from: DVec3, normal: DVec3, targets: &Targets) -> Option<Vec<bool>> {
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
fn straight(
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
    let leaving = segment.dot(normal);
    let arriving = -segment.dot(receiver.normal);
    if leaving <= 0.0 || arriving <= 0.0 {
        return None;
    }
    let square = segment.length_squared();
    let direction = segment / square.sqrt();
    let odds = if clear {
        1.0
    } else {
        medium
            .passage(from, Some(receiver.origin), direction, steps)?
            .odds
    };
    Some(Joined {
        direction,
        coupling: leaving * arriving / (PI * square * square),
        odds,
    })
}
