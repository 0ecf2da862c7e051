//! Direct modelling, the baseline of the paper's section 3: walks from the emitters, counted where they cross a cell about
//! a sensor point.
//!
//! What it gives is the mean irradiance over the cell, whatever the way that light took to it: through mirrors, or straight
//! from a point source. Nothing is joined to anything, so no part of the light is missing, and few walks count at all.
//!
//! A cell of side ℓ reads E + ℓ²/24 ∇²E of the irradiance E about its point. Cells, not rings: a ring of radius r and half
//! width w counts as many walks as a square of side √(4πrw), but only about an axis of symmetry is it a mean worth having.

mod cells;

pub(crate) use cells::Cells;

use crate::evaluate::Carrying;
use crate::journey::{End, journey};
use crate::medium::Medium;
use crate::pass::{Channels, Effort, Passes};
use crate::path::{Event, Path, Vertex};
use crate::random::Stream;
use crate::reading::Unmet;
use crate::receiver::Receiver;
use crate::site::Start;
use crate::techniques::Techniques;
use crate::trace::Walk;
use cells::{Cell, Leg};
use glam::DVec3;
use malus_geometry::Surfaces;
use std::ops::Range;

/// Side of a cell where none is given, in m.
pub(crate) const SIDE: f64 = 0.05;

/// Adds the walks `range` to the sums of all sensors whose cells they cross.
pub(crate) fn direct<'a, const N: usize>(
    passes: &Passes<'a>,
    channels: &Channels,
    receivers: &[Receiver],
    cells: &Cells,
    stream: Stream,
    range: Range<u64>,
    sums: &mut [f64],
) -> Effort {
    let mut effort = Effort::default();
    for index in range {
        let uniforms = stream.walk(index);
        // A start on a hidden part of an emitter carries nothing.
        let Some(start) = passes.main.emitters.start(uniforms) else {
            continue;
        };
        let walk =
            |medium: Medium<'a>| Walk::from_emitter(medium, Techniques::ALONE, uniforms, &start);
        let variation = passes.main.first();
        let mut main = Carrying::<N>::new(&start, variation);
        let mut scalar = channels
            .along
            .map(|channel| (Carrying::<1>::new(&start, variation), channel));
        effort += follow(
            passes.main.surfaces,
            cells,
            walk(passes.main),
            &start,
            |arrival| {
                for cell in arrival.crossed {
                    let sums = &mut sums[cell.sensor * channels.count..][..channels.count];
                    let light = main.at_sensor(&receivers[cell.sensor], arrival.direction);
                    for (sum, component) in sums.iter_mut().zip(light.components()) {
                        *sum += component / cell.area;
                    }
                    if let Some((scalar, channel)) = &scalar {
                        sums[*channel] += scalar.flux() / cell.area;
                    }
                }
                if let Some(vertex) = arrival.vertex {
                    main.follow(std::slice::from_ref(vertex), variation, |_, _| {});
                    if let Some((scalar, _)) = &mut scalar {
                        scalar.follow(std::slice::from_ref(vertex), variation, |_, _| {});
                    }
                }
            },
        );
        if let (Some(medium), Some(channel)) = (passes.apart, channels.apart) {
            let mut apart = Carrying::<1>::new(&start, medium.first());
            effort += follow(medium.surfaces, cells, walk(medium), &start, |arrival| {
                for cell in arrival.crossed {
                    sums[cell.sensor * channels.count + channel] += apart.flux() / cell.area;
                }
                if let Some(vertex) = arrival.vertex {
                    apart.follow(std::slice::from_ref(vertex), medium.first(), |_, _| {});
                }
            });
        }
    }
    effort
}

/// What a walk does on one leg.
struct Arrival<'l> {
    /// The cells that it crosses on its way.
    crossed: &'l [Cell],
    /// Unit vector along which it goes.
    direction: DVec3,
    /// Where it arrives; `None` where it leaves the scene.
    vertex: Option<&'l Vertex>,
}

/// Takes a walk to its end; `arrive` is told every leg of it in turn.
fn follow<'a>(
    surfaces: &Surfaces,
    cells: &Cells,
    mut walk: Walk<'a>,
    start: &Start,
    mut arrive: impl FnMut(Arrival<'_>),
) -> Effort {
    let mut crossed = Vec::new();
    let mut from = start.origin;
    let mut rays = 0;
    let mut go = |leg: Leg, vertex: Option<&Vertex>| {
        rays += 1 + cells.crossed(surfaces, &leg, &mut crossed);
        arrive(Arrival {
            crossed: &crossed,
            direction: leg.direction,
            vertex,
        });
    };
    let end = journey(&mut walk, &mut Path::default(), |vertex| {
        // A cell that lies on the surface is between it and the vertex.
        let surface = vertex.position - vertex.normal * surfaces.offset();
        let direction = vertex.arriving;
        let length = (surface - from).dot(direction);
        go(
            Leg {
                from,
                direction,
                length,
            },
            Some(vertex),
        );
        // Reflected light goes on from the side that it came from.
        from = match vertex.event {
            Event::Through => surface - vertex.normal * surfaces.offset(),
            _ => vertex.position,
        };
    });
    if end == End::Escaped {
        let (from, direction) = walk.ray();
        let length = f64::INFINITY;
        go(
            Leg {
                from,
                direction,
                length,
            },
            None,
        );
    }
    Effort {
        rays,
        truncated: u64::from(walk.truncated),
        ..Effort::default()
    }
}

/// What the next walk may bring to a cell that none has met yet: all the flux of the scene.
pub(crate) fn unmet(medium: &Medium, cells: &Cells) -> Unmet {
    let one = medium.emitters.flux(crate::emitters::Choice::All) / (cells.side * cells.side);
    Unmet { one, most: one }
}

/// What the results are, in place of values at points.
pub(crate) fn warning(cells: &Cells) -> String {
    let cut = cells.iter().filter(|cell| cell.cut).count();
    let of_which = match cut {
        0 => String::new(),
        _ => {
            format!("; surfaces cut {cut} of them, which count the part that the sensor point sees")
        }
    };
    format!(
        "direct: every value is the mean over a square cell of side {} m about its sensor point, not the value there{of_which}",
        cells.side
    )
}
