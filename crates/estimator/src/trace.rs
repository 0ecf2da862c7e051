//! A walk through geometry: no Stokes vector, no number of components.
//!
//! Every decision is taken from geometry and from bounds that hold for any state of light: ρ(1 − a) for
//! the diffuse lobe, a · max(Rs, Rp) for the mirror-like one. So the same walk serves every number of
//! components and the scalar model beside the polarised one, and no weight can grow along a chain.

mod cross;
mod look;

use crate::bridge::Partners;
use crate::direction::cosine_weighted;
use crate::emitters::Choice;
use crate::glints::Aim;
use crate::launched::{Launched, Rival};
use crate::lookout::Lookout;
use crate::medium::{Medium, Meeting};
use crate::mirrors::Viewer;
use crate::neighbours::Member;
use crate::path::{Event, Path, Vertex};
use crate::radiosity::Guess;
use crate::random::{Purpose, Uniforms};
use crate::receiver::Receiver;
use crate::sight::Seen;
use crate::site::Start;
use crate::techniques::Techniques;
use glam::DVec3;
use look::Look;
use malus_geometry::Hit;
use malus_optics::Reflection;
use std::f64::consts::PI;

/// Longest walk, in vertices. What is left of it then is dropped and counted.
pub(crate) const LONGEST: u32 = 1_000_000;

/// Vertices that a path holds at once; a longer walk is handed over in pieces.
const PIECE: usize = 1024;

/// A walk under way.
pub(crate) struct Walk<'a> {
    medium: Medium<'a>,
    techniques: Techniques,
    uniforms: Uniforms,
    origin: DVec3,
    direction: DVec3,
    depth: u32,
    /// How walks are aimed at small mirrors from this sensor.
    aim: Option<&'a Aim<'a>>,
    /// Walks from emitters that a walk from a sensor is joined to.
    partners: Option<Partners<'a>>,
    /// The sensor among those with which a walk from it is shared.
    member: Option<Member<'a>>,
    role: Role<'a>,
    /// Where a walk from a sensor was mirrored at its first vertex, which is followed when the rest of it has ended.
    branch: Option<Branch>,
    /// True if the walk ended at [`LONGEST`].
    pub truncated: bool,
}

/// The mirror-like reflection of a walk from a sensor at its first vertex.
struct Branch {
    vertex: Vertex,
    lookout: Lookout,
}

/// A walk from a sensor that is aimed at a small mirror, and takes the way of its reflection.
struct Aimed {
    /// The mirror.
    triangle: u32,
    /// Density of the direction for a walk that is not aimed.
    by_chance: f64,
    /// Share of the light met for which this walk answers.
    share: f64,
}

/// What a walk is for.
enum Role<'a> {
    /// It looks for light by mirrors alone, the first of which it was aimed at.
    Aimed(Aimed),
    /// It carries light from an emitter.
    Launched(Launched<'a>),
    /// It looks for light, from a sensor.
    Looking(Lookout),
}

impl Role<'_> {
    /// Which numbers decide how the walk goes on.
    fn scattering(&self) -> Purpose {
        match self {
            Self::Launched(_) => Purpose::Scatter,
            Self::Aimed(_) | Self::Looking(_) => Purpose::Search,
        }
    }
}

impl<'a> Walk<'a> {
    /// A walk that carries light away from an emitter.
    pub(crate) fn from_emitter(
        medium: Medium<'a>,
        techniques: Techniques,
        uniforms: Uniforms,
        start: &Start<'a>,
    ) -> Self {
        Self {
            medium,
            techniques,
            uniforms,
            origin: start.origin,
            direction: start.direction,
            depth: 0,
            aim: None,
            partners: None,
            member: None,
            role: Role::Launched(Launched::new(start)),
            branch: None,
            truncated: false,
        }
    }

