//! Adapter to the trees of boxes of `obvhs`: which triangles may a ray cross?
//!
//! A tree is single precision and only culls. It is built in a frame moved to the scene's centre and scaled by a
//! power of two to an extent of about 10³, its boxes are rounded outwards and padded by more than the rounding
//! errors of a box test add up to, and distances handed to it are rounded up; what is crossed, and where, is decided
//! in double precision by [`Line::crossing`]. So every tree gives the same answers to the last bit.

mod facts;
mod frame;
mod lanes;
mod layout;
mod packet;
mod rays;
mod targets;
mod wide;

use crate::Mesh;
use crate::crossing::{Beside, Line};
use crate::surfaces::tolerance;
use frame::{Frame, rounded_up};
use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;

pub use facts::TreeFacts;
#[cfg(test)]
pub(crate) use lanes::Unit;
use layout::{Boxes, ENOUGH, Visit};
pub use layout::{Layout, Preset};
use packet::Sight;
pub(crate) use targets::Question;
pub use targets::Targets;

/// How many tolerances thick a stack of surfaces may be, each of which lies in the next: half of it, from its middle.
const STACKED: f64 = 4.0;

/// The triangles of a scene below a tree of boxes: what finds out which of them a ray may cross.
pub struct Tree {
    layout: Layout,
    preset: Preset,
    boxes: Boxes,
    /// Triangles in the order of the tree's leaves.
    triangles: Vec<u32>,
    /// Their vertices.
    corners: Vec<[DVec3; 3]>,
    frame: Frame,
    radius: f64,
    slack: f64,
    /// Surfaces that lie in one another do so to within this, in m: an end of a segment farther off leaves all of them on
    /// one side.
    stack: f64,
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Met {
    pub triangle: u32,
    pub distance: f64,
    pub position: DVec3,
}

/// Part of a line, from its origin to a length.
struct Segment {
    line: Line,
    length: f64,
}

impl Segment {
    /// Whether the triangle at a place among the leaves crosses this, and stops it wherever it does or exists there.
    #[inline(always)]
    fn crosses(
        &self,
        tree: &Tree,
        place: usize,
        stops: impl Fn(usize) -> bool,
        exists: &impl Fn(u32, &Line, f64) -> bool,
    ) -> bool {
        match self.line.crossing(&tree.corners[place]) {
            Some(distance) if distance > 0.0 && distance < self.length => {
                stops(place) || exists(tree.triangles[place], &self.line, distance)
            }
            _ => false,
        }
    }
}

/// The search for what a ray meets first.
struct Nearest<'a, E> {
    tree: &'a Tree,
    line: &'a Line,
    exists: E,
    /// Distance and triangle.
    first: Option<(f64, u32)>,
}

impl<E: Fn(u32, &Line, f64) -> bool> Visit for Nearest<'_, E> {
    #[inline(always)]
    fn visit(&mut self, place: usize, reach: f32, _: bool) -> f32 {
        let Some(distance) = self.line.crossing(&self.tree.corners[place]) else {
            return reach;
        };
        let triangle = self.tree.triangles[place];
        let nearer = self.first.is_none_or(|(least, latest)| {
            distance < least || (distance <= least && triangle > latest)
        });
        if distance > 0.0 && nearer && (self.exists)(triangle, self.line, distance) {
            self.first = Some((distance, triangle));
            rounded_up(distance * self.tree.frame.scale)
        } else {
            reach
        }
    }
}

/// The search for anything on a segment.
struct Any<'a, S, E> {
    tree: &'a Tree,
    segment: &'a Segment,
    /// Whether the triangle at a place among the leaves, or what covers it, stops the ray wherever that crosses it.
    stops: S,
    exists: E,
    blocked: bool,
}

impl<S: Fn(usize) -> bool, E: Fn(u32, &Line, f64) -> bool> Visit for Any<'_, S, E> {
    #[inline(always)]
    fn visit(&mut self, place: usize, reach: f32, surely: bool) -> f32 {
        let Self { tree, segment, .. } = *self;
        self.blocked = surely && (self.stops)(place)
            || segment.crosses(tree, place, &self.stops, &self.exists);
        if self.blocked { ENOUGH } else { reach }
    }
}

