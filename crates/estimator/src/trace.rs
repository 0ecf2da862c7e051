//! A walk through geometry: no Stokes vector, no number of components.
//!
//! Every decision is taken from geometry and from bounds that hold for any state of light: ρ(1 − a) for
//! the diffuse lobe, a · max(Rs, Rp) for the mirror-like one. So the same walk serves every number of
//! components and the scalar model beside the polarised one, and no weight can grow along a chain.

use crate::direction::cosine_weighted;
use crate::emitters::{Choice, Emitters, Incoming};
use crate::random::{Purpose, Uniforms};
use glam::DVec3;
use malus_geometry::Surfaces;
use malus_optics::Reflection;
use malus_scene::Material;
use std::f64::consts::PI;

/// Longest walk, in vertices. What is left of it then is dropped and counted.
pub(crate) const LONGEST: u32 = 1_000_000;

/// Vertices that a path holds at once; a longer walk is handed over in pieces.
const PIECE: usize = 1024;

/// What a walk moves through.
#[derive(Clone, Copy)]
pub(crate) struct Medium<'a> {
    /// Where surfaces are.
    pub surfaces: &'a Surfaces,
    /// What they do to light, by surface index.
    pub materials: &'a [Material],
    /// Where light comes from.
    pub emitters: &'a Emitters<'a>,
}

/// How a walk goes on at a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Event {
    /// It ends.
    Absorbed,
    /// Mirror-like reflection.
    Mirror,
    /// Into a random direction, by Lambert's law.
    Diffuse,
}

/// A light seen from a point of a walk, past everything between.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Connection<'a> {
    /// What arrives.
    pub incoming: Incoming<'a>,
    /// Irradiance of the receiving surface, weighted against finding the light by chance, in unit/m².
    pub irradiance: f64,
}

/// A point where a walk met a surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vertex<'a> {
    /// Index of the material met.
    pub material: u32,
    /// Where, moved off the surface towards the side that the walk came from.
    pub position: DVec3,
    /// Unit normal on that side.
    pub normal: DVec3,
    /// Direction of the walk on arrival.
    pub arriving: DVec3,
    /// Mirror-like reflection under this angle; its scale holds a.
    pub mirror: Reflection,
    /// Share of the light that the surface emits towards the walk for which this walk answers: 0 if it emits none.
    pub emission: f64,
    /// What this point sees of the emitters, if it was asked.
    pub connection: Option<Connection<'a>>,
    /// How the walk goes on.
    pub event: Event,
    /// Probability of that event.
    pub probability: f64,
    /// True where the back of a one-sided surface was met: it neither reflects nor emits.
    pub black: bool,
}

/// Successive vertices of a walk.
pub(crate) type Path<'a> = Vec<Vertex<'a>>;

/// A walk under way.
pub(crate) struct Walk<'a> {
    medium: Medium<'a>,
    uniforms: Uniforms,
    origin: DVec3,
    direction: DVec3,
    depth: u32,
    search: Search,
    /// True if the walk ended at [`LONGEST`].
    pub truncated: bool,
}

/// Whether a walk looks for light, and how it might have found the next surface's emission otherwise.
#[derive(Debug, Clone, Copy)]
enum Search {
    /// It carries light itself.
    Never,
    /// Density per solid angle of its direction, and the table that the last vertex looked into.
    Sampled { density: f64, choice: Choice },
    /// It came off a mirror: no other technique sees what it meets.
    Mirrored,
}

impl<'a> Walk<'a> {
    /// A walk that carries light away from an emitter.
    pub(crate) fn from_emitter(
        medium: Medium<'a>,
        uniforms: Uniforms,
        origin: DVec3,
        direction: DVec3,
    ) -> Self {
        Self {
            medium,
            uniforms,
            origin,
            direction,
            depth: 0,
            search: Search::Never,
            truncated: false,
        }
    }

    /// A walk from a sensor, against the light, with density cos θ/π.
    pub(crate) fn from_sensor(
        medium: Medium<'a>,
        uniforms: Uniforms,
        origin: DVec3,
        normal: DVec3,
    ) -> Self {
        let [_, u, v, _] = uniforms.at(0, Purpose::Scatter);
        let direction = cosine_weighted(normal, [u, v]);
        Self {
            medium,
            uniforms,
            origin,
            direction,
            depth: 0,
            search: Search::Sampled {
                density: normal.dot(direction) / PI,
                choice: Choice::Areas,
            },
            truncated: false,
        }
    }