    /// A walk from a sensor, against the light: with density cos θ/π, or where its sensor looks.
    pub(crate) fn from_sensor(
        medium: Medium<'a>,
        techniques: Techniques,
        uniforms: Uniforms,
        receiver: &Receiver,
        aim: Option<&'a Aim<'a>>,
        partners: Option<Partners<'a>>,
        member: Option<Member<'a>>,
    ) -> Self {
        let Receiver { origin, normal, .. } = *receiver;
        let (direction, lookout) = if receiver.is_irradiance() {
            let [_, u, v, _] = uniforms.at(0, Purpose::Search);
            let direction = cosine_weighted(normal, [u, v]);
            // Light of sources without geometry is summed exactly, but not in long chains of mirrors.
            let listed = medium.mirrors.all_images_are_listed();
            let choice = if techniques.mirrored && !listed {
                Choice::All
            } else {
                Choice::Areas
            };
            (direction, Lookout::of_sensor(receiver, direction, choice))
        } else {
            (normal, Lookout::along(receiver))
        };
        Self {
            medium,
            techniques,
            uniforms,
            origin,
            direction,
            depth: 0,
            aim,
            partners,
            member,
            role: Role::Looking(lookout),
            branch: None,
            truncated: false,
        }
    }

    /// The companion of a walk from a sensor: aimed at a small mirror, it looks for emitters there. `None` where the mirror
    /// lies below the horizon.
    pub(crate) fn aimed(
        medium: Medium<'a>,
        techniques: Techniques,
        uniforms: Uniforms,
        receiver: &Receiver,
        aim: &'a Aim<'a>,
    ) -> Option<Self> {
        let (triangle, direction) = aim.drawn(uniforms.at(0, Purpose::Glint));
        let cos = direction.dot(receiver.normal);
        (cos > 0.0).then(|| Self {
            medium,
            techniques,
            uniforms,
            origin: receiver.origin,
            direction,
            depth: 0,
            aim: Some(aim),
            partners: None,
            member: None,
            role: Role::Aimed(Aimed {
                triangle,
                by_chance: cos / PI,
                share: 0.0,
            }),
            branch: None,
            truncated: false,
        })
    }

    /// Appends what the sensor that the walk starts from sees of the emitters.
    pub(crate) fn look(&self, path: &mut Path<'a>) {
        if let Role::Looking(lookout) = &self.role
            && !lookout.alone
            && (!lookout.seen.everything() || self.looks_into_mirrors())
        {
            let look = Look {
                viewer: lookout.viewer,
                choice: lookout.choice,
                known: lookout.seen,
                diffuse: 1.0,
            };
            self.connect(path, &look, &|_| 0.0);
        }
    }

    /// Whether its points look for emitters in mirrors.
    fn looks_into_mirrors(&self) -> bool {
        self.techniques.mirrored && !self.medium.mirrors.is_empty()
    }

    /// Where the walk goes on from, and its direction: of one that has left the scene, the ray on which it left.
    pub(crate) fn ray(&self) -> (DVec3, DVec3) {
        (self.origin, self.direction)
    }

    /// Appends the next vertices to `path`; false once the walk has ended.
    pub(crate) fn advance(&mut self, path: &mut Path<'a>) -> bool {
        while path.vertices.len() < PIECE {
            if matches!(self.push_vertex(path), None | Some(Event::Absorbed)) {
                return false;
            }
        }
        true
    }

    /// Turns to the reflection at the walk's first vertex, if there is one to be followed, and gives that vertex.
    pub(crate) fn turn(&mut self) -> Option<Vertex> {
        let Branch { vertex, lookout } = self.branch.take()?;
        self.origin = vertex.position;
        self.direction = vertex.onward;
        self.depth = 1;
        self.role = Role::Looking(lookout);
        self.truncated = false;
        Some(vertex)
    }

