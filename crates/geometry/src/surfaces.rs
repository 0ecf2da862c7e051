//! What a ray meets first, and what sees what.

use crate::bvh::{Layout, Preset, Question, Targets, Tree};
use crate::clean::{self, Cleaned};
use crate::coincidence::{self, Coincidence, Coverings};
use crate::crossing::Line;
use crate::patches::Patches;
use crate::planes::Planes;
use crate::{Error, Mesh, Triangle};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// All surfaces of a scene, ready to be asked what rays meet.
///
/// Where two surfaces lie in one another the later one in file order exists; the earlier one is not met there, from
/// either side. Triangles without area and all but the last of exact duplicates are left out at the start, so indices
/// are those of [`mesh`](Self::mesh), not of the mesh given.
pub struct Surfaces {
    mesh: Mesh,
    normals: Vec<DVec3>,
    tree: Tree,
    planes: Planes,
    centre: DVec3,
    radius: f64,
    coverings: Coverings,
    coincidences: Vec<Coincidence>,
    cleaned: Vec<Cleaned>,
    patches: OnceLock<Patches>,
}

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Index of the triangle.
    pub triangle: u32,
    /// Distance from the ray's origin, in m; positive.
    pub distance: f64,
    /// Place of the hit, in m. On the triangle to within rounding, or past its edge by a quarter of
    /// [`Surfaces::offset`] at most.
    pub position: DVec3,
}

impl Surfaces {
    /// Cleans a mesh, builds the tree over it and finds coincident surfaces. An empty mesh is allowed.
    ///
    /// # Errors
    /// Where a coordinate in use is not finite, a vertex does not exist, the lists differ in length, or there are more
    /// than 2³¹ − 1 triangles.
    pub fn new(mut mesh: Mesh) -> Result<Self, Error> {
        clean::check(&mesh)?;
        let (centre, radius) = clean::bounding_sphere(&mesh);
        let slack = clean::slack(centre, radius);
        let waste = clean::waste(&mesh, slack);
        let mut hidden = BTreeMap::new();
        for &(dropped, kept) in &waste.duplicates {
            let kind = coincidence::kind(&mesh, dropped, kept);
            if kind[..2] != kind[2..] {
                *hidden.entry(kind).or_default() += mesh.triangle(dropped as usize).area();
            }
        }
        let cleaned = waste.counted(&mesh);
        waste.remove_from(&mut mesh);
        drop(waste);
        let tree = Tree::new(
            &mesh,
            centre,
            radius,
            slack,
            Layout::default(),
            Preset::default(),
        );
        let coverings = Coverings::of(&mesh, &tree, tolerance(centre, radius));
        coverings.add_to(&mesh, &mut hidden);
        let normals = (0..mesh.len()).map(|index| mesh.triangle(index).normal());
        Ok(Self {
            normals: normals.collect(),
            planes: Planes::of(&mesh, slack),
            mesh,
            tree,
            centre,
            radius,
            coverings,
            coincidences: coincidence::list(hidden),
            cleaned,
            patches: OnceLock::new(),
        })
    }

    /// All surfaces parted into flat patches: found when it is first asked for, and kept.
    pub fn patches(&self) -> &Patches {
        self.patches.get_or_init(|| Patches::new(self, |_| true))
    }

    /// Another tree of boxes over the same surfaces.
    #[must_use]
    pub fn tree(&self, layout: Layout, preset: Preset) -> Tree {
        let slack = clean::slack(self.centre, self.radius);
        Tree::new(&self.mesh, self.centre, self.radius, slack, layout, preset)
    }

    /// Puts one of [`tree`](Self::tree) in the place of the present one, which is returned: the answers stay the same to
    /// the last bit, their speed does not.
    pub fn exchange(&mut self, tree: Tree) -> Tree {
        std::mem::replace(&mut self.tree, tree)
    }

    /// The same answers from another vector unit.
    #[cfg(test)]
    pub(crate) fn exchange_unit(&mut self, unit: crate::bvh::Unit) {
        self.tree.exchange_unit(unit);
    }

    /// See [`Planes::sides`].
    #[cfg(test)]
    pub(crate) fn planes_sides(&self, point: DVec3) -> Option<u32> {
        self.planes.sides(point)
    }

    /// Puts other planes in the place of those known.
    #[cfg(test)]
    pub(crate) fn exchange_planes(&mut self, planes: Planes) -> Planes {
        std::mem::replace(&mut self.planes, planes)
    }

