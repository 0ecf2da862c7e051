//! Light along a walk from a sensor in many variants at once.
//!
//! A strand is the light of those variants whose mirrors and panes on the way differ in strength alone: it has one chain of
//! matrices, and each variant has a weight. Strands part where the walk passes a mirror that is of another kind in some of
//! them, so many variants cost little more than one.

use super::chain::Chain;
use super::{Reading, Readings, bridged, emitted, passed_at};
use crate::gather::Part;
use crate::path::{Bridge, Connection, Event, Path, Vertex};
use crate::receiver::Receiver;
use crate::site::state_of;
use crate::spread::{Spread, Surface};

/// What a sensor reads of a walk in every variant.
#[derive(Debug)]
pub(crate) struct Strands<'r, const N: usize> {
    receiver: &'r Receiver,
    spread: &'r Spread,
    /// The first of its places among the fluxes that walks from the emitters bring.
    first: usize,
    strands: Vec<Strand<N>>,
    readings: Vec<Readings<N>>,
    /// Which of its readings each variant's light is added to.
    shared: bool,
}

#[derive(Debug, Clone)]
struct Strand<const N: usize> {
    chain: Chain<N>,
    members: Vec<Member>,
}

/// A variant, with its light relative to that of its strand.
#[derive(Debug, Clone, Copy)]
struct Member {
    variant: usize,
    weight: f64,
}

impl<'r, const N: usize> Strands<'r, N> {
    /// Nothing read yet; `first` is the first of its places among the fluxes that walks from the emitters bring.
    pub(crate) fn new(receiver: &'r Receiver, spread: &'r Spread, first: usize) -> Self {
        Self {
            receiver,
            spread,
            first,
            strands: Vec::new(),
            readings: vec![[Reading::nothing(); 2]; spread.count()],
            shared: false,
        }
    }

    /// What each variant has read.
    pub(crate) fn readings(&self) -> &[Readings<N>] {
        &self.readings
    }

    fn reading(&mut self, variant: usize) -> &mut Reading<N> {
        &mut self.readings[variant][usize::from(self.shared)]
    }

    /// Light met along a piece of a walk.
    pub(crate) fn read(&mut self, path: &Path, part: Part) {
        match part {
            Part::Start => self.start(path),
            Part::Onward => {
                for vertex in &path.vertices {
                    if self.strands.is_empty() || !self.pass(path, vertex) {
                        self.strands.clear();
                        return;
                    }
                }
            }
        }
    }

    fn start(&mut self, path: &Path) {
        let member = |variant| Member {
            variant,
            weight: 1.0,
        };
        let all = Strand {
            chain: Chain::ToSensor(None),
            members: (0..self.spread.count()).map(member).collect(),
        };
        self.shared = false;
        for connection in &path.connections {
            self.connect(path, connection, all.chain, &all.members);
        }
        self.strands.clear();
        self.strands.push(all);
    }

    /// Passes a vertex; false where the walk ends.
    fn pass(&mut self, path: &Path, vertex: &Vertex) -> bool {
        let surface = self.spread.surface(vertex.material);
        if vertex.emission > 0.0 {
            self.meet(vertex, surface);
        }
        if vertex.black {
            return false;
        }
        self.shared |= vertex.shared;
        let polarises = surface.kind(0).polarises_scattering();
        let mirrored = matches!(vertex.event, Event::Mirror | Event::Through);
        if surface.has_kinds() && (mirrored || polarises) {
            self.part(surface);
        }
        let strands = std::mem::take(&mut self.strands);
        for connection in &path.connections[vertex.connections.clone()] {
            for strand in &strands {
                let optics = surface.kind(strand.members[0].variant);
                let chain = strand
                    .chain
                    .behind(self.receiver, optics, vertex, connection.toward);
                let scattered = |member: &Member| Member {
                    weight: member.weight
                        * surface.scattering[member.variant]
                        * self.receiver.per_exitance,
                    ..*member
                };
                let members: Vec<Member> = strand.members.iter().map(scattered).collect();
                self.connect(path, connection, chain, &members);
            }
        }
        if let lit @ [_, ..] = &path.lit[vertex.lit.clone()] {
            for strand in &strands {
                self.light(&lit[self.first..], vertex, surface, strand);
            }
        }
        for bridge in &path.bridges[vertex.bridges.clone()] {
            for strand in &strands {
                self.bridge(bridge, vertex, surface, strand);
            }
        }
        self.strands = strands;
        let (receiver, spread) = (self.receiver, self.spread);
        for strand in &mut self.strands {
            let first = strand.members[0].variant;
            match vertex.event {
                Event::Absorbed => return false,
                Event::Diffuse => {
                    let chain =
                        strand
                            .chain
                            .behind(receiver, surface.kind(first), vertex, vertex.onward);
                    strand.chain = chain.scaled(1.0 / vertex.probability);
                    for member in &mut strand.members {
                        member.weight *= surface.scattering[member.variant];
                    }
                }
                Event::Mirror | Event::Through => {
                    let recorded = passed_at(vertex);
                    let mut step = spread.step(&recorded, first);
                    step.matrix = step.matrix * (1.0 / vertex.probability);
                    strand.chain = strand.chain.extended(receiver, &step);
                    for member in &mut strand.members {
                        member.weight *= spread.strength(&recorded, member.variant);
                    }
                }
            }
            strand.members.retain(|member| member.weight > 0.0);
        }
        self.strands.retain(|strand| !strand.members.is_empty());
        true
    }

