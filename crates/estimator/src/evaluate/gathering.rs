//! Light along a walk from a sensor.

use super::chain::Chain;
use super::{Reading, Readings, bridged, emitted, passed_at};
use crate::gather::Part;
use crate::path::{Connection, Event, Path, Vertex};
use crate::radiosity::Guess;
use crate::receiver::Receiver;
use crate::variation::Variation;

/// What a sensor reads of a walk that was started from it.
#[derive(Debug)]
pub(crate) struct Gathering<'r, const N: usize> {
    receiver: &'r Receiver,
    /// Its place among the fluxes that walks from the emitters bring.
    place: usize,
    /// Divided by the probability of every event on the way: apart, the two would leave the range of numbers on a long
    /// walk, one to either side.
    chain: Chain<N>,
    readings: Readings<N>,
    /// Which of the readings light is added to.
    shared: bool,
}

impl<'r, const N: usize> Gathering<'r, N> {
    /// Nothing read yet; `place` is its own among the fluxes that walks from the emitters bring.
    #[must_use]
    pub(crate) fn new(receiver: &'r Receiver, place: usize) -> Self {
        Self {
            receiver,
            place,
            chain: Chain::ToSensor(None),
            readings: [Reading::nothing(); 2],
            shared: false,
        }
    }

    /// What was read.
    #[must_use]
    pub(crate) fn readings(&self) -> &Readings<N> {
        &self.readings
    }

    fn reading(&mut self) -> &mut Reading<N> {
        &mut self.readings[usize::from(self.shared)]
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
        self.shared = false;
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
                let light = emitted(direction, crate::site::emitted_state(material));
                let read = self.chain.pass(self.receiver, direction, light)
                    * (emission.exitance * vertex.emission * self.receiver.per_exitance);
                let reading = self.reading();
                reading.found[1] += read.i();
                reading.sum += read;
            }
            self.shared |= vertex.shared;
            let scattering = match vertex.black {
                true => 0.0,
                false => material.optics.scattering(),
            };
            let Guess {
                irradiance,
                exitance,
            } = vertex.guess;
            let missing = scattering * irradiance - exitance;
            if missing != 0.0 {
                let read = self.chain.pass(self.receiver, -vertex.arriving, None)
                    * (missing * self.receiver.per_exitance);
                self.reading().sum += read;
            }
            if vertex.black {
                return;
            }
            for connection in &path.connections[vertex.connections.clone()] {
                let chain =
                    self.chain
                        .behind(self.receiver, &material.optics, vertex, connection.toward);
                let weight = scattering * self.receiver.per_exitance;
                self.connect(path, connection, chain, weight, variation);
            }
            self.bridge(path, vertex, variation);
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

    /// Adds the light of walks from the emitters that a vertex is joined to.
    fn bridge(&mut self, path: &Path, vertex: &Vertex, variation: &Variation) {
        let optics = &variation.materials[vertex.material as usize].optics;
        let strength = optics.scattering() * self.receiver.per_exitance;
        // What comes unpolarised is the same from everywhere to a surface that does not ask for more.
        let mut even = path.lit[vertex.lit.clone()]
            .get(self.place)
            .copied()
            .unwrap_or(0.0);
        for bridge in &path.bridges[vertex.bridges.clone()] {
            let flux = bridge.fluxes[self.place] * bridge.weight;
            let from = &variation.materials[bridge.from.material as usize].optics;
            let light = bridged(from, bridge);
            if light.is_none() && !optics.polarises_scattering() {
                even += flux;
                continue;
            }
            let toward = bridge.toward;
            let chain = self.chain.behind(self.receiver, optics, vertex, toward);
            let read = chain.pass(self.receiver, -toward, light) * (strength * flux);
            self.reading().sum += read;
        }
        if even > 0.0 {
            let chain = self
                .chain
                .behind(self.receiver, optics, vertex, vertex.normal);
            let read = chain.pass(self.receiver, -vertex.normal, None) * (strength * even);
            self.reading().sum += read;
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
        let reading = self.reading();
        if connection.mirrored {
            reading.found[0] += read.i();
        }
        reading.sum += read;
    }
}
