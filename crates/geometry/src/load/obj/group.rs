//! The objects of an OBJ file in the making.

use super::super::model::{Names, listed};
use super::super::{FileMaterial, Object, Part, Properties};
use glam::{DAffine3, DVec3};
use std::collections::HashMap;
use std::path::Path;

/// The objects read so far and the place where the next face goes.
pub(super) struct Groups {
    list: Vec<Group>,
    current: usize,
    /// Groups made by `g`, by name: a group may be continued later in the file.
    named: HashMap<String, usize>,
    /// Whether there has been an `o`; groups within objects do not split them.
    objects: bool,
    material: Option<usize>,
}

/// One object. Its triangles hold indices into the file's vertices until the end.
struct Group {
    name: String,
    chunks: Vec<Chunk>,
    current: usize,
    /// Whether it names its material by a `usemtl` of its own before its first face.
    chose: bool,
    inherits: Option<usize>,
}

/// The triangles of one material.
struct Chunk {
    material: Option<usize>,
    triangles: Vec<[u32; 3]>,
    faces: Vec<u32>,
    /// Faces so far.
    count: u32,
}

impl Group {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            chunks: Vec::new(),
            current: 0,
            chose: false,
            inherits: None,
        }
    }

    fn chunk(&mut self, material: Option<usize>) -> &mut Chunk {
        if self.chunks.get(self.current).map(|c| c.material) != Some(material) {
            let known = self.chunks.iter().position(|c| c.material == material);
            self.current = known.unwrap_or(self.chunks.len());
            if known.is_none() {
                self.chunks.push(Chunk {
                    material,
                    triangles: Vec::new(),
                    faces: Vec::new(),
                    count: 0,
                });
            }
        }
        &mut self.chunks[self.current]
    }
}

impl Groups {
    /// Faces before any `o` or `g` belong to an object of the file's name.
    pub(super) fn new(file: &Path) -> Self {
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        Self {
            list: vec![Group::new(&name)],
            current: 0,
            named: HashMap::new(),
            objects: false,
            material: None,
        }
    }

    pub(super) fn begin_object(&mut self, name: &str) {
        self.objects = true;
        self.current = self.list.len();
        self.list.push(Group::new(name));
    }

    pub(super) fn begin_group(&mut self, name: &str) {
        if self.objects {
            return;
        }
        self.current = self.named.get(name).copied().unwrap_or(self.list.len());
        if self.current == self.list.len() {
            self.list.push(Group::new(name));
            self.named.insert(name.to_owned(), self.current);
        }
    }

    pub(super) fn choose(&mut self, material: usize) {
        self.material = Some(material);
        self.list[self.current].chose = true;
    }

    pub(super) fn current_name(&self) -> &str {
        &self.list[self.current].name
    }

    /// Adds the triangles of one face, of the present material, to the present object.
    pub(super) fn add(&mut self, triangles: impl Iterator<Item = [u32; 3]>) {
        let group = &mut self.list[self.current];
        if !group.chose && group.inherits.is_none() {
            group.inherits = self.material;
        }
        let chunk = group.chunk(self.material);
        let before = chunk.triangles.len();
        chunk.triangles.extend(triangles);
        if chunk.triangles.len() > before {
            chunk.faces.resize(chunk.triangles.len(), chunk.count);
            chunk.count += 1;
        }
    }

    /// The objects that have faces.
    pub(super) fn finish(
        self,
        positions: &[DVec3],
        frame: DAffine3,
        materials: &[FileMaterial],
        notes: &mut Vec<String>,
    ) -> Vec<Object> {
        let mut names = Names::default();
        let mut places = vec![u32::MAX; positions.len()];
        let (mut empty, mut inheriting) = (Vec::new(), Vec::new());
        let mut objects = Vec::new();
        for (index, group) in self.list.into_iter().enumerate() {
            if group.chunks.is_empty() {
                if index > 0 {
                    empty.push(group.name);
                }
                continue;
            }
            if let Some(material) = group.inherits {
                inheriting.push(format!("{} ({})", group.name, materials[material].name));
            }
            objects.push(Object {
                name: names.unique(&group.name),
                properties: Properties::new(),
                parts: group
                    .chunks
                    .into_iter()
                    .map(|c| {
                        Part::gathered(c.material, c.triangles, c.faces, positions, &mut places)
                    })
                    .collect(),
                frame,
            });
        }
        if !empty.is_empty() {
            notes.push(format!(
                "objects without faces are left out: {}",
                listed(&empty)
            ));
        }
        if !inheriting.is_empty() {
            notes.push(format!(
                "objects without a usemtl take the material before them: {}",
                listed(&inheriting)
            ));
        }
        objects
    }
}