    /// An emitter met by chance.
    fn meet(&mut self, vertex: &Vertex, surface: &Surface) {
        let Some(emission) = &surface.emission else {
            return;
        };
        let direction = -vertex.arriving;
        let light = emitted(direction, state_of(&emission.state, emission.axis));
        for strand in &self.strands {
            let read = strand.chain.pass(self.receiver, direction, light)
                * (vertex.emission * self.receiver.per_exitance);
            for member in &strand.members {
                let read = read * (member.weight * surface.exitance[member.variant]);
                let reading = &mut self.readings[member.variant][usize::from(self.shared)];
                reading.found[1] += read.i();
                reading.sum += read;
            }
        }
    }

    /// Adds the light of a connection to its members, which goes on by the `chain`.
    fn connect(
        &mut self,
        path: &Path,
        connection: &Connection,
        chain: Chain<N>,
        members: &[Member],
    ) {
        let steps = &path.steps[connection.steps.clone()];
        let light = emitted(connection.leaving, connection.state);
        let share = self.spread.emitted(connection.origin);
        let mut left: Vec<Member> = members.to_vec();
        while let Some(&Member { variant: first, .. }) = left.first() {
            let chain = steps.iter().fold(chain, |chain, step| {
                chain.extended(self.receiver, &self.spread.step(step, first))
            });
            let read = chain.pass(self.receiver, connection.leaving, light) * connection.irradiance;
            left.retain(|&Member { variant, weight }| {
                if !steps
                    .iter()
                    .all(|step| self.spread.alike(step, first, variant))
                {
                    return true;
                }
                let mut weight = weight * share[variant];
                for step in steps {
                    weight *= self.spread.strength(step, variant);
                }
                let read = read * weight;
                let reading = self.reading(variant);
                if connection.mirrored {
                    reading.found[0] += read.i();
                }
                reading.sum += read;
                false
            });
        }
    }

    /// Adds the unpolarised light that walks from the emitters bring to a vertex, in every variant.
    fn light(&mut self, lit: &[f64], vertex: &Vertex, surface: &Surface, strand: &Strand<N>) {
        let optics = surface.kind(strand.members[0].variant);
        let chain = strand
            .chain
            .behind(self.receiver, optics, vertex, vertex.normal);
        let read = chain.pass(self.receiver, -vertex.normal, None);
        for member in &strand.members {
            let weight = member.weight * surface.scattering[member.variant] * lit[member.variant];
            let read = read * (weight * self.receiver.per_exitance);
            self.reading(member.variant).sum += read;
        }
    }

    /// Adds the light of a walk from an emitter that a vertex is joined to.
    fn bridge(&mut self, bridge: &Bridge, vertex: &Vertex, surface: &Surface, strand: &Strand<N>) {
        let from = self.spread.surface(bridge.from.material);
        let optics = surface.kind(strand.members[0].variant);
        let chain = strand
            .chain
            .behind(self.receiver, optics, vertex, bridge.toward);
        for member in &strand.members {
            let light = bridged(from.kind(member.variant), bridge);
            let flux = bridge.fluxes[self.first + member.variant] * bridge.weight;
            let weight = member.weight * surface.scattering[member.variant] * flux;
            let read = chain.pass(self.receiver, -bridge.toward, light)
                * (weight * self.receiver.per_exitance);
            self.reading(member.variant).sum += read;
        }
    }

    /// Parts strands whose members have this surface of different kinds.
    fn part(&mut self, surface: &Surface) {
        let mut parted = Vec::with_capacity(self.strands.len());
        for strand in self.strands.drain(..) {
            let mut left = strand.members;
            while let Some(&Member { variant: first, .. }) = left.first() {
                let (alike, others) = left
                    .into_iter()
                    .partition(|it| surface.alike(first, it.variant));
                parted.push(Strand {
                    chain: strand.chain,
                    members: alike,
                });
                left = others;
            }
        }
        self.strands = parted;
    }
}
