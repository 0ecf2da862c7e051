//! Whether a tree's answers are right: those of trying every triangle, and no ray through an edge.

use super::rays::Rays;
use malus_geometry::{Hit, Surfaces};

/// Triangles tried in all to know the right answers: seconds, even of a large mesh.
const TRIED: usize = 1 << 27;

/// Most rays of a kind that are checked.
const MOST: usize = 512;

/// Rays aimed at edges and vertices.
const AIMED: usize = 1 << 13;

/// Answers to a sample of the rays.
#[derive(PartialEq)]
pub struct Answers {
    hits: Vec<Option<Hit>>,
    visible: Vec<bool>,
    seen: Vec<bool>,
}

impl Answers {
    /// What the present tree says.
    pub fn of(surfaces: &Surfaces, rays: &Rays) -> Self {
        let count = (TRIED / surfaces.len().max(1) / 4).clamp(8, MOST);
        let every = |len: usize| (len / count).max(1);
        let nearest = [&rays.primary, &rays.cosine].into_iter().flat_map(|rays| {
            let sample = rays.iter().step_by(every(rays.len()));
            sample.map(|&(from, direction)| surfaces.nearest(from, direction))
        });
        let pairs = rays.pairs.iter().step_by(every(rays.pairs.len()));
        let vertices = (count / rays.sensors.len()).max(1);
        let targets = surfaces.targets(&rays.sensors);
        let mut seen = Vec::new();
        let mut all = Vec::new();
        for &(from, normal) in rays.vertices.iter().take(vertices) {
            surfaces.visible_from(from, normal, &targets, &mut seen);
            all.append(&mut seen);
        }
        Self {
            hits: nearest.collect(),
            visible: pairs
                .map(|&[from, to]| surfaces.visible(from, to))
                .collect(),
            seen: all,
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.hits.len() + self.visible.len() + self.seen.len()
    }

    /// How many differ, to the last bit, from others about the same rays.
    pub fn differing(&self, other: &Self) -> usize {
        fn count<T: PartialEq>(one: &[T], other: &[T]) -> usize {
            one.iter().zip(other).filter(|(a, b)| a != b).count()
        }
        count(&self.hits, &other.hits)
            + count(&self.visible, &other.visible)
            + count(&self.seen, &other.seen)
    }
}

/// Rays aimed at points of edges, every other one at a vertex, and how many of them pass through.
pub fn leaks(surfaces: &Surfaces, rays: &Rays) -> (usize, usize) {
    let count = surfaces.len();
    let leaked = (0..AIMED).filter(|&index| {
        // Triangles and places in turn, by steps that have no divisor in common with their numbers.
        let (from, _) = rays.cosine[index * 4099 % rays.cosine.len()];
        let triangle = u32::try_from(index * 7919 % count).expect("an index of a triangle");
        let vertices = surfaces.triangle(triangle).vertices;
        let [a, b] = [vertices[index % 3], vertices[(index + 1) % 3]];
        let share = [0.0, 0.5, 0.236_067_977_5][index % 3];
        let aim = if index % 2 == 0 {
            a
        } else {
            a + share * (b - a)
        };
        let distance = aim.distance(from);
        if distance <= surfaces.tolerance() {
            return false;
        }
        let stopped = surfaces
            .nearest(from, (aim - from) / distance)
            .is_some_and(|hit| hit.distance <= distance + surfaces.tolerance());
        !stopped
    });
    (AIMED, leaked.count())
}
