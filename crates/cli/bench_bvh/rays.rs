//! The rays that rates are measured with: the same for the same geometry, on every machine.

use glam::DVec3;
use malus_geometry::Surfaces;
use std::f64::consts::TAU;

/// Rays of each kind.
pub const COUNT: usize = 1 << 15;

/// Sensors along one side of the grid where the file names none.
const SIDE: usize = 16;

/// Pixels of the view along one side.
const VIEW: u32 = 181;

/// A place and a unit vector: of a ray its direction, of a vertex or a sensor its normal.
pub type Directed = (DVec3, DVec3);

/// Rays through one geometry.
pub struct Rays {
    /// From the middle through a picture, line by line: origin and direction.
    pub primary: Vec<Directed>,
    /// From where walks of light meet surfaces, as a matt surface sends them on: origin and direction.
    pub cosine: Vec<Directed>,
    /// Between two such places.
    pub pairs: Vec<[DVec3; 2]>,
    /// Such places, each of which asks for every sensor.
    pub vertices: Vec<Directed>,
    /// The sensors.
    pub sensors: Vec<Directed>,
}

impl Rays {
    /// Rays through some surfaces; `sensors` are those of the scene. `None` where no ray meets anything.
    pub fn new(surfaces: &Surfaces, sensors: Vec<Directed>) -> Option<Self> {
        let places = places(surfaces)?;
        let place = |share: f64| places[((share * COUNT as f64) as usize).min(COUNT - 1)];
        let spread = |index: usize| uniform(index, 3);
        let pairs = (0..COUNT).map(|index| {
            let [from, to, _] = spread(index);
            [place(from).0, place(to).0]
        });
        let cosine = (0..COUNT).map(|index| {
            let (at, normal) = places[index];
            (at, matt(normal, spread(index)))
        });
        let sensors = if sensors.is_empty() {
            plane(surfaces)
        } else {
            sensors
        };
        // Enough for the usual number of pairs with any number of sensors.
        let asking = (COUNT / sensors.len()).clamp(16, COUNT);
        let vertices = (0..asking).map(|index| places[index * (COUNT / asking)]);
        Some(Self {
            primary: view(surfaces),
            cosine: cosine.collect(),
            pairs: pairs.collect(),
            vertices: vertices.collect(),
            sensors,
        })
    }

    /// The pairs of a vertex and a sensor in front of each other.
    pub fn asked(&self) -> Vec<[DVec3; 2]> {
        let faces = |(from, normal): Directed, (to, facing): Directed| {
            let segment = to - from;
            segment.dot(normal) > 0.0 && segment.dot(facing) < 0.0
        };
        self.vertices
            .iter()
            .flat_map(|&vertex| {
                let sensors = self.sensors.iter();
                sensors
                    .filter(move |&&sensor| faces(vertex, sensor))
                    .map(move |&sensor| [vertex.0, sensor.0])
            })
            .collect()
    }
}

/// Numbers from 0 to 1 that fill the unit cube evenly (Roberts' additive recurrence in three dimensions), another
/// sequence for each `stream`.
fn uniform(index: usize, stream: usize) -> [f64; 3] {
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_970_1,
    ];
    let count = (index + COUNT * stream) as f64;
    STEPS.map(|step| (0.5 + step * count).fract())
}

/// A direction, even over the sphere.
fn direction([u, v, _]: [f64; 3]) -> DVec3 {
    let z = 1.0 - 2.0 * u;
    let across = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(across * libm::cos(TAU * v), across * libm::sin(TAU * v), z)
}

/// A direction as a matt surface reflects.
fn matt(normal: DVec3, uniform: [f64; 3]) -> DVec3 {
    (normal + direction(uniform)).normalize_or(normal)
}

/// Where walks of light from the middle meet surfaces, moved off them, with the normals on the side met.
fn places(surfaces: &Surfaces) -> Option<Vec<Directed>> {
    let (centre, radius) = (surfaces.centre(), surfaces.radius());
    let mut places = Vec::with_capacity(COUNT);
    let mut walk: Option<Directed> = None;
    for index in 0..8 * COUNT {
        let [x, y, z] = uniform(index, 1);
        let (from, along) = match walk {
            Some((from, normal)) => (from, matt(normal, [x, y, z])),
            None => {
                let aside = DVec3::new(x, y, z) - 0.5;
                (centre + 0.2 * radius * aside, direction(uniform(index, 2)))
            }
        };
        walk = surfaces.nearest(from, along).map(|hit| {
            let normal = surfaces.normal(hit.triangle);
            let normal = if normal.dot(along) > 0.0 {
                -normal
            } else {
                normal
            };
            (hit.position + surfaces.offset() * normal, normal)
        });
        places.extend(walk);
        if places.len() == COUNT {
            return Some(places);
        }
    }
    // An open geometry that most rays leave.
    if places.is_empty() {
        return None;
    }
    Some(places.iter().copied().cycle().take(COUNT).collect())
}

/// A horizontal grid through the lower part of the box around everything, facing up.
fn plane(surfaces: &Surfaces) -> Vec<Directed> {
    let positions = surfaces.mesh().positions.iter();
    let (least, most) = positions.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(least, most), &position| (least.min(position), most.max(position)),
    );
    let at = |index: usize| 0.1 + 0.8 * (index as f64 + 0.5) / SIDE as f64;
    (0..SIDE * SIDE)
        .map(|index| {
            let share = DVec3::new(at(index % SIDE), at(index / SIDE), 0.3);
            (least + share * (most - least), DVec3::Z)
        })
        .collect()
}

/// A picture of 90° from the middle along the longest side.
fn view(surfaces: &Surfaces) -> Vec<Directed> {
    let at = surfaces.centre();
    let positions = &surfaces.mesh().positions;
    let size = positions.iter().fold(DVec3::ZERO, |size, &position| {
        size.max((position - at).abs())
    });
    let (forward, right) = if size.x > size.y {
        (DVec3::X, DVec3::NEG_Y)
    } else {
        (DVec3::Y, DVec3::X)
    };
    let pixel = |index: u32| 2.0 * (f64::from(index) + 0.5) / f64::from(VIEW) - 1.0;
    (0..VIEW * VIEW)
        .map(|index| {
            let (across, down) = (pixel(index % VIEW), pixel(index / VIEW));
            (at, (forward + across * right - down * DVec3::Z).normalize())
        })
        .collect()
}
