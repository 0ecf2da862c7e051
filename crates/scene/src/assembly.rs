//! Joins meshes and shapes to one geometry and finds out which surface each triangle has.

use crate::error::Error;
use crate::file::SceneFile;
use crate::import::{Import, Role};
use crate::material::Material;
use crate::material::library::Library;
use crate::material::resolve::{Carrier, Sources};
use crate::nearest::hint;
use crate::properties::Emitted;
use crate::reader::unit;
use crate::shape::Shape;
use glam::DVec3;
use malus_geometry::{Mesh, Surfaces};
use std::collections::{BTreeMap, BTreeSet};

/// Name under which the scene file may describe faces that have no material.
pub(crate) const NAMELESS: &str = "(none)";

/// An object of a mesh file: indices of the file and of the object in it.
pub(crate) type ObjectIndex = (usize, usize);

/// The geometry of a scene, in file order, shapes after meshes.
#[derive(Default)]
pub(crate) struct Assembly {
    pub(crate) mesh: Mesh,
    /// Names of objects by object index.
    pub(crate) objects: Vec<String>,
    /// What is to be resolved to a material, by surface index.
    slots: Vec<Slot>,
    numbers: BTreeMap<Slot, u32>,
    /// An object that has the surface, by surface index, for messages.
    examples: Vec<String>,
}

/// One combination of material and object.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Slot {
    name: String,
    /// File and index of the mesh file's material.
    material: Option<(usize, usize)>,
    /// The object, where its own properties or its axis matter.
    object: Option<ObjectIndex>,
}

impl Assembly {
    /// Joins what is geometry; objects `measured` by a sensor of the scene file are none.
    pub(crate) fn new(
        imports: &[Import],
        file: &SceneFile,
        measured: &BTreeSet<ObjectIndex>,
    ) -> Result<Self, Error> {
        let mut assembly = Self::default();
        for (index, import) in imports.iter().enumerate() {
            let objects = 0..import.model.objects.len();
            for object in objects.filter(|object| import.role(*object) == Role::Geometry) {
                if !measured.contains(&(index, object)) {
                    assembly.add_object(imports, &file.library, (index, object));
                }
            }
        }
        let mut errors = Vec::new();
        for shape in &file.shapes {
            if let Err(error) = assembly.add_shape(shape, imports, &file.library) {
                errors.push(error);
            }
        }
        Error::all(errors).map(|()| assembly)
    }

    fn add_object(&mut self, imports: &[Import], library: &Library, at: ObjectIndex) {
        let import = &imports[at.0];
        let object = &import.model.objects[at.1];
        let number = index(self.objects.len());
        self.objects.push(if imports.len() > 1 {
            format!("{} ({})", object.name, import.file)
        } else {
            object.name.clone()
        });
        for part in &object.parts {
            let material = part.material.map(|material| (at.0, material));
            let name = material.map_or(NAMELESS, |(_, it)| &import.model.materials[it].name);
            let own = import.objects[at.1].is_material()
                || part.material.is_some_and(|material| {
                    follows_object(library, name, import.materials[material].state)
                });
            let slot = Slot {
                name: name.to_owned(),
                material,
                object: own.then_some(at),
            };
            let surface = self.surface(slot, import.label(object));
            let (positions, triangles) = (&part.positions, &part.triangles);
            self.mesh.append(positions, triangles, surface, number);
        }
    }

    fn add_shape(
        &mut self,
        shape: &Shape,
        imports: &[Import],
        library: &Library,
    ) -> Result<(), Error> {
        let wanted = &shape.material;
        let named = || {
            imports.iter().enumerate().flat_map(|(file, import)| {
                let materials = import.model.materials.iter().enumerate();
                materials.map(move |(index, material)| (material.name.as_str(), (file, index)))
            })
        };
        let material = named()
            .find(|(name, _)| *name == wanted.value)
            .map(|(_, material)| material);
        if material.is_none() && !library.knows(&wanted.value) {
            let known = library.names().chain(named().map(|(name, _)| name));
            return Err(Error::NoMatch {
                at: wanted.at.to_string(),
                what: "material".into(),
                name: wanted.value.clone(),
                hint: hint(&wanted.value, known),
            });
        }
        let number = index(self.objects.len());
        self.objects.push(shape.name.clone());
        let slot = Slot {
            name: wanted.value.clone(),
            material,
            object: None,
        };
        let surface = self.surface(slot, shape.name.clone());
        let (positions, triangles) = (&shape.positions, &shape.triangles);
        self.mesh.append(positions, triangles, surface, number);
        Ok(())
    }

    /// Surface index of a slot.
    fn surface(&mut self, slot: Slot, example: String) -> u32 {
        if let Some(&number) = self.numbers.get(&slot) {
            return number;
        }
        let number = index(self.slots.len());
        self.numbers.insert(slot.clone(), number);
        self.slots.push(slot);
        self.examples.push(example);
        number
    }