    /// The first surface that a ray meets, at a distance above 0; of several at one distance the latest.
    ///
    /// `origin` in m, `direction` a unit vector. Closed meshes have no cracks: a line through an edge or a vertex meets
    /// one of the triangles there, also where one long edge lies against several short ones.
    #[must_use]
    pub fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let met = self
            .tree
            .nearest(origin, direction, |triangle, line, distance| {
                self.exists(triangle, line, distance)
            })?;
        Some(Hit {
            triangle: met.triangle,
            distance: met.distance,
            position: met.position,
        })
    }

    /// Θ(r, r′): whether no surface crosses the open segment between two points (in m).
    ///
    /// Exactly symmetric. Callers move ends that lie on a surface off it by [`offset`](Self::offset).
    #[must_use]
    pub fn visible(&self, from: DVec3, to: DVec3) -> bool {
        // Points on one side of every plane have nothing between them: all of an empty convex room.
        let sides = self.planes.sides(from);
        if sides.is_some() && sides == self.planes.sides(to) {
            return true;
        }
        !self.tree.between(
            from,
            to,
            |triangle| self.whole(triangle),
            |triangle, line, distance| self.exists(triangle, line, distance),
        )
    }

    /// Whether points have cells at all.
    #[must_use]
    pub fn has_cells(&self) -> bool {
        self.planes.are_known()
    }

    /// In which cell of the planes that all surfaces lie in a point (in m) is: points of one cell see each other, all of an
    /// empty convex room for one. `None` on a plane, and where there are too many of them.
    #[must_use]
    #[inline]
    pub fn cell(&self, point: DVec3) -> Option<u32> {
        self.planes.sides(point)
    }

    /// Unit normals of the planes that all surfaces lie in, towards a point (in m) from which all of them are seen whole, as
    /// they are from all points of its cell; `None` where it is no such point.
    pub(crate) fn walls(&self, inside: DVec3) -> Option<Vec<DVec3>> {
        self.planes.walls(&self.mesh, inside)
    }

    /// In which of these planes a triangle lies.
    pub(crate) fn wall_of(&self, triangle: u32) -> Option<usize> {
        self.planes.of_triangle(&self.triangle(triangle))
    }

    /// The later triangles that cover part of this one, the latest first.
    pub(crate) fn over(&self, triangle: u32) -> impl Iterator<Item = u32> {
        self.coverings.over(triangle)
    }

    /// Points (in m) with normals, made ready for [`visible_from`](Self::visible_from); one whose normal is zero is seen
    /// from nowhere.
    ///
    /// # Panics
    /// If there are more than 2³² of them.
    #[must_use]
    pub fn targets(&self, points: &[(DVec3, DVec3)]) -> Targets {
        Targets::new(points, |point| self.planes.sides(point))
    }

    /// Which targets of these surfaces a point sees: `seen` gets one entry a target, true where it and the point lie in
    /// front of each other's surfaces and [`visible`](Self::visible) holds.
    ///
    /// `from` in m, `normal` of any length. Faster than asking one by one, the more so the closer together targets are.
    pub fn visible_from(
        &self,
        from: DVec3,
        normal: DVec3,
        targets: &Targets,
        seen: &mut Vec<bool>,
    ) {
        seen.clear();
        seen.resize(targets.len(), false);
        let question = Question {
            from,
            normal,
            sides: self.planes.sides(from),
            targets,
        };
        self.tree.seen(
            &question,
            seen,
            |triangle| self.whole(triangle),
            |triangle, line, distance| self.exists(triangle, line, distance),
        );
    }

    /// Whether a ray meets no surface up to infinity. `from` in m, `direction` a unit vector.
    #[must_use]
    pub fn escapes(&self, from: DVec3, direction: DVec3) -> bool {
        !self.tree.ahead(
            from,
            direction,
            |triangle| self.whole(triangle),
            |triangle, line, distance| self.exists(triangle, line, distance),
        )
    }

    /// Whether no later triangle covers any of this one.
    #[inline]
    fn whole(&self, triangle: u32) -> bool {
        !self.coverings.any(triangle)
    }

    /// Whether a triangle is there for a line that crosses it at a distance: not where the line crosses one that covers
    /// it too.
    ///
    /// The same line asks both, so none slips through between the edge of one and the rim of the other.
    #[inline]
    fn exists(&self, triangle: u32, line: &Line, distance: f64) -> bool {
        self.whole(triangle)
            || !self
                .coverings
                .over_point(triangle, line.origin + distance * line.direction)
                .any(|covering| line.crossing(&self.triangle(covering).vertices).is_some())
    }

    /// The triangles that lie within [`tolerance`](Self::tolerance) of a point (in m) and exist there.
    #[must_use]
    pub fn touching(&self, point: DVec3) -> Vec<u32> {
        let tolerance = self.tolerance();
        let mut touched = Vec::new();
        self.tree.near(&[point], tolerance, |index| {
            let normal = self.normal(index);
            let [a, b, c] = self.triangle(index).vertices;
            let inside = |from: DVec3, to: DVec3| {
                normal.cross(to - from).dot(point - from) >= -tolerance * from.distance(to)
            };
            if (point - a).dot(normal).abs() <= tolerance
                && inside(a, b)
                && inside(b, c)
                && inside(c, a)
                && self.exposed(index, point)
            {
                touched.push(index);
            }
        });
        touched.sort_unstable();
        touched
    }

    /// For each triangle the number of its plane among theirs: parallel ones count as one.
    #[must_use]
    pub fn planes_of(&self, triangles: &[u32]) -> Vec<usize> {
        const PARALLEL: f64 = 1e-12;
        let mut normals: Vec<DVec3> = Vec::new();
        let place = |&triangle: &u32| {
            let normal = self.normal(triangle);
            let same = |other: &DVec3| other.cross(normal).length_squared() < PARALLEL;
            normals.iter().position(same).unwrap_or_else(|| {
                normals.push(normal);
                normals.len() - 1
            })
        };
        triangles.iter().map(place).collect()
    }

    /// A point moved off the planes of some triangles, to a side of each, given by its unit normal, and at least so far (in m).
    ///
    /// Where planes meet, moving off one may come nearer to another: in an edge of 10° it takes some 300 rounds.
    #[must_use]
    pub fn moved_off(&self, point: DVec3, sides: &[(u32, DVec3, f64)]) -> DVec3 {
        const MOST_ROUNDS: usize = 1000;
        let mut free = point;
        for _ in 0..MOST_ROUNDS {
            let before = free;
            for &(triangle, side, distance) in sides {
                let height = (free - self.triangle(triangle).vertices[0]).dot(side);
                free += side * (distance - height).max(0.0);
            }
            if free == before {
                break;
            }
        }
        free
    }

    /// Distance in m by which a ray's end is moved off its surface along the normal: 2⁻⁴⁰ (|centre| + radius).
    ///
    /// Four times the thickness that surfaces have for rays, and some 10³ times the rounding error of a hit: it leaves no
    /// self-hit in closed spheres and boxes of side 10⁻³ to 10⁴ m, at the origin or 10⁴ m from it.
    #[must_use]
    pub fn offset(&self) -> f64 {
        4.0 * self.slack()
    }

    /// How thick surfaces are for rays, in m.
    pub(crate) fn slack(&self) -> f64 {
        clean::slack(self.centre, self.radius)
    }

    /// The tree of boxes in use.
    pub(crate) fn boxes(&self) -> &Tree {
        &self.tree
    }

    /// Distance in m within which things lie in one place: 8 ε (|centre| + radius), ε that of single precision, in which
    /// most mesh files hold their coordinates.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        tolerance(self.centre, self.radius)
    }

    /// The triangles as they are used: cleaned, in file order.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// What was left out of the mesh given, one entry an object that lost something.
    #[must_use]
    pub fn cleaned(&self) -> &[Cleaned] {
        &self.cleaned
    }

    /// Which surfaces hide which, and over what area; exact duplicates included unless object and surface are the same.
    #[must_use]
    pub fn coincidences(&self) -> &[Coincidence] {
        &self.coincidences
    }

    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.mesh.len()
    }

    /// Whether there is no surface at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.mesh.is_empty()
    }

    /// A triangle; as in all that follows, its index must be below [`len`](Self::len).
    #[must_use]
    pub fn triangle(&self, triangle: u32) -> Triangle {
        self.mesh.triangle(triangle as usize)
    }

    /// Unit normal of a triangle by the order of its vertices.
    #[must_use]
    pub fn normal(&self, triangle: u32) -> DVec3 {
        self.normals[triangle as usize]
    }

    /// Surface (material) index of a triangle.
    #[must_use]
    pub fn surface(&self, triangle: u32) -> u32 {
        self.mesh.surfaces[triangle as usize]
    }

    /// Object index of a triangle.
    #[must_use]
    pub fn object(&self, triangle: u32) -> u32 {
        self.mesh.objects[triangle as usize]
    }

    /// Centre of the bounding sphere, in m.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Radius of the bounding sphere, in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether a point (in m) of a triangle is there: false where a later triangle covers it.
    #[must_use]
    pub fn exposed(&self, triangle: u32, point: DVec3) -> bool {
        !self
            .coverings
            .over_point(triangle, point)
            .any(|covering| self.triangle(covering).covers(point))
    }

    /// Area of a triangle that no later one covers, in m².
    #[must_use]
    pub fn exposed_area(&self, triangle: u32) -> f64 {
        self.coverings.exposed_area(&self.mesh, triangle)
    }
}

/// See [`Surfaces::tolerance`].
pub(crate) fn tolerance(centre: DVec3, radius: f64) -> f64 {
    8.0 * f64::from(f32::EPSILON) * (centre.length() + radius)
}

#[cfg(test)]
mod tests;
