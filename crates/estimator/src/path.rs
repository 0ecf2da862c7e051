//! What a walk has met, as light is sent along it.

use crate::bridge::{Candidates, Landing};
use crate::launched::Rival;
use crate::medium::Step;
use crate::radiosity::Guess;
use crate::site::State;
use crate::variation::Origin;
use glam::DVec3;
use malus_optics::Reflection;
use std::ops::Range;

/// How a walk goes on at a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Event {
    /// It ends.
    Absorbed,
    /// Mirror-like reflection.
    Mirror,
    /// Straight through a pane.
    Through,
    /// Into a random direction, by Lambert's law.
    Diffuse,
}

/// A light seen from a point of a walk.
#[derive(Debug, Clone)]
pub(crate) struct Connection<'a> {
    /// Who sends it.
    pub origin: Origin,
    /// State of the light.
    pub state: State<'a>,
    /// Unit vector from the point towards it, or towards the first mirror.
    pub toward: DVec3,
    /// Direction in which the light leaves.
    pub leaving: DVec3,
    /// Irradiance of the receiving surface, weighted against other techniques; mirrors and panes are still to be applied.
    pub irradiance: f64,
    /// Mirrors and panes on the way, among the path's steps.
    pub steps: Range<usize>,
    /// Whether there is a mirror among them.
    pub mirrored: bool,
}

/// A point of a walk from an emitter, seen from one of a walk from a sensor.
#[derive(Debug, Clone)]
pub(crate) struct Bridge<'a> {
    /// Where the light is scattered.
    pub from: &'a Landing,
    /// The flux that is scattered there, in every variant and model.
    pub fluxes: &'a [f64],
    /// Unit vector to there.
    pub toward: DVec3,
    /// Irradiance of the receiving surface for one unit of scattered flux, weighted against other techniques, in 1/m².
    pub weight: f64,
}

/// A point where a walk met a surface.
#[derive(Debug, Clone)]
pub(crate) struct Vertex {
    /// Index of the material met.
    pub material: u32,
    /// Where, moved off the surface towards the side that the walk came from.
    pub position: DVec3,
    /// Unit normal on that side.
    pub normal: DVec3,
    /// Direction of the walk on arrival.
    pub arriving: DVec3,
    /// Direction in which it goes on.
    pub onward: DVec3,
    /// Mirror-like reflection, or what a pane lets through where the walk goes on like that, in the first variant.
    pub matrix: Reflection,
    /// Share of the light that the surface emits towards the walk for which this walk answers: 0 if it emits none.
    pub emission: f64,
    /// What this point sees of the emitters, if it was asked: a range of the path's connections.
    pub connections: Range<usize>,
    /// Walks from the emitters that it is joined to, where either end polarises: a range of the path's bridges.
    pub bridges: Range<usize>,
    /// What the others bring: a range of the path's.
    pub lit: Range<usize>,
    /// Probability of going on into a random direction.
    pub diffuse: f64,
    /// How the walk goes on.
    pub event: Event,
    /// Probability of that event.
    pub probability: f64,
    /// Whether it is a flat mirror that can be looked into.
    pub flat: bool,
    /// Whether what it scatters goes to the sensor's neighbours, too, by the path's shares.
    pub shared: bool,
    /// True where the back of a one-sided surface was met: it neither reflects nor emits.
    pub black: bool,
    /// What is known beforehand of the light here.
    pub guess: Guess,
    /// For a walk from an emitter: the techniques that compete with joining this point to a sensor.
    pub rival: Rival,
}

/// Successive vertices of a walk, with what they see.
#[derive(Debug, Default)]
pub(crate) struct Path<'a> {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// What they see of the emitters.
    pub connections: Vec<Connection<'a>>,
    /// Walks from the emitters that they are joined to.
    pub bridges: Vec<Bridge<'a>>,
    /// Irradiance by those, where neither end polarises, in every variant and model.
    pub lit: Vec<f64>,
    /// Room to choose some of them.
    pub candidates: Candidates,
    /// Mirrors and panes on the ways to them.
    pub steps: Vec<Step>,
    /// Each neighbour's share in what the walk finds behind its first vertex, where that is shared.
    pub shares: Vec<f64>,
    /// Room to ask which of them see a vertex.
    pub seen: Vec<bool>,
}

impl Path<'_> {
    /// Forgets everything but the shares, which hold for a whole walk.
    pub(crate) fn clear(&mut self) {
        self.vertices.clear();
        self.connections.clear();
        self.bridges.clear();
        self.lit.clear();
        self.steps.clear();
    }
}
