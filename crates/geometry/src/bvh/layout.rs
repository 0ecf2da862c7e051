//! The layouts of a tree: the engine's own, those of `obvhs`, and none.

use super::frame::Frame;
use super::lanes::{Lanes, Unit, Work};
use super::wide::Wide;
use crate::Mesh;
use crate::crossing::Line;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::cwbvh::{CwBvh, bvh2_to_cwbvh::bvh2_to_cwbvh};
use obvhs::ploc::PlocBuilder;
use obvhs::ray::{Ray, RayHit};
use obvhs::{Boundable, BvhBuildParams};

/// How a tree is laid out in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Layout {
    /// Eight children a node and up to eight triangles a leaf, tested at once: what is used unless asked otherwise.
    #[default]
    Wide,
    /// Two children a node, as `obvhs` lays it out.
    Bvh2,
    /// Eight children a node with boxes of eight bits a side, as `obvhs` lays it out.
    Cwbvh,
    /// No tree: every triangle is tried.
    List,
}

/// How much care is taken in building a tree: the presets of `obvhs`, but triangles are never split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// Half the speed, to save some of the build.
    Fastest,
    /// In between.
    VeryFast,
    /// In between.
    Fast,
    /// What is used unless asked otherwise: the faster ones cost speed, the slower ones gain little.
    #[default]
    Medium,
    /// In between.
    Slow,
    /// Ten times the build time of `Medium`.
    VerySlow,
}

impl Preset {
    fn parameters(self) -> BvhBuildParams {
        match self {
            Self::Fastest => BvhBuildParams::fastest_build(),
            Self::VeryFast => BvhBuildParams::very_fast_build(),
            Self::Fast => BvhBuildParams::fast_build(),
            Self::Medium => BvhBuildParams::medium_build(),
            Self::Slow => BvhBuildParams::slow_build(),
            Self::VerySlow => BvhBuildParams::very_slow_build(),
        }
    }
}

/// The boxes of a tree.
pub(super) enum Boxes {
    Wide(Wide, Unit),
    Bvh2(Bvh2),
    Cwbvh(CwBvh),
    List(usize),
}

/// A search for what a ray crosses.
pub(super) trait Visit {
    /// Tries the triangle at a place among the tree's leaves, of a ray of interest up to a distance in the frame's units;
    /// returns the same or a lesser one. Where the ray `surely` crosses it by then, that need not be asked again.
    fn visit(&mut self, place: usize, reach: f32, surely: bool) -> f32;
}

/// Least reach of a ray through `obvhs`'s eight-wide tree, in the frame's units: that asks no box before a distance of
/// 1e-4, so within a shorter reach it would find nothing.
const SHORTEST: f32 = 2e-4;

/// What [`Visit::visit`] returns to end the search.
pub(super) const ENOUGH: f32 = -1.0;

impl Boxes {
    /// A tree, and the triangles in the order of its leaves.
    pub fn new(mesh: &Mesh, frame: Frame, layout: Layout, preset: Preset) -> (Self, Vec<u32>) {
        let parameters = preset.parameters();
        match layout {
            Layout::Wide => {
                let binary = binary(mesh, frame, &parameters);
                let wide = Wide::new(&binary, mesh, &frame);
                (Self::Wide(wide, Unit::detect()), binary.primitive_indices)
            }
            Layout::Bvh2 => {
                let mut tree = binary(mesh, frame, &parameters);
                let triangles = std::mem::take(&mut tree.primitive_indices);
                (Self::Bvh2(tree), triangles)
            }
            Layout::Cwbvh => {
                let (binary, _) = paired(mesh, frame, &parameters);
                let most = parameters.max_prims_per_leaf.clamp(1, 3);
                let mut tree = bvh2_to_cwbvh(&binary, most, true, false);
                let triangles = std::mem::take(&mut tree.primitive_indices);
                (Self::Cwbvh(tree), triangles)
            }
            Layout::List => (Self::List(mesh.len()), (0..).take(mesh.len()).collect()),
        }
    }