    /// What the sensor that the walk starts from sees of the emitting surfaces.
    pub(crate) fn first_connection(&self, normal: DVec3) -> Option<Connection<'a>> {
        self.connection(self.origin, normal, 1.0, Choice::Areas)
    }

    /// Where the walk goes on from, and its direction: of one that has left the scene, the ray on which it left.
    pub(crate) fn ray(&self) -> (DVec3, DVec3) {
        (self.origin, self.direction)
    }

    /// Appends the next vertices to `path`; false once the walk has ended.
    pub(crate) fn advance(&mut self, path: &mut Path<'a>) -> bool {
        while path.len() < PIECE {
            let Some(vertex) = self.next_vertex() else {
                return false;
            };
            path.push(vertex);
            if vertex.event == Event::Absorbed {
                return false;
            }
        }
        true
    }

    fn next_vertex(&mut self) -> Option<Vertex<'a>> {
        let Medium {
            surfaces,
            materials,
            ..
        } = self.medium;
        if self.depth == LONGEST {
            self.truncated = true;
            return None;
        }
        self.depth += 1;
        let hit = surfaces.nearest(self.origin, self.direction)?;
        let outward = surfaces.normal(hit.triangle);
        let front = self.direction.dot(outward) < 0.0;
        let normal = if front { outward } else { -outward };
        let index = surfaces.surface(hit.triangle);
        let material = &materials[index as usize];
        let position = hit.position + normal * surfaces.offset();
        let cos = -self.direction.dot(normal);
        let sin2 = self.direction.cross(normal).length_squared();

        let mut vertex = Vertex {
            material: index,
            position,
            normal,
            arriving: self.direction,
            mirror: Reflection::NONE,
            emission: if front {
                self.emission_share(material, hit.distance, cos)
            } else {
                0.0
            },
            connection: None,
            event: Event::Absorbed,
            probability: 1.0,
            black: !front && !material.two_sided,
        };
        if vertex.black {
            return Some(vertex);
        }
        vertex.mirror = material.optics.mirror(cos, sin2);
        let (diffuse, mirror) = lobes(material.optics.albedo(), vertex.mirror.bound());
        if diffuse > 0.0 && !matches!(self.search, Search::Never) {
            vertex.connection = self.connection(position, normal, diffuse, Choice::All);
        }
        let [lobe, u, v, _] = self.uniforms.at(self.depth, Purpose::Scatter);
        self.origin = position;
        if lobe < diffuse {
            vertex.event = Event::Diffuse;
            vertex.probability = diffuse;
            self.direction = cosine_weighted(normal, [u, v]);
            if !matches!(self.search, Search::Never) {
                self.search = Search::Sampled {
                    density: diffuse * normal.dot(self.direction) / PI,
                    choice: Choice::All,
                };
            }
        } else if lobe < diffuse + mirror {
            vertex.event = Event::Mirror;
            vertex.probability = mirror;
            self.direction = (self.direction + normal * (2.0 * cos)).normalize();
            if !matches!(self.search, Search::Never) {
                self.search = Search::Mirrored;
            }
        }
        Some(vertex)
    }

    /// Weight of meeting an emitter by chance against looking at it (balance heuristic; Veach & Guibas 1995).
    fn emission_share(&self, material: &Material, distance: f64, cos: f64) -> f64 {
        let Some(emission) = &material.emission else {
            return 0.0;
        };
        match self.search {
            Search::Never => 0.0,
            Search::Mirrored => 1.0,
            Search::Sampled { density, choice } => {
                let looked = self
                    .medium
                    .emitters
                    .density(choice, emission.exitance, distance, cos);
                density / (density + looked)
            }
        }
    }

    /// What the point sees of one emitter, weighted against meeting it by chance in a direction that is drawn with
    /// the probability `diffuse` and the density cos θ/π.
    fn connection(
        &self,
        point: DVec3,
        normal: DVec3,
        diffuse: f64,
        choice: Choice,
    ) -> Option<Connection<'a>> {
        let uniforms = self.uniforms.at(self.depth, Purpose::Connect);
        let incoming = self.medium.emitters.look(choice, point, uniforms)?;
        let cos = incoming.toward.dot(normal);
        if cos <= 0.0 || !unobstructed(self.medium.surfaces, point, &incoming) {
            return None;
        }
        let weight = incoming
            .density
            .map_or(1.0, |looked| looked / (looked + diffuse * cos / PI));
        Some(Connection {
            incoming,
            irradiance: incoming.irradiance * cos * weight,
        })
    }
}

/// True if nothing lies between the point and the emitter.
pub(crate) fn unobstructed(surfaces: &Surfaces, point: DVec3, incoming: &Incoming) -> bool {
    match incoming.from {
        Some(from) => surfaces.visible(point, from),
        None => surfaces.escapes(point, incoming.toward),
    }
}

/// Probabilities of the diffuse and the mirror-like lobe, from their bounds; scaled down where they sum above 1.
fn lobes(diffuse: f64, mirror: f64) -> (f64, f64) {
    let sum = diffuse + mirror;
    if sum > 1.0 {
        (diffuse / sum, mirror / sum)
    } else {
        (diffuse, mirror)
    }
}
