//! Light along a walk from an emitter.

use super::{Light, emitted, passed, passed_at, scattered, taken_in};
use crate::path::{Event, Vertex};
use crate::receiver::Receiver;
use crate::site::Start;
use crate::variation::Variation;
use glam::DVec3;
use malus_optics::{Basis, Incidence, Rotator, Sensor, Stokes, angle_of_incidence};
use malus_scene::Material;

/// The light that a walk from an emitter carries.
#[derive(Debug)]
pub(crate) struct Carrying<const N: usize> {
    /// Flux, a number between chains of mirrors.
    flux: f64,
    /// Inside a chain, or from a polarised emitter: the light per flux, with its basis. `None`: unpolarised.
    light: Light<N>,
}

impl<const N: usize> Carrying<N> {
    /// What the emitter sends off.
    #[must_use]
    pub(crate) fn new(start: &Start, variation: &Variation) -> Self {
        Self {
            flux: start.flux * variation.emitted(start.site.origin),
            light: emitted(start.direction, start.site.state),
        }
    }

    /// Passes the vertices of a walk; `told` is given the number of each and the flux that it scatters.
    pub(crate) fn follow(
        &mut self,
        path: &[Vertex],
        variation: &Variation,
        mut told: impl FnMut(usize, f64),
    ) {
        for (index, vertex) in path.iter().enumerate() {
            if vertex.black {
                return;
            }
            let material = &variation.materials[vertex.material as usize];
            let optics = &material.optics;
            let scattering = optics.scattering();
            let mut taken = 0.0;
            if scattering > 0.0 {
                taken = scattering * self.taken(material, vertex);
                told(index, taken);
            }
            match vertex.event {
                Event::Absorbed => return,
                Event::Diffuse => {
                    self.flux = taken / vertex.probability;
                    self.light = if optics.polarises_scattering() {
                        scattered(optics, vertex.normal, vertex.onward)
                    } else {
                        None
                    };
                }
                Event::Mirror | Event::Through => self.pass(vertex, variation),
            }
        }
    }

    /// The flux that a scattering surface takes in: a diffuse event is a total depolariser of what enters.
    fn taken(&self, material: &Material, vertex: &Vertex) -> f64 {
        if !material.optics.polarises_scattering() {
            return self.flux * self.light.map_or(1.0, |(light, _)| light.i());
        }
        let (row, incidence) = taken_in::<N>(&material.optics, vertex.normal, vertex.arriving);
        let arriving = match self.light {
            Some((light, basis)) => Rotator::new(&basis, &incidence) * light,
            None => Stokes::unpolarised(1.0),
        };
        self.flux * (row * arriving)
    }

    fn pass(&mut self, vertex: &Vertex, variation: &Variation) {
        let mut step = variation.step(&passed_at(vertex));
        step.matrix = step.matrix * (1.0 / vertex.probability);
        self.light = Some(passed(self.light, &step));
    }

    /// Flux under way.
    #[must_use]
    pub(crate) fn flux(&self) -> f64 {
        self.flux * self.light.map_or(1.0, |(light, _)| light.i())
    }

    /// The flux under way along `direction` as a Stokes vector, in the basis of a sensor that it passes.
    #[must_use]
    pub(crate) fn at_sensor(&self, receiver: &Receiver, direction: DVec3) -> Stokes<N, Sensor> {
        match self.light {
            Some((light, basis)) if N > 1 => {
                Rotator::new(&basis, &receiver.basis(direction)) * light * self.flux
            }
            _ => Stokes::unpolarised(self.flux()),
        }
    }

    /// Flux that a vertex keeps of what arrives there, in expectation: before it is decided how the walk goes on.
    #[must_use]
    pub(crate) fn absorbed(&self, vertex: &Vertex, materials: &[Material]) -> f64 {
        if vertex.black {
            return self.flux();
        }
        let arriving: Stokes<N, Incidence> = match self.light {
            Some((light, basis)) if N > 1 => {
                let (incidence, _) = Basis::mirror(vertex.arriving, vertex.normal);
                Rotator::new(&basis, &incidence) * light
            }
            Some((light, _)) => Stokes::unpolarised(light.i()),
            None => Stokes::unpolarised(1.0),
        };
        let material = &materials[vertex.material as usize];
        self.flux * (arriving.i() - onward(material, vertex, arriving))
    }
}

/// Flux that a surface sends on of the light that arrives, in every direction and in every way that it has.
fn onward<const N: usize>(
    material: &Material,
    vertex: &Vertex,
    arriving: Stokes<N, Incidence>,
) -> f64 {
    let optics = &material.optics;
    let (cos, sin2) = angle_of_incidence(vertex.arriving, vertex.normal);
    let mirrored = (optics.mirror(cos, sin2) * arriving).i();
    let through = (optics.through(cos, sin2) * arriving).i();
    let scattering = optics.scattering();
    if scattering <= 0.0 {
        return mirrored + through;
    }
    // The albedo is the scattering times the mean of what enters and the like mean of what leaves.
    let leaving = (optics.albedo() / scattering).sqrt();
    let taken = optics.entering::<N>(cos, sin2) * arriving;
    mirrored + through + scattering * taken * leaving
}