    /// Tries the triangles that a ray may cross, roughly from the nearest on.
    #[inline]
    pub fn walk(&self, frame: &Frame, line: &Line, reach: f32, search: &mut impl Visit) {
        let ray = |reach| Ray {
            tmax: reach,
            ..frame.ray(line)
        };
        let mut hit = RayHit::none();
        match self {
            Self::Wide(wide, unit) => unit.run(Walk {
                wide,
                frame,
                line,
                reach,
                search,
            }),
            Self::Bvh2(tree) => {
                tree.ray_traverse(ray(reach), &mut hit, |ray, place| {
                    search.visit(place, ray.tmax, false)
                });
            }
            Self::Cwbvh(tree) => {
                tree.ray_traverse(ray(reach.max(SHORTEST)), &mut hit, |ray, place| {
                    search.visit(place, ray.tmax, false).max(SHORTEST)
                });
            }
            Self::List(count) => {
                (0..*count).fold(reach, |reach, place| search.visit(place, reach, false));
            }
        }
    }

    /// Tries the triangles that a ray may cross in any order, until there is one.
    #[inline]
    pub fn walk_to_any(&self, frame: &Frame, line: &Line, reach: f32, search: &mut impl Visit) {
        let ray = |reach| Ray {
            tmax: reach,
            ..frame.ray(line)
        };
        match self {
            Self::Wide(wide, unit) => unit.run(Walk {
                wide,
                frame,
                line,
                reach,
                search,
            }),
            Self::Bvh2(tree) => {
                tree.ray_traverse_miss(ray(reach), |ray, place| {
                    search.visit(place, ray.tmax, false)
                });
            }
            Self::Cwbvh(tree) => {
                tree.ray_traverse_miss(ray(reach.max(SHORTEST)), |ray, place| {
                    search.visit(place, ray.tmax, false)
                });
            }
            Self::List(count) => {
                (0..*count).any(|place| search.visit(place, reach, false) <= ENOUGH);
            }
        }
    }

    /// Whether every place `passes` of a triangle in boxes, in the frame's units, that `enters` lets in.
    pub fn all(&self, enters: impl Fn(&Aabb) -> bool, passes: impl FnMut(usize) -> bool) -> bool {
        match self {
            Self::Wide(wide, _) => wide.all(enters, passes),
            // These are there to be compared with: no scene is read with them.
            Self::Bvh2(_) | Self::Cwbvh(_) => false,
            Self::List(count) => (0..*count).all(passes),
        }
    }

    /// Visits at least every place among the leaves whose triangle's box meets another box, in the frame's units.
    pub fn near(&self, around: &Aabb, visit: impl FnMut(usize)) {
        match self {
            Self::Wide(wide, _) => wide.near(around, visit),
            Self::Bvh2(tree) => {
                let mut places = Vec::new();
                tree.aabb_traverse(*around, |tree, node| {
                    let node = &tree.nodes[node as usize];
                    let first = node.first_index as usize;
                    places.extend(first..first + node.prim_count as usize);
                    true
                });
                places.into_iter().for_each(visit);
            }
            // These are there to be compared with: no scene is read with them.
            Self::Cwbvh(_) => {}
            Self::List(count) => (0..*count).for_each(visit),
        }
    }
}

struct Walk<'a, S> {
    wide: &'a Wide,
    frame: &'a Frame,
    line: &'a Line,
    reach: f32,
    search: &'a mut S,
}

impl<S: Visit> Work for Walk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with<E: Lanes<8>, T: Lanes<16>>(self, eight: E, _: T) {
        self.wide
            .walk(eight, self.frame, self.line, self.reach, self.search);
    }
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

/// A binary tree with one triangle a leaf, and what improves it.
fn paired(mesh: &Mesh, frame: Frame, preset: &BvhBuildParams) -> (Bvh2, ReinsertionOptimizer) {
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
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut bvh, preset.reinsertion_batch_ratio, None);
    (bvh, optimizer)
}

/// A binary tree with a few triangles a leaf.
fn binary(mesh: &Mesh, frame: Frame, preset: &BvhBuildParams) -> Bvh2 {
    let (mut bvh, mut optimizer) = paired(mesh, frame, preset);
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
pub(super) fn depth(bvh: &Bvh2) -> usize {
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