impl Tree {
    /// A tree over all triangles of a mesh with finite vertices within `radius` of `centre`.
    pub(crate) fn new(
        mesh: &Mesh,
        centre: DVec3,
        radius: f64,
        slack: f64,
        layout: Layout,
        preset: Preset,
    ) -> Self {
        let frame = Frame::new(centre, radius, slack);
        let (boxes, triangles) = Boxes::new(mesh, frame, layout, preset);
        let vertices = |&triangle: &u32| mesh.triangle(triangle as usize).vertices;
        Self {
            layout,
            preset,
            corners: triangles.iter().map(vertices).collect(),
            boxes,
            triangles,
            frame,
            radius,
            slack,
            stack: STACKED * tolerance(centre, radius),
        }
    }

    /// The same on another vector unit.
    #[cfg(test)]
    pub(crate) fn exchange_unit(&mut self, other: Unit) {
        if let Boxes::Wide(_, unit) = &mut self.boxes {
            *unit = other;
        }
    }

    /// A line from a point, moved on to the scene's bounding sphere if it starts far outside, with the distance moved;
    /// `None` where it passes the sphere.
    ///
    /// So the origin's rounding to single precision stays below the padding, and the crossing's relative to the
    /// scene rather than to the distance.
    fn line(&self, origin: DVec3, direction: DVec3) -> Option<(Line, f64)> {
        let sphere = self.frame.sphere;
        let to_centre = self.frame.centre - origin;
        let mut line = Line::new(origin, direction, self.slack, 2.0 * self.radius);
        if to_centre.length_squared() <= sphere * sphere {
            return Some((line, 0.0));
        }
        let along = to_centre.dot(direction);
        let aside = (to_centre - along * direction).length_squared();
        if along <= 0.0 || aside > sphere * sphere {
            return None;
        }
        let moved = along - (sphere * sphere - aside).sqrt();
        line.origin += moved * direction;
        Some((line, moved))
    }

    /// The segment between two points, the same both ways; `None` where nothing can lie on it.
    fn segment(&self, from: DVec3, to: DVec3) -> Option<Segment> {
        // One order for both ways, so that rounding is the same.
        let (from, to) = if from.to_array() <= to.to_array() {
            (from, to)
        } else {
            (to, from)
        };
        let length = from.distance(to);
        if length <= 0.0 || length.is_nan() {
            return None;
        }
        self.ray(from, (to - from) / length, length)
    }

    /// A ray up to a length; `None` where nothing can lie on it.
    fn ray(&self, origin: DVec3, direction: DVec3, length: f64) -> Option<Segment> {
        let (line, moved) = self.line(origin, direction)?;
        let length = length - moved;
        (length > 0.0).then_some(Segment { line, length })
    }

    /// The first triangle in front of the origin that `exists`; of several at the same distance the latest.
    #[inline]
    pub(crate) fn nearest(
        &self,
        origin: DVec3,
        direction: DVec3,
        exists: impl Fn(u32, &Line, f64) -> bool,
    ) -> Option<Met> {
        let (line, moved) = self.line(origin, direction)?;
        let mut search = Nearest {
            tree: self,
            line: &line,
            exists,
            first: None,
        };
        self.boxes
            .walk(&self.frame, &line, f32::INFINITY, &mut search);
        search.first.map(|(distance, triangle)| Met {
            triangle,
            distance: moved + distance,
            position: line.origin + distance * direction,
        })
    }

    /// Whether any triangle that `exists` crosses the open segment between two points; one that is `whole` exists wherever it
    /// is crossed.
    #[inline]
    pub(crate) fn between(
        &self,
        from: DVec3,
        to: DVec3,
        whole: impl Fn(u32) -> bool,
        exists: impl Fn(u32, &Line, f64) -> bool,
    ) -> bool {
        let stops = |place| self.stops(place, from, to, &whole);
        self.segment(from, to)
            .is_some_and(|segment| self.blocked(&segment, stops, exists))
    }