    /// Names that the scene file's materials may mean: of all materials in the files and of the shapes.
    pub(crate) fn material_names<'a>(&'a self, imports: &'a [Import]) -> Vec<&'a str> {
        let files = imports.iter().flat_map(|import| &import.model.materials);
        let files = files.map(|material| material.name.as_str());
        let used = self.slots.iter().map(|slot| slot.name.as_str());
        let names: BTreeSet<&str> = files.chain(used).collect();
        names.into_iter().collect()
    }

    /// The materials by surface index, and what is to be warned of; `surfaces` are those of the assembled mesh.
    pub(crate) fn materials(
        &self,
        imports: &[Import],
        library: &Library,
        surfaces: &Surfaces,
    ) -> Result<(Vec<Material>, Vec<String>), Error> {
        let areas = areas(surfaces, self.slots.len());
        let (mut materials, mut warnings, mut errors) = (Vec::new(), Vec::new(), Vec::new());
        for (slot, example) in self.slots.iter().zip(&self.examples) {
            let resolved = self.sources(slot, example, imports, library, &areas);
            match resolved.resolve() {
                Ok((material, doubts)) => {
                    for doubt in doubts {
                        let warning = format!("material {:?} {doubt}", slot.name);
                        if !warnings.contains(&warning) {
                            warnings.push(warning);
                        }
                    }
                    materials.push(material);
                }
                Err(error) => errors.push(error),
            }
        }
        Error::all(errors).map(|()| (materials, warnings))
    }

    fn sources<'a>(
        &self,
        slot: &'a Slot,
        example: &str,
        imports: &'a [Import],
        library: &'a Library,
        areas: &[f64],
    ) -> Sources<'a> {
        let of_material = |other: &Slot| slot.material.is_some() && other.material == slot.material;
        let object = slot.object.map(|(file, object)| {
            let import = &imports[file];
            let it = &import.model.objects[object];
            Carrier {
                name: &it.name,
                custom: &import.objects[object],
                local_x: unit(it.frame.transform_vector3(DVec3::X)).unwrap_or(DVec3::X),
                area: self.flux_area(slot, imports, library, areas),
            }
        });
        Sources {
            library,
            name: &slot.name,
            holder: match slot.name.as_str() {
                NAMELESS => format!("{example} has faces without a material"),
                name => format!("{example}, material {name:?}"),
            },
            object,
            custom: slot.material.map(|(file, it)| &imports[file].materials[it]),
            appearance: slot
                .material
                .map(|(file, it)| &imports[file].appearances[it]),
            area: self.area(areas, of_material),
        }
    }

    /// Area over which the flux of a slot's object is spread: its surfaces that emit by themselves, else all of them,
    /// those left out to which the scene file gives an exitance. None where the slot is not among them.
    fn flux_area(
        &self,
        slot: &Slot,
        imports: &[Import],
        library: &Library,
        areas: &[f64],
    ) -> Option<f64> {
        let open = |other: &Slot| {
            other.object == slot.object
                && library
                    .value(&other.name, |written| written.exitance.as_ref())
                    .is_none()
        };
        let emits = |other: &Slot| {
            other.material.is_some_and(|(file, it)| {
                match (
                    imports[file].materials[it].emitted,
                    imports[file].appearances[it].exitance,
                ) {
                    (Some(Emitted::Exitance(own) | Emitted::Flux(own)), _) => own > 0.0,
                    (None, Some((own, _))) => own > 0.0,
                    (None, None) => false,
                }
            })
        };
        let any_emits = self.slots.iter().any(|other| open(other) && emits(other));
        let among = |other: &Slot| open(other) && (emits(other) || !any_emits);
        among(slot).then(|| self.area(areas, among))
    }

    fn area(&self, areas: &[f64], wanted: impl Fn(&Slot) -> bool) -> f64 {
        let slots = self.slots.iter().zip(areas);
        slots
            .filter(|(slot, _)| wanted(slot))
            .map(|(_, area)| area)
            .sum()
    }
}

/// Whether the axis of a material's emitted light is the object's: its linear polarisation comes from a custom
/// property and the scene file gives no axis.
fn follows_object(library: &Library, name: &str, state: Option<[f64; 4]>) -> bool {
    let linear = state.is_some_and(|[_, q, u, _]| q.abs() > 0.0 || u.abs() > 0.0);
    linear
        && library
            .value(name, |written| written.emission_stokes.as_ref())
            .is_none()
        && library
            .value(name, |written| written.emission_axis.as_ref())
            .is_none()
}

/// Area of each of `count` surfaces, in m².
pub(crate) fn areas(surfaces: &Surfaces, count: usize) -> Vec<f64> {
    let mut areas = vec![0.0; count];
    for (triangle, &surface) in surfaces.mesh().surfaces.iter().enumerate() {
        areas[surface as usize] += surfaces.mesh().triangle(triangle).area();
    }
    areas
}

/// A count as an index; there cannot be more objects than triangles, and those are limited to fewer.
fn index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests;
