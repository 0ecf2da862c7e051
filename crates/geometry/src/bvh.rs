//! Adapter to the tree of boxes of `obvhs`: which triangles may a ray cross?
//!
//! The tree is single precision and only culls. It is built in a frame moved to the scene's centre and scaled by a
//! power of two to an extent of about 10³, its boxes are rounded outwards and padded by more than the rounding
//! errors of a box test add up to, and distances handed to it are rounded up; what is crossed, and where, is decided
//! in double precision by [`Line::crossing`].

use crate::Mesh;
use crate::crossing::Line;
use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::PlocBuilder;
use obvhs::ray::{Ray, RayHit, safe_inverse};
use obvhs::{Boundable, BvhBuildParams};

/// Extent to which the scene is scaled, to within a factor of two.
const EXTENT: f64 = 1024.0;

/// A frame around the scene in which single precision is enough for culling.
#[derive(Debug, Clone, Copy)]
struct Frame {
    centre: DVec3,
    /// A power of two.
    scale: f64,
    /// By how much boxes grow, in the frame's units.
    pad: f64,
}

impl Frame {
    /// A box test errs by at most 4.5 ε·radius: ½ from rounding the origin, 1 from the difference to the box's side,
    /// 3 from the direction, its inverse and the product. The padding is 4 ε·extent = 8 ε·radius.
    fn new(centre: DVec3, radius: f64, slack: f64) -> Self {
        let mut scale = 1.0;
        while 2.0 * radius * scale > EXTENT {
            scale *= 0.5;
        }
        while radius > 0.0 && 2.0 * radius * scale <= 0.5 * EXTENT {
            scale *= 2.0;
        }
        let extent = 2.0 * radius * scale;
        Self {
            centre,
            scale,
            pad: 4.0 * f64::from(f32::EPSILON) * extent + slack * scale,
        }
    }

    fn boxed(&self, corners: &[DVec3]) -> Aabb {
        let least = corners
            .iter()
            .fold(DVec3::INFINITY, |least, &corner| least.min(corner));
        let most = corners
            .iter()
            .fold(DVec3::NEG_INFINITY, |most, &corner| most.max(corner));
        let least = (least - self.centre) * self.scale - self.pad;
        let most = (most - self.centre) * self.scale + self.pad;
        Aabb::new(
            Vec3A::from_array(least.to_array().map(rounded_down)),
            Vec3A::from_array(most.to_array().map(rounded_up)),
        )
    }

    fn ray(&self, line: &Line, length: f64) -> Ray {
        let origin = ((line.origin - self.centre) * self.scale).as_vec3a();
        // A negative zero would turn its inverse to the wrong side of a box.
        let direction = line.direction.as_vec3a() + Vec3A::ZERO;
        Ray {
            origin,
            direction,
            inv_direction: Vec3A::from_array(direction.to_array().map(safe_inverse)),
            tmin: 0.0,
            tmax: rounded_up(length * self.scale),
        }
    }
}

#[allow(clippy::cast_possible_truncation)]
fn rounded_up(value: f64) -> f32 {
    let single = value as f32;
    if f64::from(single) < value {
        single.next_up()
    } else {
        single
    }
}

fn rounded_down(value: f64) -> f32 {
    -rounded_up(-value)
}

/// One triangle of a mesh, for the builder to ask for its box.
struct Bounded<'a> {
    scene: &'a (&'a Mesh, Frame),
    triangle: u32,
}

impl Boundable for Bounded<'_> {
    fn aabb(&self) -> Aabb {
        let (mesh, frame) = self.scene;
        frame.boxed(&mesh.triangle(self.triangle as usize).vertices)
    }
}

/// The triangles of a scene in the order of the tree's leaves, below a tree of boxes.
pub(crate) struct Tree {
    bvh: Bvh2,
    corners: Vec<[DVec3; 3]>,
    frame: Frame,
    radius: f64,
    slack: f64,
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Met {
    pub triangle: u32,
    pub distance: f64,
    pub position: DVec3,
}

impl Tree {
    /// A tree over all triangles of a mesh with finite vertices within `radius` of `centre`.
    pub fn new(mesh: &Mesh, centre: DVec3, radius: f64, slack: f64) -> Self {
        let frame = Frame::new(centre, radius, slack);
        let bvh = built(mesh, frame);
        let corners = bvh
            .primitive_indices
            .iter()
            .map(|&triangle| mesh.triangle(triangle as usize).vertices)
            .collect();
        Self {
            bvh,
            corners,
            frame,
            radius,
            slack,
        }
    }

