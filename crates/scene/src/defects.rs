//! What is wrong with the geometry, in words.

use glam::DVec3;
use malus_geometry::defects::{Edges, ObjectDefects, Report};
use malus_geometry::{Coincidence, Surfaces};
use std::collections::{BTreeMap, BTreeSet};

/// How many names or places a sentence lists before it counts the rest.
const LISTED: usize = 5;

/// One sentence for each kind of defect and object, with a place to look at; where an observer is, in m, a solid may
/// be a room, and objects that are `sheets` have rims rightly.
pub(crate) fn warnings(
    report: &Report,
    surfaces: &Surfaces,
    objects: &[String],
    observers: &[DVec3],
    sheets: &BTreeSet<u32>,
) -> Vec<String> {
    let mut rimmed = flush(surfaces);
    rimmed.extend(sheets);
    let name = |object: u32| &objects[object as usize];
    let mut warnings = Vec::new();
    for found in &report.objects {
        let object = name(found.object);
        let mut tell = |count: usize, what: &str| {
            if count > 0 {
                warnings.push(format!("object {object:?}: {count} {what}"));
            }
        };
        tell(found.degenerate, "triangles without area are left out");
        tell(found.duplicates, "doubled triangles are left out");
        let edges = [
            (
                found.non_manifold,
                "non-manifold edges (more than two faces meet)",
            ),
            (
                found.mixed_winding,
                "edges with mixed winding (one of two faces is turned over)",
            ),
        ];
        for (edges, what) in edges.iter().filter(|(edges, _)| edges.count > 0) {
            tell(edges.count, &format!("{what}, {}", longest(edges)));
        }
    }
    let others = report
        .objects
        .iter()
        .filter(|found| !rimmed.contains(&found.object));
    warnings.extend(boundary(&others.collect::<Vec<_>>(), objects));
    for solid in &report.inside_out {
        let holds = |point: DVec3| point.cmpge(solid.min).all() && point.cmple(solid.max).all();
        if !observers.iter().any(|point| holds(*point)) {
            warnings.push(format!(
                "object {:?} is inside out: its normals point into its {:.4} m³ near {}",
                name(solid.object),
                -solid.volume,
                place(0.5 * (solid.min + solid.max))
            ));
        }
    }
    for turned in &report.turned {
        let whole = if turned.area < turned.of * (1.0 - 1e-9) {
            format!("{} triangles ({:.4} m²)", turned.triangles, turned.area)
        } else {
            "all its faces".into()
        };
        warnings.push(format!(
            "object {:?}: {whole} turned over against the faces they join, near {}",
            name(turned.object),
            place(turned.at)
        ));
    }
    let holes: Vec<_> = report
        .holes
        .iter()
        .filter(|hole| !hole.objects.iter().all(|object| rimmed.contains(object)))
        .collect();
    for hole in holes.iter().take(LISTED) {
        let names: Vec<String> = hole.objects.iter().map(|it| name(*it).clone()).collect();
        warnings.push(format!(
            "the geometry is open along a rim of {:.3} m around {:.4} m² near {} (of {}): a hole, or a single sheet",
            hole.length,
            hole.area,
            place(0.5 * (hole.min + hole.max)),
            listed(&names)
        ));
    }
    if holes.len() > LISTED {
        let more = holes.len() - LISTED;
        warnings.push(format!("the geometry is open along {more} smaller rims"));
    }
    warnings
}

/// Objects that lie flush in others with all of their area, as a lamp does in a ceiling: their rims are no holes.
fn flush(surfaces: &Surfaces) -> BTreeSet<u32> {
    let mut hiding: BTreeMap<u32, f64> = BTreeMap::new();
    for pair in surfaces.coincidences() {
        *hiding.entry(pair.covering_object).or_default() += pair.area;
    }
    let mesh = surfaces.mesh();
    let mut areas: BTreeMap<u32, f64> = BTreeMap::new();
    for (index, object) in mesh
        .objects
        .iter()
        .enumerate()
        .filter(|(_, object)| hiding.contains_key(object))
    {
        *areas.entry(*object).or_default() += mesh.triangle(index).area();
    }
    let whole = |(object, area): (&u32, &f64)| (hiding[object] >= 0.999 * area).then_some(*object);
    areas.iter().filter_map(whole).collect()
}

