//! What is wrong with a mesh, for its maker to mend.
//!
//! Vertices within the [tolerance](crate::Surfaces::tolerance) of each other count as one throughout.

use crate::edges::{self, Pieces, Use};
use crate::holes;
use crate::solid::Solids;
use crate::surfaces::tolerance;
use crate::weld::weld;
use crate::{Cleaned, Mesh, clean};
use glam::DVec3;
use std::collections::BTreeMap;

pub use crate::holes::Hole;

/// Everything found in a mesh.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// What was found in each object, ascending; objects without findings are left out.
    pub objects: Vec<ObjectDefects>,
    /// Closed solids whose normals point inward. A room is one rightly, anything else is inside out.
    pub inside_out: Vec<InsideOut>,
    /// Objects with faces turned against the greater part of what they join, in the whole scene.
    pub turned: Vec<Turned>,
    /// Rims of surfaces where nothing else begins, in the whole scene, the largest first: a missing wall leaves one,
    /// and so does a single sheet in mid-air.
    pub holes: Vec<Hole>,
}

/// What was found in one object taken for itself.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct ObjectDefects {
    /// Index of the object.
    pub object: u32,
    /// Triangles without area.
    pub degenerate: usize,
    /// Triangles of which an exact duplicate follows, in this object or a later one.
    pub duplicates: usize,
    /// Edges of one triangle only. Not wrong in itself: a wall is a sheet.
    pub boundary: Edges,
    /// Edges where more than two triangles meet.
    pub non_manifold: Edges,
    /// Edges along which two triangles run in the same sense, so that one of them is turned.
    pub mixed_winding: Edges,
}

/// Edges with one thing in common.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Edges {
    /// How many.
    pub count: usize,
    /// Their length together, in m.
    pub length: f64,
    /// Ends of the longest, in m; both 0 where there is none.
    pub longest: [DVec3; 2],
}

/// A closed solid whose normals point inward.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct InsideOut {
    /// Index of the object.
    pub object: u32,
    /// Volume in m³, negative.
    pub volume: f64,
    /// Lower corner of its box, in m.
    pub min: DVec3,
    /// Upper corner of its box, in m.
    pub max: DVec3,
}

/// An object with faces turned against what they join.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Turned {
    /// Index of the object.
    pub object: u32,
    /// Number of turned triangles.
    pub triangles: usize,
    /// Their area in m².
    pub area: f64,
    /// Area of the whole object in m²; where it equals `area` the whole object is turned.
    pub of: f64,
    /// Centre of one of them, in m.
    pub at: DVec3,
}

impl Edges {
    fn add(&mut self, ends: [DVec3; 2]) {
        let length = ends[0].distance(ends[1]);
        if length > self.longest[0].distance(self.longest[1]) {
            self.longest = ends;
        }
        self.count += 1;
        self.length += length;
    }
}

/// Examines a mesh, before or after its cleaning; one that [`Surfaces::new`](crate::Surfaces::new) refuses has no report.
#[must_use]
pub fn of(mesh: &Mesh) -> Report {
    if clean::check(mesh).is_err() {
        return Report::default();
    }
    let (centre, radius) = clean::bounding_sphere(mesh);
    let tolerance = tolerance(centre, radius);
    let waste = clean::waste(mesh, clean::slack(centre, radius));
    let mut sound = vec![true; mesh.len()];
    for index in waste.indices() {
        sound[index as usize] = false;
    }
    let sound = |triangle: u32| sound[triangle as usize];
    let welded = weld(mesh, &mesh.triangles, tolerance);
    let solids = Solids::among(mesh, &welded, tolerance, sound);
    let inside_out = solids.iter().filter(|solid| solid.volume() < 0.0);
    let all = edges::uses(mesh, &welded, sound, |_| 0);
    let all = edges::split_at_junctions(mesh, all, tolerance);
    Report {
        objects: by_object(mesh, &welded, sound, &waste.counted(mesh)),
        inside_out: inside_out
            .map(|solid| InsideOut {
                object: solid.object(),
                volume: solid.volume(),
                min: solid.bounds().0,
                max: solid.bounds().1,
            })
            .collect(),
        turned: turned(mesh, &all),
        holes: holes::of(mesh, &all),
    }
}

fn by_object(
    mesh: &Mesh,
    welded: &[u32],
    sound: impl Fn(u32) -> bool,
    cleaned: &[Cleaned],
) -> Vec<ObjectDefects> {
    let mut objects: BTreeMap<u32, ObjectDefects> = BTreeMap::new();
    for counts in cleaned {
        let entry = objects.entry(counts.object).or_default();
        entry.degenerate = counts.degenerate;
        entry.duplicates = counts.duplicates;
    }
    let uses = edges::uses(mesh, welded, sound, |triangle| {
        mesh.objects[triangle as usize]
    });
    for edge in edges::by_edge(&uses) {
        let pick: fn(&mut ObjectDefects) -> &mut Edges = match edge {
            [_] => |object| &mut object.boundary,
            [one, other] if one.forward == other.forward => |object| &mut object.mixed_winding,
            [_, _] => continue,
            _ => |object| &mut object.non_manifold,
        };
        let entry = objects.entry(edge[0].group).or_default();
        pick(entry).add(edge[0].ends.map(|end| mesh.positions[end as usize]));
    }
    objects
        .into_iter()
        .map(|(object, found)| ObjectDefects { object, ..found })
        .collect()
}