    /// Whether any triangle that `exists` crosses the ray after the origin; one that is `whole` exists wherever it is
    /// crossed.
    #[inline]
    pub(crate) fn ahead(
        &self,
        origin: DVec3,
        direction: DVec3,
        whole: impl Fn(u32) -> bool,
        exists: impl Fn(u32, &Line, f64) -> bool,
    ) -> bool {
        let stops = |place: usize| whole(self.triangles[place]);
        self.ray(origin, direction, f64::INFINITY)
            .is_some_and(|ray| self.blocked(&ray, stops, exists))
    }

    /// Whether a segment between two points is stopped wherever it crosses a triangle: that is whole, or the points lie on
    /// different sides of it, of all that may cover it, and of what may cover that.
    #[inline]
    fn stops(&self, place: usize, from: DVec3, to: DVec3, whole: &impl Fn(u32) -> bool) -> bool {
        whole(self.triangles[place]) || {
            let beside = Beside::new(from, &self.corners[place], self.stack);
            beside.sides(&to.to_array().map(|part| [part])).1 == 1
        }
    }

    #[inline]
    fn blocked(
        &self,
        segment: &Segment,
        stops: impl Fn(usize) -> bool,
        exists: impl Fn(u32, &Line, f64) -> bool,
    ) -> bool {
        let reach = rounded_up(segment.length * self.frame.scale);
        let mut search = Any {
            tree: self,
            segment,
            stops,
            exists,
            blocked: false,
        };
        self.boxes
            .walk_to_any(&self.frame, &segment.line, reach, &mut search);
        search.blocked
    }

    /// Sets for each target whether it and a point lie in front of each other with nothing that `exists` between them.
    ///
    /// A triangle that is `whole` exists wherever it is crossed.
    pub(crate) fn seen(
        &self,
        question: &Question,
        seen: &mut [bool],
        whole: impl Fn(u32) -> bool,
        exists: impl Fn(u32, &Line, f64) -> bool,
    ) {
        let from = question.from;
        let single = |to| !self.between(from, to, &whole, &exists);
        let sphere = self.frame.sphere;
        match &self.boxes {
            Boxes::Wide(wide, unit)
                if (from - self.frame.centre).length_squared() <= sphere * sphere =>
            {
                unit.run(Sight {
                    wide,
                    frame: &self.frame,
                    question,
                    seen,
                    last: None,
                    single,
                    beside: |place: usize| Beside::new(from, &self.corners[place], self.slack),
                    beyond: |place: usize| Beside::new(from, &self.corners[place], self.stack),
                    whole: |place: usize| whole(self.triangles[place]),
                    between: |to, place: usize| {
                        self.segment(from, to).is_some_and(|segment| {
                            let stops = |place| self.stops(place, from, to, &whole);
                            segment.crosses(self, place, stops, &exists)
                        })
                    },
                });
            }
            _ => question.each_before(|target, to| seen[target] = single(to)),
        }
    }

    /// Whether every triangle `passes` that lies in boxes which `enters`, given two corners of a box in m, lets in.
    pub(crate) fn all(
        &self,
        enters: impl Fn(DVec3, DVec3) -> bool,
        mut passes: impl FnMut(u32) -> bool,
    ) -> bool {
        let Frame { centre, scale, .. } = self.frame;
        let world = |corner: Vec3A| corner.as_dvec3() / scale + centre;
        self.boxes.all(
            |bounds| enters(world(bounds.min), world(bounds.max)),
            |place| passes(self.triangles[place]),
        )
    }

    /// Visits every triangle whose box comes within `margin` (in m) of the box around `corners`, and some more.
    pub(crate) fn near(&self, corners: &[DVec3], margin: f64, mut visit: impl FnMut(u32)) {
        let around = self.frame.boxed(corners);
        let margin = Vec3A::splat(rounded_up(margin * self.frame.scale));
        let around = Aabb::new(around.min - margin, around.max + margin);
        self.boxes
            .near(&around, |place| visit(self.triangles[place]));
    }
}

#[cfg(test)]
mod tests;