/// Surfaces that lie in one another, each pair with its area.
pub(crate) fn coincidences(
    surfaces: &Surfaces,
    objects: &[String],
    materials: &[String],
) -> Vec<String> {
    let side = |object: u32, surface: u32| {
        let (object, material) = (&objects[object as usize], &materials[surface as usize]);
        format!("{object:?} ({material})")
    };
    let sentence = |pair: &Coincidence| {
        format!(
            "object {} hides {:.6} m² of {}, which lies in the same place: the later one exists",
            side(pair.covering_object, pair.covering_surface),
            pair.area,
            side(pair.hidden_object, pair.hidden_surface)
        )
    };
    surfaces.coincidences().iter().map(sentence).collect()
}

/// One sentence for all boundary edges, because single sheets have them rightly.
fn boundary(found: &[&ObjectDefects], objects: &[String]) -> Option<String> {
    let open = || found.iter().filter(|object| object.boundary.count > 0);
    let names: Vec<String> = open()
        .map(|object| objects[object.object as usize].clone())
        .collect();
    let count: usize = open().map(|object| object.boundary.count).sum();
    (count > 0).then(|| {
        format!(
            "{count} boundary edges in {} objects ({}): right for single sheets, otherwise a face is missing",
            names.len(),
            listed(&names)
        )
    })
}

fn longest(edges: &Edges) -> String {
    let [from, to] = edges.longest;
    format!(
        "{:.3} m in all, the longest from {} to {}",
        edges.length,
        place(from),
        place(to)
    )
}

fn place(point: DVec3) -> String {
    // Adding zero turns −0 into 0.
    let [x, y, z] = point.to_array().map(|x| (x * 1e3).round() / 1e3 + 0.0);
    format!("({x}, {y}, {z})")
}

/// At most five names and the number of the others.
pub(crate) fn listed(names: &[String]) -> String {
    let mut text = names[..names.len().min(LISTED)].join(", ");
    if names.len() > LISTED {
        text += &format!(" and {} more", names.len() - LISTED);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use malus_geometry::{Mesh, defects, shape};

    fn told(mesh: &Mesh, observers: &[DVec3]) -> String {
        let objects = ["Room".to_owned(), "Fin".to_owned()];
        let surfaces = Surfaces::new(mesh.clone()).unwrap();
        warnings(
            &defects::of(mesh),
            &surfaces,
            &objects,
            observers,
            &BTreeSet::new(),
        )
        .join("\n")
    }

    fn room(inward: bool) -> Mesh {
        let mut mesh = Mesh::default();
        let (positions, triangles) = shape::cuboid(DVec3::ZERO, DVec3::ONE, inward);
        mesh.append(&positions, &triangles, 0, 0);
        mesh
    }

    #[test]
    fn a_sound_solid_is_not_mentioned_and_one_inside_out_is() {
        assert_eq!(told(&room(false), &[]), "");
        let told = told(&room(true), &[]);
        assert!(
            told.contains("\"Room\" is inside out") && told.contains("(0.5, 0.5, 0.5)"),
            "{told}"
        );
    }

    #[test]
    fn every_kind_of_defect_names_its_object() {
        let mut mesh = room(false);
        mesh.triangles[3].swap(0, 1);
        let fin = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, -1.0, 0.0)];
        mesh.append(&fin, &[[0, 1, 2], [0, 0, 1], [2, 1, 0]], 0, 1);
        let told = told(&mesh, &[]);
        assert!(
            told.contains("\"Room\": 3 edges with mixed winding"),
            "{told}"
        );
        assert!(told.contains("\"Fin\": 1 triangles without area"), "{told}");
        assert!(told.contains("\"Fin\": 1 doubled triangles"), "{told}");
        assert!(
            told.contains("3 boundary edges in 1 objects (Fin)"),
            "{told}"
        );
        assert!(told.contains("\"Room\": 1 triangles"), "{told}");
    }

    #[test]
    fn a_pair_in_one_place_is_named_with_its_area() {
        let mut mesh = Mesh::default();
        for (number, size) in [(0, 2.0), (1, 0.5)] {
            let (positions, triangles) =
                shape::rectangle(DVec3::ZERO, DVec3::X * size, DVec3::Y * size);
            mesh.append(&positions, &triangles, number, number);
        }
        let surfaces = Surfaces::new(mesh).unwrap();
        let names = ["Ceiling".to_owned(), "Lamp".to_owned()];
        let told = coincidences(&surfaces, &names, &names);
        assert_eq!(told.len(), 1);
        assert!(
            told[0].contains("\"Lamp\" (Lamp) hides 0.250000 m² of \"Ceiling\""),
            "{told:?}"
        );
    }
}
