//! Wavefront OBJ.
//!
//! The crate tobj reads objects, groups, faces and materials. What it cannot do stands before it (`feed`), where
//! every line is checked, and behind it (`parts`).

mod feed;
mod parts;

#[cfg(test)]
mod traps;

use super::model::{Names, listed};
use super::polygon::Clipper;
use super::{FileMaterial, LoadError, Model, Object, Placement, Properties, mtl};
use feed::Feed;
use glam::DAffine3;
use parts::Growing;
use std::cell::Cell;
use std::collections::HashMap;
use std::fs::File;
use std::path::Path;

/// Reads an OBJ file and its material libraries.
///
/// An `o` begins an object. So does a `g` as long as the file has had no `o`. Vertex normals and texture
/// coordinates are passed over unread.
pub(super) fn read(file: &Path, placement: &Placement) -> Result<Model, LoadError> {
    let opened = File::open(file).map_err(|reason| LoadError::unreadable(file, reason))?;
    let options = tobj::LoadOptions {
        // tobj would cut a concave polygon as a fan.
        triangulate: false,
        single_index: false,
        ignore_points: true,
        ignore_lines: true,
    };
    let library = Cell::default();
    let mut feed = Feed::new(file, opened, placement.transform(), &library);
    let loaded = tobj::load_obj_buf(&mut feed, &options, |_| Ok(library.take()));
    if let Some(failure) = feed.failure {
        return Err(failure);
    }
    let (models, materials) = loaded
        .and_then(|(models, materials)| Ok((models, materials?)))
        .map_err(|reason| LoadError::invalid(file, "OBJ", reason.to_string(), "see the format"))?;

    let mut sieve = feed.sieve;
    let (materials, places) = merged(materials, &mut sieve.undefined, &mut sieve.notes);
    let mut parts: Vec<Vec<Growing>> = sieve.objects.iter().map(|_| Vec::new()).collect();
    let mut clipper = Clipper::new();
    let mut lines = sieve.polygons.into_iter();
    for tobj::Model { mesh, name } in models {
        // After the last face tobj gives one that is empty.
        let object = name.parse().ok().and_then(|o: usize| parts.get_mut(o));
        let Some(parts) = object.filter(|_| !mesh.indices.is_empty()) else {
            continue;
        };
        let material = mesh.material_id.map(|material| places[material]);
        let known = parts.iter().position(|p| p.part.material == material);
        let index = known.unwrap_or(parts.len());
        if known.is_none() {
            parts.push(Growing::new(material));
        }
        parts[index].add(
            &mesh,
            placement.transform(),
            &mut clipper,
            &mut lines,
            &mut sieve.ragged,
        );
    }

    // OBJ has no local axes; an object's are the file's, in the world's directions.
    let frame = placement.transform() * DAffine3::from_mat3(placement.up.turn().transpose());
    let mut names = Names::default();
    let mut empty = Vec::new();
    let mut objects = Vec::new();
    for (index, (named, parts)) in sieve.objects.into_iter().zip(parts).enumerate() {
        if !parts.is_empty() {
            objects.push(Object {
                name: names.unique(&named.name),
                properties: Properties::new(),
                parts: parts.into_iter().map(|growing| growing.part).collect(),
                frame,
            });
        } else if index > 0 {
            empty.push(named.name);
        }
    }

    let mut notes = Vec::new();
    for (keyword, tally) in &sieve.ignored {
        notes.push(format!(
            "{} {keyword} elements (first in line {}) are no surfaces and ignored",
            tally.count, tally.first
        ));
    }
    if sieve.ragged.count > 0 {
        notes.push(format!(
            "{} faces (first in line {}) cross themselves or have no area: their triangles may not be what was meant",
            sieve.ragged.count, sieve.ragged.first
        ));
    }
    notes.append(&mut sieve.notes);
    let undefined = materials.iter().filter_map(|m| {
        let line = sieve.undefined.get(&m.name)?;
        Some(format!("{:?} (line {line})", m.name))
    });
    for (what, which) in [
        (
            "materials used and defined in no .mtl file",
            undefined.collect(),
        ),
        ("objects without faces are left out", empty),
        (
            "objects without a usemtl take the material before them",
            sieve.inheriting,
        ),
    ] {
        if !which.is_empty() {
            notes.push(format!("{what}: {}", listed(&which)));
        }
    }
    Ok(Model {
        objects,
        materials,
        lamps: Vec::new(),
        notes,
    })
}

/// The materials by order of first mention, one for each name, and the place of each of tobj's among them. tobj
/// keeps what is defined again as another material, and faces already read with the one before.
fn merged(
    found: Vec<tobj::Material>,
    undefined: &mut HashMap<String, u64>,
    notes: &mut Vec<String>,
) -> (Vec<FileMaterial>, Vec<usize>) {
    let mut materials: Vec<FileMaterial> = Vec::new();
    let mut by_name = HashMap::new();
    let mut places = Vec::new();
    for material in found {
        let look = mtl::look(&material);
        let name = material.name;
        let place = *by_name.entry(name.clone()).or_insert(materials.len());
        places.push(place);
        if place == materials.len() {
            materials.push(FileMaterial {
                name,
                properties: Properties::new(),
                look,
            });
            continue;
        }
        materials[place].look = look;
        if undefined.remove(&name).is_none() {
            notes.push(format!(
                "material {name} is defined twice; the later one holds"
            ));
        }
    }
    (materials, places)
}
