//! Light along a walk, for 1, 3 or 4 Stokes components: pure, after the walk is fixed.
//!
//! Polarisation lives only inside chains of mirrors and panes: a diffuse event takes the light in by an
//! analyser and gives it out by a Stokes vector of its own, so between chains light is one number.

mod strands;

pub(crate) use strands::Strands;

use crate::emitters::{Start, State};
use crate::gather::Part;
use crate::medium::Step;
use crate::path::{Connection, Event, Path, Vertex};
use crate::receiver::Receiver;
use crate::variation::Variation;
use glam::DVec3;
use malus_optics::{
    Analyser, Basis, Carried, Emergence, Incidence, Material as Optics, Mueller, Rotator, Sensor,
    Stokes, angle_of_incidence,
};
use malus_scene::Material;

/// Light on its way, per unit of what it started with, in a basis of its own; `None`: unpolarised.
type Light<const N: usize> = Option<(Stokes<N, Carried>, Basis<Carried>)>;

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

/// What a sensor reads of a walk that was started from it.
#[derive(Debug)]
pub(crate) struct Gathering<'r, const N: usize> {
    receiver: &'r Receiver,
    /// Divided by the probability of every event on the way: apart, the two would leave the range of numbers on a long
    /// walk, one to either side.
    chain: Chain<N>,
    sum: Stokes<N, Sensor>,
    /// S0 of light seen in mirrors, and of emitters met by chance.
    found: [f64; 2],
}

/// The mirrors and panes that a walk has met since its last diffuse event, as light meets them on its way to the sensor.
#[derive(Debug, Clone, Copy)]
enum Chain<const N: usize> {
    /// No diffuse event yet: the whole matrix up to the sensor is needed.
    ToSensor(Option<(Mueller<N, Incidence, Sensor>, Basis<Incidence>)>),
    /// Behind a diffuse event, which sends `leaving` to the sensor: one row is enough.
    ToDiffuser {
        leaving: Stokes<N, Sensor>,
        row: Option<(Analyser<N, Incidence>, Basis<Incidence>)>,
    },
}

impl<const N: usize> Chain<N> {
    /// Light that comes along a direction, once it has reached the sensor.
    fn pass(&self, receiver: &Receiver, direction: DVec3, light: Light<N>) -> Stokes<N, Sensor> {
        match (self, light) {
            (Self::ToSensor(None), _) => at_sensor(receiver, direction, light),
            (Self::ToSensor(Some((matrix, basis))), Some((light, carried))) => {
                *matrix * (Rotator::new(&carried, basis) * light)
            }
            (Self::ToSensor(Some((matrix, _))), None) => *matrix * Stokes::unpolarised(1.0),
            (Self::ToDiffuser { leaving, row: None }, light) => {
                *leaving * light.map_or(1.0, |(light, _)| light.i())
            }
            (
                Self::ToDiffuser {
                    leaving,
                    row: Some((row, basis)),
                },
                Some((light, carried)),
            ) => *leaving * (*row * (Rotator::new(&carried, basis) * light)),
            (
                Self::ToDiffuser {
                    leaving,
                    row: Some((row, _)),
                },
                None,
            ) => *leaving * (*row * Stokes::unpolarised(1.0)),
        }
    }

    /// The chain with one more mirror or pane before it.
    fn extended(&self, receiver: &Receiver, step: &Step) -> Self {
        let normal = step.normal;
        let onward = if step.through {
            step.arriving
        } else {
            (step.arriving - normal * (2.0 * step.arriving.dot(normal))).normalize()
        };
        let (incidence, reflected) = Basis::mirror(-onward, normal);
        let carried = if step.through {
            Basis::<Emergence>::new(-onward, incidence.axis()).carried()
        } else {
            reflected.carried()
        };
        match self {
            Self::ToSensor(matrix) => {
                let onward: Mueller<N, Emergence, Sensor> = match matrix {
                    None => {
                        let sensor = receiver.basis(carried.direction());
                        Mueller::from(Rotator::new(&carried, &sensor)).emergent()
                    }
                    Some((matrix, basis)) => (*matrix * Rotator::new(&carried, basis)).emergent(),
                };
                Self::ToSensor(Some((onward * step.matrix, incidence)))
            }
            Self::ToDiffuser { leaving, row } => {
                let onward: Analyser<N, Emergence> = match row {
                    None => Analyser::intensity(),
                    Some((row, basis)) => (*row * Rotator::new(&carried, basis)).emergent(),
                };
                Self::ToDiffuser {
                    leaving: *leaving,
                    row: Some((onward * step.matrix, incidence)),
                }
            }
        }
    }

