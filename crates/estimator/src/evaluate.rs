//! Light along a walk, for 1, 3 or 4 Stokes components: pure, after the walk is fixed.
//!
//! Polarisation lives only inside chains of mirror-like reflections: a diffuse event takes the light in by an
//! analyser and gives it out by a Stokes vector of its own, so between chains light is one number.

use crate::emitters::{Start, State};
use crate::receiver::Receiver;
use crate::trace::{Connection, Event, Path, Vertex};
use glam::DVec3;
use malus_optics::{
    Analyser, Basis, Carried, Emergence, Incidence, Mueller, Rotator, Sensor, Stokes,
};
use malus_scene::Material;

/// A basis and the light of an emitter in it.
fn emitted<const N: usize>(
    direction: DVec3,
    state: [f64; 4],
    axis: DVec3,
) -> (Basis<Carried>, Stokes<N, Carried>) {
    (Basis::new(direction, axis), Stokes::of_state(state))
}

/// Light of unit irradiance that an emitter sends straight to a sensor, along `direction`, in the sensor's basis.
pub(crate) fn at_sensor<const N: usize>(
    receiver: &Receiver,
    direction: DVec3,
    state: State,
) -> Stokes<N, Sensor> {
    match state {
        Some((state, axis)) if N > 1 => {
            let (basis, light) = emitted(direction, *state, axis);
            Rotator::new(&basis, &receiver.basis(direction)) * light
        }
        _ => Stokes::unpolarised(1.0),
    }
}

/// What a sensor reads of a walk that was started from it.
#[derive(Debug)]
pub(crate) struct Gathering<'r, const N: usize> {
    receiver: &'r Receiver,
    chain: Chain<N>,
    /// Product of everything passed so far that is a number.
    weight: f64,
    sum: Stokes<N, Sensor>,
}

/// The mirrors that the walk has met since its last diffuse event, as light meets them on its way to the sensor.
#[derive(Debug, Clone, Copy)]
enum Chain<const N: usize> {
    /// No diffuse event yet: the whole matrix up to the sensor is needed.
    ToSensor(Option<(Mueller<N, Incidence, Sensor>, Basis<Incidence>)>),
    /// Behind a diffuse event, which sends `leaving` to the sensor: one row is enough.
    ToDiffuser {
        leaving: Stokes<N, Sensor>,
        mirrors: Option<(Analyser<N, Incidence>, Basis<Incidence>)>,
    },
}

impl<'r, const N: usize> Gathering<'r, N> {
    /// Nothing read yet.
    #[must_use]
    pub(crate) fn new(receiver: &'r Receiver) -> Self {
        Self {
            receiver,
            chain: Chain::ToSensor(None),
            weight: 1.0,
            sum: Stokes::unpolarised(0.0),
        }
    }

    /// The irradiance read, in the sensor's basis.
    #[must_use]
    pub(crate) fn sum(&self) -> [f64; N] {
        self.sum.components()
    }

    /// Light that the sensor sees straight.
    pub(crate) fn connect(&mut self, connection: Option<&Connection>) {
        if let Some(connection) = connection {
            let incoming = &connection.incoming;
            self.sum +=
                at_sensor(self.receiver, -incoming.toward, incoming.state) * connection.irradiance;
        }
    }

    /// Light met along the next vertices of the walk.
    pub(crate) fn follow(&mut self, path: &Path, materials: &[Material]) {
        for vertex in path {
            let material = &materials[vertex.material as usize];
            if vertex.emission > 0.0
                && let Some(emission) = &material.emission
            {
                let exitance = emission.exitance * vertex.emission;
                self.receive(
                    exitance,
                    -vertex.arriving,
                    crate::emitters::emitted_state(material),
                );
            }
            if vertex.black {
                return;
            }
            let albedo = material.optics.albedo();
            if let Some(connection) = &vertex.connection {
                self.receive(albedo * connection.irradiance, -vertex.arriving, None);
            }
            match vertex.event {
                Event::Absorbed => return,
                Event::Diffuse => self.scatter(albedo / vertex.probability, -vertex.arriving),
                Event::Mirror => self.reflect(vertex),
            }
        }
    }

    /// Adds light that leaves a surface along `direction` with the given exitance.
    fn receive(&mut self, exitance: f64, direction: DVec3, state: State) {
        self.sum += self.at_sensor(direction, state) * (self.weight * exitance);
    }

