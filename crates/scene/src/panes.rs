//! Panes where none can be: on closed solids.

use crate::Material;
use crate::defects::listed;
use crate::error::Error;
use crate::material::library::Library;
use malus_geometry::Surfaces;
use malus_geometry::solid::{Solid, Solids};
use std::collections::{BTreeMap, BTreeSet};

/// Refuses closed solids that are panes on more than half of their area.
///
/// A pane is a whole sheet with both its faces, so a slab of glass modelled as a box would count twice. A solid whose
/// normals point inward is a room: what it holds is air, and each of its walls is a sheet.
pub(crate) fn check(
    surfaces: &Surfaces,
    materials: &[Material],
    objects: &[String],
    library: &Library,
) -> Result<(), Error> {
    if !materials.iter().any(|material| material.optics.is_pane()) {
        return Ok(());
    }
    let mut found: BTreeMap<&str, (u32, BTreeSet<&str>)> = BTreeMap::new();
    for solid in &Solids::of(surfaces.mesh()) {
        if let Some(surface) = glass(solid, surfaces, materials) {
            let name = &materials[surface as usize].name;
            let (_, names) = found.entry(name).or_insert((surface, BTreeSet::new()));
            names.insert(&objects[solid.object() as usize]);
        }
    }
    let refuse = |(_, (surface, names)): (&str, (u32, BTreeSet<&str>))| {
        let material = &materials[surface as usize];
        let kind = material.values.iter().find(|value| value.key == "kind");
        let place = library.place(&material.name, |written| written.kind.as_ref());
        let names: Vec<String> = names.into_iter().map(|name| format!("{name:?}")).collect();
        Error::PaneSolid {
            at: place.map_or(String::new(), |(at, _)| format!("{at}: ")),
            objects: listed(&names),
            material: material.name.clone(),
            origin: kind.map_or(String::new(), |kind| kind.origin.to_string()),
        }
    };
    Error::all(found.into_iter().map(refuse).collect())
}

/// The surface of the first pane of a solid of matter that is mostly pane.
fn glass(solid: &Solid<'_>, surfaces: &Surfaces, materials: &[Material]) -> Option<u32> {
    let mesh = surfaces.mesh();
    let (mut all, mut clear, mut first) = (0.0, 0.0, None);
    for &triangle in solid.triangles() {
        let area = surfaces.triangle(triangle).area();
        let surface = mesh.surfaces[triangle as usize];
        all += area;
        if materials[surface as usize].optics.is_pane() {
            clear += area;
            first = first.or(Some(surface));
        }
    }
    // A sheet given with both its sides, one in the other, holds nothing.
    let thickness = 2.0 * solid.volume() / all;
    first.filter(|_| 2.0 * clear > all && thickness > surfaces.tolerance())
}

/// Objects that are panes throughout.
pub(crate) fn sheets(surfaces: &Surfaces, materials: &[Material]) -> BTreeSet<u32> {
    let mesh = surfaces.mesh();
    let pairs = || mesh.objects.iter().zip(&mesh.surfaces);
    let is_pane = |surface: &u32| materials[*surface as usize].optics.is_pane();
    let opaque: BTreeSet<u32> = pairs()
        .filter(|(_, surface)| !is_pane(surface))
        .map(|(object, _)| *object)
        .collect();
    let clear = pairs().filter(|(object, _)| !opaque.contains(object));
    clear.map(|(object, _)| *object).collect()
}
