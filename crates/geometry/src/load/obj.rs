//! Wavefront OBJ.
//!
//! The crate tobj reads objects, groups, faces and materials. `scan` gives it a text that is fit for it, `parts`
//! cuts its polygons into triangles.

mod parts;
mod scan;

#[cfg(test)]
mod traps;

use super::model::Names;
use super::polygon::Clipper;
use super::{FileMaterial, LoadError, Model, Object, Placement, Properties, mtl};
use glam::DAffine3;
use parts::Growing;
use scan::{Scan, note};
use std::path::Path;

/// Reads an OBJ file and its material libraries.
///
/// An `o` begins an object. So does a `g` as long as the file has had no `o`. Vertex normals and texture
/// coordinates are passed over unread.
pub(super) fn read(file: &Path, placement: &Placement) -> Result<Model, LoadError> {
    let mut scan = Scan::of(file, placement.transform())?;
    let options = tobj::LoadOptions {
        // tobj would cut a concave polygon as a fan.
        triangulate: false,
        single_index: false,
        // The scan has noted them, and left them out.
        ignore_points: true,
        ignore_lines: true,
    };
    let text = std::mem::take(&mut scan.text);
    let (models, materials) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| {
        tobj::load_mtl_buf(&mut scan.library.as_bytes())
    })
    .and_then(|(models, materials)| Ok((models, materials?)))
    .map_err(|reason| LoadError::invalid(file, "OBJ", reason.to_string(), "see its format"))?;
    drop(text);

    let mut parts: Vec<Vec<Growing>> = scan.objects.iter().map(|_| Vec::new()).collect();
    let mut clipper = Clipper::new();
    let mut lines = scan.polygons.iter().copied();
    for tobj::Model { mesh, name } in models {
        if mesh.indices.is_empty() {
            // So is the last one of a file without faces.
            continue;
        }
        let object: usize = name.parse().expect("the scan has made it a number");
        let parts = &mut parts[object];
        let known = parts.iter().position(|p| p.material == mesh.material_id);
        let index = known.unwrap_or(parts.len());
        if known.is_none() {
            parts.push(Growing::new(mesh.material_id));
        }
        let placement = placement.transform();
        parts[index].add(&mesh, placement, &mut clipper, &mut lines, &mut scan.ragged);
    }

    // OBJ has no local axes; an object's are the file's, in the world's directions.
    let frame = placement.transform() * DAffine3::from_mat3(placement.up.turn().transpose());
    let mut notes = scan.notes;
    let mut names = Names::default();
    let mut empty = Vec::new();
    let mut objects = Vec::new();
    for (index, (named, parts)) in scan.objects.into_iter().zip(parts).enumerate() {
        if !parts.is_empty() {
            objects.push(Object {
                name: names.unique(&named.name),
                properties: Properties::new(),
                parts: parts.into_iter().map(Growing::finish).collect(),
                frame,
            });
        } else if index > 0 {
            empty.push(named.name);
        }
    }
    note(&mut notes, "objects without faces are left out", &empty);
    if scan.ragged.count > 0 {
        notes.push(format!(
            "{} faces (first in line {}) cross themselves or have no area: their triangles may not be what was meant",
            scan.ragged.count, scan.ragged.first
        ));
    }
    let materials = materials.into_iter().map(|material| FileMaterial {
        look: mtl::look(&material),
        name: material.name,
        properties: Properties::new(),
    });
    Ok(Model {
        objects,
        materials: materials.collect(),
        lamps: Vec::new(),
        notes,
    })
}