    /// Light of unit exitance that leaves a surface along `direction`, once it has reached the sensor.
    fn at_sensor(&self, direction: DVec3, state: State) -> Stokes<N, Sensor> {
        match (&self.chain, state) {
            (Chain::ToSensor(None), _) => at_sensor(self.receiver, direction, state),
            (Chain::ToSensor(Some((mirrors, basis))), Some((state, axis))) if N > 1 => {
                let (carried, light) = emitted(direction, *state, axis);
                *mirrors * (Rotator::new(&carried, basis) * light)
            }
            (Chain::ToSensor(Some((mirrors, _))), _) => *mirrors * Stokes::unpolarised(1.0),
            (
                Chain::ToDiffuser {
                    leaving,
                    mirrors: None,
                },
                _,
            ) => *leaving,
            (
                Chain::ToDiffuser {
                    leaving,
                    mirrors: Some((row, basis)),
                },
                Some((state, axis)),
            ) if N > 1 => {
                let (carried, light) = emitted(direction, *state, axis);
                *leaving * (*row * (Rotator::new(&carried, basis) * light))
            }
            (
                Chain::ToDiffuser {
                    leaving,
                    mirrors: Some((row, _)),
                },
                _,
            ) => *leaving * (*row * Stokes::unpolarised(1.0)),
        }
    }

    /// Passes a diffuse event: what lies behind it reaches the sensor as one number.
    fn scatter(&mut self, weight: f64, direction: DVec3) {
        let leaving = self.at_sensor(direction, None);
        self.weight *= weight;
        self.chain = Chain::ToDiffuser {
            leaving,
            mirrors: None,
        };
    }

    /// Passes a mirror: light arrives there along the reversed reflected direction of the walk.
    fn reflect(&mut self, vertex: &Vertex) {
        self.weight /= vertex.probability;
        let normal = vertex.normal;
        let onward = vertex.arriving - normal * (2.0 * vertex.arriving.dot(normal));
        let (incidence, emergence) = Basis::mirror(-onward.normalize(), normal);
        let carried = emergence.carried();
        let receiver = self.receiver;
        match &mut self.chain {
            Chain::ToSensor(mirrors) => {
                let onward: Mueller<N, Emergence, Sensor> = match mirrors {
                    None => {
                        let sensor = receiver.basis(carried.direction());
                        Mueller::from(Rotator::new(&carried, &sensor)).emergent()
                    }
                    Some((matrix, basis)) => (*matrix * Rotator::new(&carried, basis)).emergent(),
                };
                *mirrors = Some((onward * vertex.mirror, incidence));
            }
            Chain::ToDiffuser { mirrors, .. } => {
                let onward: Analyser<N, Emergence> = match mirrors {
                    None => Analyser::intensity(),
                    Some((row, basis)) => (*row * Rotator::new(&carried, basis)).emergent(),
                };
                *mirrors = Some((onward * vertex.mirror, incidence));
            }
        }
    }
}

/// The light that a walk from an emitter carries.
#[derive(Debug)]
pub(crate) struct Carrying<const N: usize> {
    /// Flux, a number between chains of mirrors.
    flux: f64,
    /// Inside a chain, or from a polarised emitter: the light per flux, with its basis. `None`: unpolarised.
    light: Option<(Stokes<N, Carried>, Basis<Carried>)>,
}

impl<const N: usize> Carrying<N> {
    /// What the emitter sends off.
    #[must_use]
    pub(crate) fn new(start: &Start) -> Self {
        let light = match start.state {
            Some((state, axis)) if N > 1 => {
                let (basis, light) = emitted(start.direction, *state, axis);
                Some((light, basis))
            }
            _ => None,
        };
        Self {
            flux: start.flux,
            light,
        }
    }

    /// Passes the vertices of a walk; `scattered` is told the number and the diffusely scattered flux of each.
    pub(crate) fn follow(
        &mut self,
        path: &[Vertex],
        materials: &[Material],
        mut scattered: impl FnMut(usize, f64),
    ) {
        for (index, vertex) in path.iter().enumerate() {
            if vertex.black {
                return;
            }
            let albedo = materials[vertex.material as usize].optics.albedo();
            // A diffuse event takes the light in by its first component: a total depolariser.
            let arriving = self.flux * self.light.map_or(1.0, |(light, _)| light.i());
            if albedo > 0.0 {
                scattered(index, albedo * arriving);
            }
            match vertex.event {
                Event::Absorbed => return,
                Event::Diffuse => {
                    self.flux = arriving * (albedo / vertex.probability);
                    self.light = None;
                }
                Event::Mirror => self.reflect(vertex),
            }
        }
    }

    fn reflect(&mut self, vertex: &Vertex) {
        self.flux /= vertex.probability;
        let (incidence, emergence) = Basis::mirror(vertex.arriving, vertex.normal);
        let arriving: Stokes<N, Incidence> = match self.light {
            Some((light, basis)) => Rotator::new(&basis, &incidence) * light,
            None => Stokes::unpolarised(1.0),
        };
        self.light = Some(((vertex.mirror * arriving).carried(), emergence.carried()));
    }
}

impl<const N: usize> Carrying<N> {
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
    let scattered = material.optics.albedo() * arriving.i();
    let mirrored = (vertex.mirror * arriving).i();
    scattered + mirrored
}