    /// Appends the next vertex; `None` where there is none.
    fn push_vertex(&mut self, path: &mut Path<'a>) -> Option<Event> {
        if self.depth == LONGEST {
            self.truncated = true;
            return None;
        }
        self.depth += 1;
        let (hit, meeting) = self.medium.meet(self.origin, self.direction)?;
        let guess = self.guess(&hit, meeting.normal);
        let emission = match guess.is_some() && self.depth > 1 {
            // Known where the walk came from.
            true => 0.0,
            false => self.emission_share(&hit, &meeting),
        };
        // Aiming is for the first mirror alone.
        let aim = self.aim.filter(|_| self.depth == 1);
        let density = aim.map_or(0.0, |aim| {
            aim.density(hit.triangle, hit.distance, meeting.angle.0)
        });
        if let (Role::Aimed(aimed), 1) = (&mut self.role, self.depth) {
            // What stands before the mirror was not aimed at.
            if hit.triangle != aimed.triangle {
                return None;
            }
            aimed.share = aimed.by_chance / (aimed.by_chance + density);
        }
        let normal = meeting.normal;
        let off = normal * self.medium.surfaces.offset();
        let mut vertex = Vertex {
            material: meeting.index,
            position: hit.position + off,
            normal,
            arriving: self.direction,
            onward: self.direction,
            matrix: Reflection::NONE,
            emission,
            connections: 0..0,
            bridges: 0..0,
            lit: 0..0,
            diffuse: 0.0,
            event: Event::Absorbed,
            probability: 1.0,
            flat: meeting.facet.is_some(),
            shared: false,
            black: meeting.black(),
            guess: guess.unwrap_or_default(),
            rival: Rival::default(),
        };
        if vertex.black {
            path.vertices.push(vertex);
            return Some(Event::Absorbed);
        }
        let (mirror, through) = meeting.matrices();
        let mut odds = meeting.odds(&mirror, &through);
        match &mut self.role {
            Role::Aimed(_) => odds = odds.of_mirrors(self.depth == 1),
            Role::Launched(launched) => {
                launched.go(hit.distance);
                odds.diffuse *= self.techniques.launched(meeting.cover);
            }
            Role::Looking(lookout) => {
                lookout.go(hit.distance);
                if let (Some(member), 1) = (self.member, self.depth)
                    && odds.diffuse > 0.0
                    && !meeting.cover.polarises_scattering()
                {
                    vertex.shared = true;
                    let Path { seen, shares, .. } = path;
                    lookout.share(member.share(
                        self.medium.surfaces,
                        [hit.position, vertex.position],
                        normal,
                        seen,
                        shares,
                    ));
                }
            }
        }
        vertex.diffuse = odds.diffuse;
        // A guess looks at all emitters from everywhere.
        if odds.diffuse > 0.0 && meeting.cover.scatters() && guess.is_none() {
            self.join(path, &mut vertex, &meeting);
        }
        let [lobe, u, v, split] = self.uniforms.at(self.depth, self.role.scattering());
        self.origin = vertex.position;
        let arriving = self.direction;
        let mirrored = || meeting.mirrored(arriving);
        if let (Role::Looking(lookout), 1) = (&self.role, self.depth) {
            let probability = odds.mirrored(true);
            if split < probability {
                let mut lookout = lookout.clone();
                lookout.chain.reflect(meeting.facet, probability);
                lookout.aimed(density);
                let vertex = Vertex {
                    onward: mirrored(),
                    matrix: mirror,
                    emission: 0.0,
                    shared: false,
                    connections: 0..0,
                    bridges: 0..0,
                    lit: 0..0,
                    event: Event::Mirror,
                    probability,
                    ..vertex
                };
                self.branch = Some(Branch { vertex, lookout });
            }
            odds.mirror = 0.0;
        }
        if lobe < odds.diffuse {
            vertex.event = Event::Diffuse;
            vertex.probability = odds.diffuse;
            self.direction = cosine_weighted(normal, [u, v]);
            let out = self.reverse(&meeting, self.direction);
            let viewer = Viewer {
                point: vertex.position,
                normal,
                sensor: false,
            };
            let techniques = self.techniques;
            match &mut self.role {
                Role::Aimed(_) => {}
                Role::Launched(launched) => {
                    launched.scatter(vertex.rival, odds.diffuse, out);
                }
                Role::Looking(lookout) => {
                    lookout.scatter(
                        viewer,
                        meeting.angle.0,
                        self.direction,
                        odds.diffuse,
                        out,
                        techniques,
                    );
                }
            }
        } else if lobe < odds.diffuse + odds.mirror {
            vertex.event = Event::Mirror;
            vertex.probability = odds.mirror;
            vertex.matrix = mirror;
            self.direction = mirrored();
            match &mut self.role {
                Role::Aimed(_) => {}
                Role::Launched(launched) => launched.chain.reflect(meeting.facet, odds.mirror),
                Role::Looking(lookout) => lookout.chain.reflect(meeting.facet, odds.mirror),
            }
        } else if lobe < odds.diffuse + odds.mirror + odds.through {
            vertex.event = Event::Through;
            vertex.probability = odds.through;
            vertex.matrix = through;
            self.origin = hit.position - off;
            match &mut self.role {
                Role::Aimed(_) => {}
                Role::Launched(launched) => launched.chain.pass(odds.through),
                Role::Looking(lookout) => lookout.chain.pass(odds.through),
            }
        }
        vertex.onward = self.direction;
        let event = vertex.event;
        path.vertices.push(vertex);
        Some(event)
    }