    /// The chain behind a scattering surface that sends light against `arriving`, for light that comes to it against
    /// `toward`.
    fn behind(&self, receiver: &Receiver, optics: &Optics, vertex: &Vertex, toward: DVec3) -> Self {
        let direction = -vertex.arriving;
        if optics.polarises_scattering() {
            let light = scattered(optics, vertex.normal, direction);
            return Self::ToDiffuser {
                leaving: self.pass(receiver, direction, light),
                row: Some(taken_in(optics, vertex.normal, -toward)),
            };
        }
        Self::ToDiffuser {
            leaving: self.pass(receiver, direction, None),
            row: None,
        }
    }

    /// The chain behind a diffuse event, times a factor.
    fn scaled(mut self, factor: f64) -> Self {
        if let Self::ToDiffuser { leaving, .. } = &mut self {
            *leaving = *leaving * factor;
        }
        self
    }
}

impl<'r, const N: usize> Gathering<'r, N> {
    /// Nothing read yet.
    #[must_use]
    pub(crate) fn new(receiver: &'r Receiver) -> Self {
        Self {
            receiver,
            chain: Chain::ToSensor(None),
            sum: Stokes::unpolarised(0.0),
            found: [0.0; 2],
        }
    }

    /// The irradiance read, in the sensor's basis.
    #[must_use]
    pub(crate) fn sum(&self) -> [f64; N] {
        self.sum.components()
    }

    /// Of S0, what was seen in mirrors and what was met by chance.
    #[must_use]
    pub(crate) fn found(&self) -> [f64; 2] {
        self.found
    }

    /// Light met along a piece of a walk.
    pub(crate) fn read(&mut self, path: &Path, part: Part, variation: &Variation) {
        match part {
            Part::Start => self.look(path, variation),
            Part::Onward => self.follow(path, variation),
        }
    }

    /// Light that the sensor sees before the walk has left it.
    fn look(&mut self, path: &Path, variation: &Variation) {
        self.chain = Chain::ToSensor(None);
        for connection in &path.connections {
            let chain = self.chain;
            self.connect(path, connection, chain, 1.0, variation);
        }
    }

    /// Light met along the next vertices of the walk.
    fn follow(&mut self, path: &Path, variation: &Variation) {
        for vertex in &path.vertices {
            let material = &variation.materials[vertex.material as usize];
            if vertex.emission > 0.0
                && let Some(emission) = &material.emission
            {
                let direction = -vertex.arriving;
                let light = emitted(direction, crate::emitters::emitted_state(material));
                let read = self.chain.pass(self.receiver, direction, light)
                    * (emission.exitance * vertex.emission * self.receiver.per_exitance);
                self.found[1] += read.i();
                self.sum += read;
            }
            if vertex.black {
                return;
            }
            let scattering = material.optics.scattering();
            for connection in &path.connections[vertex.connections.clone()] {
                let chain =
                    self.chain
                        .behind(self.receiver, &material.optics, vertex, connection.toward);
                let weight = scattering * self.receiver.per_exitance;
                self.connect(path, connection, chain, weight, variation);
            }
            match vertex.event {
                Event::Absorbed => return,
                Event::Diffuse => {
                    self.chain = self
                        .chain
                        .behind(self.receiver, &material.optics, vertex, vertex.onward)
                        .scaled(scattering / vertex.probability);
                }
                Event::Mirror | Event::Through => {
                    let mut step = variation.step(&passed_at(vertex));
                    // Divided here: a product of thousands of reflectances has no number, nor has one over it.
                    step.matrix = step.matrix * (1.0 / vertex.probability);
                    self.chain = self.chain.extended(self.receiver, &step);
                }
            }
        }
    }

    /// Adds the light of a connection, which goes on by the `chain`.
    fn connect(
        &mut self,
        path: &Path,
        connection: &Connection,
        mut chain: Chain<N>,
        weight: f64,
        variation: &Variation,
    ) {
        for step in &path.steps[connection.steps.clone()] {
            chain = chain.extended(self.receiver, &variation.step(step));
        }
        let light = emitted(connection.leaving, connection.state);
        let strength = weight * connection.irradiance * variation.emitted(connection.origin);
        let read = chain.pass(self.receiver, connection.leaving, light) * strength;
        if connection.mirrored {
            self.found[0] += read.i();
        }
        self.sum += read;
    }
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
