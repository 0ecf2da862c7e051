//! Light along a walk, for 1, 3 or 4 Stokes components: pure, after the walk is fixed.
//!
//! Polarisation lives only inside chains of mirrors and panes: a diffuse event takes the light in by an
//! analyser and gives it out by a Stokes vector of its own, so between chains light is one number.

mod carrying;
mod chain;
mod gathering;
mod strands;

pub(crate) use carrying::Carrying;
pub(crate) use gathering::Gathering;
pub(crate) use strands::Strands;

use chain::Chain;

use crate::medium::Step;
use crate::path::{Bridge, Event, Vertex};
use crate::receiver::Receiver;
use crate::site::State;
use crate::variation::Variation;
use glam::DVec3;
use malus_optics::{
    Analyser, Basis, Carried, Emergence, Incidence, Material as Optics, Rotator, Sensor, Stokes,
    angle_of_incidence,
};

/// Light on its way, per unit of what it started with, in a basis of its own; `None`: unpolarised.
type Light<const N: usize> = Option<(Stokes<N, Carried>, Basis<Carried>)>;

/// What a sensor reads of a walk in one variant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reading<const N: usize> {
    /// The irradiance, in the sensor's basis.
    sum: Stokes<N, Sensor>,
    /// Of S0, what was seen in mirrors and what was met by chance.
    pub found: [f64; 2],
}

impl<const N: usize> Reading<N> {
    /// Nothing read yet.
    fn nothing() -> Self {
        Self {
            sum: Stokes::unpolarised(0.0),
            found: [0.0; 2],
        }
    }

    /// The irradiance, in the sensor's basis.
    pub(crate) fn light(&self) -> [f64; N] {
        self.sum.components()
    }
}

/// Readings of light that is the sensor's own, and of that which neighbours share.
pub(crate) type Readings<const N: usize> = [Reading<N>; 2];

/// Light that leaves an emitter.
fn emitted<const N: usize>(direction: DVec3, state: State) -> Light<N> {
    match state {
        Some((state, axis)) if N > 1 => {
            Some((Stokes::of_state(*state), Basis::new(direction, axis)))
        }
        _ => None,
    }
}

/// Light of unit irradiance on its way straight to a sensor, along `direction`, in the sensor's basis.
fn at_sensor<const N: usize>(
    receiver: &Receiver,
    direction: DVec3,
    light: Light<N>,
) -> Stokes<N, Sensor> {
    match light {
        Some((light, basis)) => Rotator::new(&basis, &receiver.basis(direction)) * light,
        None => Stokes::unpolarised(1.0),
    }
}

/// The basis with the s axis of a beam that leaves a surface along `direction`.
fn leaving(direction: DVec3, normal: DVec3) -> Basis<Emergence> {
    let arriving = direction - normal * (2.0 * direction.dot(normal));
    let (incidence, _) = Basis::mirror(arriving, normal);
    Basis::new(direction, incidence.axis())
}

/// What a scattering surface sends along `direction`, for unit scattered flux.
fn scattered<const N: usize>(optics: &Optics, normal: DVec3, direction: DVec3) -> Light<N> {
    let (cos, sin2) = angle_of_incidence(direction, normal);
    let column = optics.leaving::<N>(cos, sin2).carried();
    Some((column, leaving(direction, normal).carried()))
}

/// What comes over a bridge, for unit scattered flux.
fn bridged<const N: usize>(optics: &Optics, bridge: &Bridge) -> Light<N> {
    if optics.polarises_scattering() {
        scattered(optics, bridge.from.normal, -bridge.toward)
    } else {
        None
    }
}

/// What a scattering surface takes in of light that arrives.
fn taken_in<const N: usize>(
    optics: &Optics,
    normal: DVec3,
    direction: DVec3,
) -> (Analyser<N, Incidence>, Basis<Incidence>) {
    let (cos, sin2) = angle_of_incidence(direction, normal);
    let (incidence, _) = Basis::mirror(direction, normal);
    (optics.entering(cos, sin2), incidence)
}

/// The mirror or the pane by which a walk goes on at a vertex.
fn passed_at(vertex: &Vertex) -> Step {
    Step {
        surface: vertex.material,
        normal: vertex.normal,
        arriving: vertex.arriving,
        matrix: vertex.matrix,
        through: vertex.event == Event::Through,
    }
}

/// Light once it has passed a mirror or a pane, on its way along `arriving`.
fn passed<const N: usize>(light: Light<N>, step: &Step) -> (Stokes<N, Carried>, Basis<Carried>) {
    let Step {
        normal,
        arriving,
        matrix,
        through,
        ..
    } = *step;
    let (incidence, reflected) = Basis::mirror(arriving, normal);
    let onward = if through {
        Basis::<Emergence>::new(arriving, incidence.axis())
    } else {
        reflected
    };
    let arriving: Stokes<N, Incidence> = match light {
        Some((light, basis)) => Rotator::new(&basis, &incidence) * light,
        None => Stokes::unpolarised(1.0),
    };
    ((matrix * arriving).carried(), onward.carried())
}

/// Light of an emitter, of unit irradiance, that a sensor sees past the panes it has looked through.
pub(crate) fn seen<const N: usize>(
    receiver: &Receiver,
    direction: DVec3,
    state: State,
    steps: &[Step],
    variation: &Variation,
) -> Stokes<N, Sensor> {
    let chain = steps.iter().fold(Chain::ToSensor(None), |chain, step| {
        chain.extended(receiver, &variation.step(step))
    });
    chain.pass(receiver, direction, emitted(direction, state))
}

/// Light of an emitter, of unit irradiance, that goes through mirrors and panes to a sensor.
pub(crate) fn sent<const N: usize>(
    receiver: &Receiver,
    direction: DVec3,
    state: State,
    steps: &[Step],
    variation: &Variation,
) -> Stokes<N, Sensor> {
    let light = emitted(direction, state);
    delivered(receiver, direction, light, steps, variation)
}

/// What a scattering surface sends along `direction` to a sensor through mirrors and panes, for unit scattered flux.
pub(crate) fn joined<const N: usize>(
    receiver: &Receiver,
    vertex: &Vertex,
    direction: DVec3,
    steps: &[Step],
    variation: &Variation,
) -> Stokes<N, Sensor> {
    let material = &variation.materials[vertex.material as usize];
    let light = if material.optics.polarises_scattering() {
        scattered(&material.optics, vertex.normal, direction)
    } else {
        None
    };
    delivered(receiver, direction, light, steps, variation)
}

fn delivered<const N: usize>(
    receiver: &Receiver,
    direction: DVec3,
    mut light: Light<N>,
    steps: &[Step],
    variation: &Variation,
) -> Stokes<N, Sensor> {
    let mut direction = direction;
    for step in steps {
        let (next, basis) = passed(light, &variation.step(step));
        direction = basis.direction();
        light = Some((next, basis));
    }
    at_sensor(receiver, direction, light)
}