    /// A line from a point, moved on to the scene's bounding sphere if it starts far outside, with the distance moved;
    /// `None` where it passes the sphere.
    ///
    /// So the origin's rounding to single precision stays below the padding, and the crossing's relative to the
    /// scene rather than to the distance.
    fn line(&self, origin: DVec3, direction: DVec3) -> Option<(Line, f64)> {
        let sphere = self.radius * (1.0 + 1e-3);
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

    /// The first triangle in front of the origin that `exists`; of several at the same distance the latest.
    pub fn nearest(
        &self,
        origin: DVec3,
        direction: DVec3,
        exists: impl Fn(u32, &Line, f64) -> bool,
    ) -> Option<Met> {
        let (line, moved) = self.line(origin, direction)?;
        let mut first: Option<(f64, u32)> = None;
        self.bvh.ray_traverse(
            self.frame.ray(&line, f64::INFINITY),
            &mut RayHit::none(),
            |_, leaf| {
                let Some(distance) = line.crossing(&self.corners[leaf]) else {
                    return f32::INFINITY;
                };
                let triangle = self.bvh.primitive_indices[leaf];
                let nearer = first.is_none_or(|(least, latest)| {
                    distance < least || (distance <= least && triangle > latest)
                });
                if distance > 0.0 && nearer && exists(triangle, &line, distance) {
                    first = Some((distance, triangle));
                    rounded_up(distance * self.frame.scale)
                } else {
                    f32::INFINITY
                }
            },
        );
        first.map(|(distance, triangle)| Met {
            triangle,
            distance: moved + distance,
            position: line.origin + distance * direction,
        })
    }

    /// Whether any triangle that `exists` crosses the ray after the origin and before `length`.
    pub fn blocked(
        &self,
        origin: DVec3,
        direction: DVec3,
        length: f64,
        exists: impl Fn(u32, &Line, f64) -> bool,
    ) -> bool {
        let Some((line, moved)) = self.line(origin, direction) else {
            return false;
        };
        let length = length - moved;
        if length <= 0.0 {
            return false;
        }
        let missed = self
            .bvh
            .ray_traverse_miss(self.frame.ray(&line, length), |_, leaf| {
                // Any return below the ray's end stops the search.
                match line.crossing(&self.corners[leaf]) {
                    Some(distance)
                        if distance > 0.0
                            && distance < length
                            && exists(self.bvh.primitive_indices[leaf], &line, distance) =>
                    {
                        0.0
                    }
                    _ => f32::INFINITY,
                }
            });
        !missed
    }

    /// Visits every triangle whose box comes within `margin` (in m) of the box around `corners`.
    pub fn near(&self, corners: &[DVec3], margin: f64, mut visit: impl FnMut(u32)) {
        let around = self.frame.boxed(corners);
        let margin = Vec3A::splat(rounded_up(margin * self.frame.scale));
        let around = Aabb::new(around.min - margin, around.max + margin);
        self.bvh.aabb_traverse(around, |bvh, node| {
            let node = &bvh.nodes[node as usize];
            let leaves = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            for &triangle in &bvh.primitive_indices[leaves] {
                visit(triangle);
            }
            true
        });
    }
}

impl Tree {
    /// Whether every triangle `passes` that lies in boxes which `enters`, given two corners of a box in m, lets in.
    pub fn all(&self, enters: impl Fn(DVec3, DVec3) -> bool, passes: impl Fn(u32) -> bool) -> bool {
        let Frame { centre, scale, .. } = self.frame;
        let world = |corner: Vec3A| corner.as_dvec3() / scale + centre;
        let mut open = vec![0];
        while let Some(index) = open.pop() {
            let Some(node) = self.bvh.nodes.get(index) else {
                continue;
            };
            let bounds = node.aabb();
            if !enters(world(bounds.min), world(bounds.max)) {
                continue;
            }
            let first = node.first_index as usize;
            if node.is_leaf() {
                let leaves = first..first + node.prim_count as usize;
                if !self.bvh.primitive_indices[leaves]
                    .iter()
                    .all(|&t| passes(t))
                {
                    return false;
                }
            } else {
                open.extend([first, first + 1]);
            }
        }
        true
    }
}

/// The preset `medium`: better traversal than the fast ones, and the slow ones gain little more.
fn built(mesh: &Mesh, frame: Frame) -> Bvh2 {
    let preset = BvhBuildParams::medium_build();
    let scene = (mesh, frame);
    let indices: Vec<u32> = (0..).take(mesh.len()).collect();
    let boxes: Vec<Bounded> = indices
        .iter()
        .map(|&triangle| Bounded {
            scene: &scene,
            triangle,
        })
        .collect();
    let mut bvh = PlocBuilder::new().build(
        preset.ploc_search_distance,
        &boxes,
        indices,
        preset.sort_precision,
        preset.search_depth_threshold,
    );
    drop(boxes);
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut bvh, preset.reinsertion_batch_ratio, None);
    collapse(
        &mut bvh,
        preset.max_prims_per_leaf,
        preset.collapse_traversal_cost,
    );
    let ratio =
        preset.reinsertion_batch_ratio * preset.post_collapse_reinsertion_batch_ratio_multiplier;
    optimizer.run(&mut bvh, ratio, None);
    bvh.parents = Vec::new();
    bvh.nodes.shrink_to_fit();
    // The traversal's stack has this fixed size, and reinsertion may have deepened the tree.
    bvh.max_depth = bvh.max_depth.max(depth(&bvh));
    bvh
}

/// Number of levels of a tree.
fn depth(bvh: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0, 1)];
    while let Some((index, level)) = open.pop() {
        let Some(node) = bvh.nodes.get(index) else {
            continue;
        };
        deepest = deepest.max(level);
        if !node.is_leaf() {
            let first = node.first_index as usize;
            open.extend([(first, level + 1), (first + 1, level + 1)]);
        }
    }
    deepest
}