/// In each piece of triangles joined by edges of two, those wound against the greater area.
fn turned(mesh: &Mesh, uses: &[Use]) -> Vec<Turned> {
    let mut pieces = Pieces::new(mesh.len());
    for edge in edges::by_edge(uses) {
        if let [one, other] = edge {
            pieces.join(one.triangle, other.triangle, one.forward == other.forward);
        }
    }
    let area = |triangle: usize| mesh.triangle(triangle).area();
    let mut of_object: BTreeMap<u32, f64> = BTreeMap::new();
    let mut of_piece: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
    for (triangle, index) in (0_u32..).zip(0..mesh.len()) {
        let (root, against) = pieces.find(triangle);
        of_piece.entry(root).or_default()[usize::from(against)] += area(index);
        *of_object.entry(mesh.objects[index]).or_default() += area(index);
    }
    let mut turned: BTreeMap<u32, Turned> = BTreeMap::new();
    for (triangle, index) in (0_u32..).zip(0..mesh.len()) {
        let (root, against) = pieces.find(triangle);
        let [with, other] = of_piece[&root];
        if against == (other > with) {
            continue;
        }
        let object = mesh.objects[index];
        let entry = turned.entry(object).or_insert_with(|| Turned {
            object,
            triangles: 0,
            area: 0.0,
            of: of_object[&object],
            at: mesh.triangle(index).centroid(),
        });
        entry.triangles += 1;
        entry.area += area(index);
    }
    turned.into_values().collect()
}

#[cfg(test)]
mod office;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape;

    fn mesh(parts: &[shape::Faces]) -> Mesh {
        let mut mesh = Mesh::default();
        for (object, (positions, triangles)) in (0..).zip(parts) {
            mesh.append(positions, triangles, 0, object);
        }
        mesh
    }

    #[test]
    fn a_sound_box_has_no_defect() {
        let sound = shape::cuboid(DVec3::ZERO, DVec3::ONE, false);
        assert_eq!(of(&mesh(&[sound])), Report::default());
    }

    #[test]
    fn a_mesh_with_a_vertex_that_does_not_exist_is_no_reason_to_panic() {
        let (positions, mut triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, true);
        triangles[0][0] = 8;
        let broken = mesh(&[(positions, triangles)]);
        assert_eq!(of(&broken), Report::default());
        assert!(Solids::of(&broken).is_empty());
    }

    #[test]
    fn a_body_inside_out_is_told_from_a_sound_one() {
        let report = of(&mesh(&[
            shape::cuboid(DVec3::ZERO, DVec3::ONE, false),
            shape::cuboid(DVec3::splat(2.0), DVec3::splat(4.0), true),
        ]));
        assert_eq!(report.inside_out.len(), 1);
        let found = report.inside_out[0];
        assert_eq!(found.object, 1);
        assert!((found.volume + 8.0).abs() < 1e-12);
        assert_eq!(
            (found.min, found.max),
            (DVec3::splat(2.0), DVec3::splat(4.0))
        );
    }

    #[test]
    fn a_turned_face_is_found_by_its_edges() {
        let (positions, mut triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, false);
        triangles[3].swap(0, 1);
        let report = of(&mesh(&[(positions, triangles)]));
        assert_eq!(report.objects.len(), 1);
        assert_eq!(report.objects[0].mixed_winding.count, 3);
        let length = report.objects[0].mixed_winding.length;
        assert!((length - (2.0 + 2.0_f64.sqrt())).abs() < 1e-12);
        assert_eq!(report.turned.len(), 1);
        assert_eq!(report.turned[0].triangles, 1);
        assert!((report.turned[0].area - 0.5).abs() < 1e-12);
        assert!((report.turned[0].of - 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_fin_on_a_box_is_non_manifold() {
        let fin = vec![DVec3::ZERO, DVec3::X, DVec3::new(0.5, -1.0, 0.0)];
        let mut mesh = mesh(&[shape::cuboid(DVec3::ZERO, DVec3::ONE, false)]);
        mesh.append(&fin, &[[0, 1, 2]], 0, 0);
        let object = of(&mesh).objects[0];
        assert_eq!((object.non_manifold.count, object.boundary.count), (1, 2));
        assert_eq!(object.non_manifold.longest, [DVec3::ZERO, DVec3::X]);
    }

    #[test]
    fn waste_is_counted_and_does_not_disturb_the_edges() {
        let (positions, mut triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, false);
        triangles.extend([[0, 4, 6], [0, 0, 1], [4, 6, 0]]);
        let report = of(&mesh(&[(positions, triangles)]));
        let object = report.objects[0];
        assert_eq!((object.degenerate, object.duplicates), (1, 2));
        assert_eq!(object.non_manifold.count + object.boundary.count, 0);
        assert!(report.holes.is_empty());
    }
}