    /// What is known beforehand of the light at a point where a walk that corrects a guess meets a surface.
    fn guess(&self, hit: &Hit, normal: DVec3) -> Option<Guess> {
        let radiosity = self.medium.radiosity?;
        matches!(self.role, Role::Looking(_)).then(|| {
            let [_, chance, ..] = self.uniforms.at(self.depth, Purpose::Bridge);
            radiosity.at(hit.triangle, hit.position, normal, chance)
        })
    }

    /// What a scattering vertex sees, or what competes with joining it to a sensor.
    fn join(&self, path: &mut Path<'a>, vertex: &mut Vertex, meeting: &Meeting) {
        let viewer = Viewer {
            point: vertex.position,
            normal: vertex.normal,
            sensor: false,
        };
        match &self.role {
            Role::Launched(launched) if self.techniques.gather => {
                let cos = meeting.angle.0;
                vertex.rival = launched.rival(&self.medium, self.techniques, viewer, cos);
            }
            Role::Launched(_) | Role::Aimed(_) => {}
            Role::Looking(lookout) => {
                let first = path.connections.len();
                let cos = meeting.angle.0;
                let coupling = |toward: DVec3| {
                    lookout.coupling(cos, self.reverse(meeting, toward), self.techniques)
                };
                let look = Look {
                    viewer,
                    choice: Choice::All,
                    known: Seen::default(),
                    diffuse: vertex.diffuse,
                };
                self.connect(path, &look, &coupling);
                vertex.connections = first..path.connections.len();
                if lookout.is_sensor()
                    && let Some(partners) = self.partners
                {
                    self.cross(path, vertex, partners);
                }
            }
        }
    }

    /// Probability with which a walk of the other kind that came from `direction` would be scattered where this one was met.
    fn reverse(&self, meeting: &Meeting, direction: DVec3) -> f64 {
        let bound = bound(meeting, direction);
        match self.role {
            Role::Launched(_) => bound,
            _ => bound * self.techniques.launched(meeting.cover),
        }
    }

    /// Weight of meeting an emitter by chance against the other techniques (balance heuristic; Veach & Guibas 1995).
    fn emission_share(&self, hit: &Hit, meeting: &Meeting) -> f64 {
        let (Some(emission), true) = (&meeting.material.emission, meeting.front) else {
            return 0.0;
        };
        match &self.role {
            Role::Launched(_) => 0.0,
            // At first it is the mirror itself that is met, whose own light is not looked for.
            Role::Aimed(aimed) => aimed.share,
            Role::Looking(lookout) => lookout.emission_share(
                &self.medium,
                self.techniques,
                hit,
                meeting.angle.0,
                emission.exitance,
            ),
        }
    }
}

/// Probability with which a walk that came from `direction` would be scattered where this one was met.
fn bound(meeting: &Meeting, direction: DVec3) -> f64 {
    if meeting.cover.polarises_scattering() {
        let (cos, sin2) = malus_optics::angle_of_incidence(direction, meeting.normal);
        meeting.cover.diffuse(cos, sin2)
    } else {
        meeting.cover.diffuse(meeting.angle.0, meeting.angle.1)
    }
}
