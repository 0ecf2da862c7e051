//! Images of sources without geometry, in chains of mirrors so short that there are few of them.

use super::view::View;
use super::{Mirrors, Target, Viewer, reflectance};
use glam::DVec3;
use malus_scene::{Source, SourceKind};

/// Most mirrors in all chains together by which every sensor is to look.
const MOST: usize = 8_000;

/// Share of diffuse light that mirrors send on one after another, below which images in them are not worth a look each.
const WEAKEST: f64 = 1e-3;

/// An image of a source.
#[derive(Debug, Clone)]
pub(crate) struct ImageSource {
    /// Number of the source.
    pub source: usize,
    /// The mirrors, in the order in which a sensor sees them.
    pub chain: Vec<u32>,
}

/// All images behind at most `longest` mirrors.
#[derive(Default)]
pub(super) struct ImageSources {
    pub list: Vec<ImageSource>,
    pub longest: usize,
    /// Whether there are no others.
    pub complete: bool,
}

/// Light of a source that some mirrors have sent on.
enum Mirrored {
    /// From a point: what the mirrors leave of its beam.
    Beam(Box<View>),
    /// Parallel, along a direction, from the last of the mirrors.
    Parallel(DVec3, u32),
}

impl ImageSources {
    /// Those in chains as long as their number and what the mirrors leave of the light allow, of points moved `aside`.
    pub fn new(mirrors: &Mirrors, sources: &[Source], aside: DVec3) -> Self {
        let facets = 0..mirrors.facets.list().len() as u32;
        let strongest = mirrors.covers.iter().map(reflectance).fold(0.0, f64::max);
        let mut images = Self::default();
        let mut behind_fewer: Vec<(ImageSource, Option<Mirrored>)> = (0..sources.len())
            .map(|source| {
                let chain = Vec::new();
                (ImageSource { source, chain }, None)
            })
            .collect();
        let (mut left, mut mirrors_in_all) = (1.0, 0);
        while !behind_fewer.is_empty() {
            if left < WEAKEST {
                return images;
            }
            let mut behind_more = Vec::new();
            for (image, light) in &behind_fewer {
                let kind = &sources[image.source].kind;
                for facet in facets.clone() {
                    if let Some(light) = mirrors.send_on(kind, aside, light.as_ref(), facet) {
                        let mut image = image.clone();
                        image.chain.insert(0, facet);
                        mirrors_in_all += image.chain.len();
                        behind_more.push((image, Some(light)));
                    }
                }
                if mirrors_in_all > MOST {
                    return images;
                }
            }
            images.longest += 1;
            images
                .list
                .extend(behind_more.iter().map(|(image, _)| image.clone()));
            behind_fewer = behind_more;
            left *= strongest;
        }
        images.complete = true;
        images
    }
}

impl Mirrors {
    /// What one more mirror sends on of a source's light; `None` where nothing gets there.
    fn send_on(
        &self,
        kind: &SourceKind,
        aside: DVec3,
        light: Option<&Mirrored>,
        facet: u32,
    ) -> Option<Mirrored> {
        let plane = self.facet(facet);
        match (light, kind) {
            (None, &SourceKind::Point { position, .. }) => {
                let point = position + aside;
                let toward_plane = Viewer {
                    point,
                    normal: plane.normal * -plane.above(point).signum(),
                    sensor: false,
                };
                let view = View::new(&toward_plane).in_mirror(self, facet)?;
                Some(Mirrored::Beam(Box::new(view)))
            }
            (None, &SourceKind::Distant { direction, .. }) => {
                Some(Mirrored::Parallel(plane.mirrored(direction), facet))
            }
            (Some(Mirrored::Beam(view)), _) => {
                let again = view.facets.last() == Some(&facet);
                let view = (!again).then(|| view.in_mirror(self, facet))??;
                Some(Mirrored::Beam(Box::new(view)))
            }
            (Some(&Mirrored::Parallel(direction, last)), _) => {
                let from = self.facet(last);
                let side = from.normal.dot(direction).signum();
                let lit = last != facet
                    && plane
                        .hull
                        .iter()
                        .any(|&corner| from.above(corner) * side > 0.0);
                lit.then(|| Mirrored::Parallel(plane.mirrored(direction), facet))
            }
        }
    }

    /// Whether the way from a viewer to the target's image crosses the mirrors of its chain in turn.
    pub(crate) fn leads(&self, viewer: &Viewer, target: &Target, chain: &[u32]) -> bool {
        let (mut from, mut span) = (viewer.point, self.image(chain, target));
        if target.finite {
            span -= from;
        }
        let mut passed = 0.0;
        span.dot(viewer.normal) > 0.0
            && chain.iter().all(|&facet| {
                let plane = self.facet(facet);
                let Some(at) = plane.crossing(from, span) else {
                    return false;
                };
                let next = at > passed && (!target.finite || at < 1.0);
                passed = at;
                from = plane.image(from);
                span = plane.mirrored(span);
                next
            })
    }
}
