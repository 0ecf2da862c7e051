//! glTF 2.0, as `.gltf` and `.glb`.
//!
//! The crate gltf reads the JSON. The data are read here, because its own readers trust the file: every range
//! and index is checked before use.

mod accessor;
mod buffer;
mod container;
mod document;
mod lamp;
mod material;
mod primitive;
mod uri;

#[cfg(test)]
mod traps;
#[cfg(test)]
mod writer;

use super::model::Names;
use super::{LoadError, Model, Object, Part, Placement, Properties};
use ::gltf::mesh::Mode;
use ::gltf::scene::Transform;
use ::gltf::{Document, Mesh, Node, Semantic};
use accessor::Accessors;
use buffer::Buffers;
use glam::{DAffine3, DMat4, DQuat, DVec3};
use std::collections::HashSet;
use std::fs;
use std::path::Path;

/// Reads a glTF file, binary or not, and the files it refers to.
pub(super) fn read(file: &Path, placement: &Placement) -> Result<Model, LoadError> {
    let bytes = fs::read(file).map_err(|reason| LoadError::unreadable(file, reason))?;
    let (json, binary) = container::split(file, &bytes)?;
    let mut notes = Vec::new();
    let document = document::parse(file, json, &mut notes)?;
    let buffers = Buffers::read(file, &document, binary)?;
    let materials = material::all(&document, &buffers, &mut notes);
    let mut walk = Walk {
        file,
        document: &document,
        accessors: Accessors {
            file,
            buffers: &buffers,
        },
        placement,
        object_names: Names::default(),
        lamp_names: Names::default(),
        said: HashSet::new(),
        model: Model {
            materials,
            notes,
            ..Model::default()
        },
    };
    walk.scene()?;
    Ok(walk.model)
}

/// The way through the tree of nodes, collecting what hangs on it.
struct Walk<'a> {
    file: &'a Path,
    document: &'a Document,
    accessors: Accessors<'a>,
    placement: &'a Placement,
    object_names: Names,
    lamp_names: Names,
    said: HashSet<String>,
    model: Model,
}

impl<'a> Walk<'a> {
    /// Visits each node once, parents first, with its map to the world. The nodes wait on a stack of our own,
    /// because a file may nest them as deep as it likes.
    fn scene(&mut self) -> Result<(), LoadError> {
        let root = self.placement.transform();
        let mut stack: Vec<_> = self.roots().into_iter().map(|n| (n, root)).collect();
        stack.reverse();
        let mut seen = vec![false; self.document.as_json().nodes.len()];
        while let Some((node, parent)) = stack.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(self.invalid(
                    &node,
                    "reached twice",
                    "a node has one parent and is none of its own descendants",
                ));
            }
            let world = parent * self.local(&node)?;
            if !world.is_finite() {
                let allowed = "every transform down to a node must be finite";
                return Err(self.invalid(&node, "a transform that overflows", allowed));
            }
            self.node(&node, world)?;
            let first = stack.len();
            stack.extend(node.children().map(|child| (child, world)));
            stack[first..].reverse();
        }
        Ok(())
    }

    /// The roots of the default scene, else of the first, else all nodes that are no children.
    fn roots(&mut self) -> Vec<Node<'a>> {
        let document = self.document;
        if let Some(scene) = document
            .default_scene()
            .or_else(|| document.scenes().next())
        {
            let others = document.scenes().len() - 1;
            if others > 0 {
                self.note(format!(
                    "only the scene {:?} is read, not the {others} others",
                    scene.name().unwrap_or_default()
                ));
            }
            return scene.nodes().collect();
        }
        let mut child = vec![false; document.as_json().nodes.len()];
        for index in document.nodes().flat_map(|n| n.children()) {
            child[index.index()] = true;
        }
        if !child.is_empty() {
            self.note("the file defines no scene: all its nodes are read".to_owned());
        }
        document.nodes().filter(|n| !child[n.index()]).collect()
    }

    /// A node's own transform, composed in f64 of the numbers in the file.
    fn local(&self, node: &Node) -> Result<DAffine3, LoadError> {
        match node.transform() {
            Transform::Matrix { matrix } => {
                let columns = matrix.map(|column| column.map(f64::from));
                Ok(DAffine3::from_mat4(DMat4::from_cols_array_2d(&columns)))
            }
            Transform::Decomposed {
                translation,
                rotation,
                scale,
            } => {
                let rotation = DQuat::from_array(rotation.map(f64::from));
                if rotation.length_squared() <= 0.0 {
                    let found = "a rotation (0, 0, 0, 0)";
                    return Err(self.invalid(node, found, "a rotation is a unit quaternion"));
                }
                Ok(DAffine3::from_scale_rotation_translation(
                    DVec3::from_array(scale.map(f64::from)),
                    rotation.normalize(),
                    DVec3::from_array(translation.map(f64::from)),
                ))
            }
        }
    }

    fn node(&mut self, node: &Node, world: DAffine3) -> Result<(), LoadError> {
        if let Some(light) = node.light() {
            let lamp =
                lamp::placed(node, &light, world, &mut self.lamp_names).ok_or_else(|| {
                    let allowed = "a lamp's direction must not vanish";
                    self.invalid(node, "a lamp under a scale of 0", allowed)
                })?;
            self.model.lamps.push(lamp);
        }
        let mesh = node.mesh();
        if mesh.is_none() && (node.light().is_some() || node.camera().is_some()) {
            return Ok(());
        }
        if node.skin().is_some() {
            self.note(format!("{}: its skin is ignored", described(node)));
        }
        let mut properties = Properties::new();
        let mut parts = Vec::new();
        if let Some(mesh) = &mesh {
            properties.extend(material::properties(mesh.extras()));
            parts = self.parts(mesh, world)?;
        }
        properties.extend(material::properties(node.extras()));
        let name = match (node.name(), mesh.as_ref().and_then(Mesh::name)) {
            (Some(name), _) | (None, Some(name)) => name.to_owned(),
            (None, None) => format!("node {}", node.index()),
        };
        self.model.objects.push(Object {
            name: self.object_names.unique(&name),
            properties,
            parts,
            frame: world * DAffine3::from_mat3(self.placement.up.turn().transpose()),
        });
        Ok(())
    }

    /// The triangles of one instance of a mesh, in the world.
    fn parts(&mut self, mesh: &Mesh, world: DAffine3) -> Result<Vec<Part>, LoadError> {
        let mirrored = world.matrix3.determinant() < 0.0;
        let name = format!("meshes[{}] {:?}", mesh.index(), mesh.name().unwrap_or(""));
        let mut parts = Vec::new();
        for primitive in mesh.primitives() {
            let place = format!("{name}, primitive {}", primitive.index());
            if primitive.morph_targets().len() > 0 {
                self.note(format!("{place}: its shape keys are ignored"));
            }
            let Some(accessor) = primitive.get(&Semantic::Positions) else {
                self.note(format!("{place} has no positions and is ignored"));
                continue;
            };
            let positions = self.accessors.positions(&accessor, &place)?;
            let indices = match primitive.indices() {
                Some(indices) => self.accessors.indices(&indices, &place)?,
                None => (0..positions.len() as u32).collect(),
            };
            let beyond = |&&i: &&u32| i as usize >= positions.len();
            if let Some(&index) = indices.iter().find(beyond) {
                return Err(LoadError::Index {
                    file: self.file.to_owned(),
                    place,
                    index: index.into(),
                    count: positions.len(),
                });
            }
            let Some(triangles) = primitive::triangles(primitive.mode(), &indices) else {
                self.note(format!("{place} is of points or lines and ignored"));
                continue;
            };
            if primitive.mode() == Mode::Triangles && indices.len() % 3 != 0 {
                let left = indices.len() % 3;
                self.note(format!("{place}: its last {left} indices make no triangle"));
            }
            drop(indices);
            if triangles.is_empty() {
                continue;
            }
            let faces = (0..triangles.len() as u32).collect();
            let mut places = vec![u32::MAX; positions.len()];
            let material = primitive.material().index();
            let mut part = Part::gathered(material, triangles, faces, &positions, &mut places);
            for (vertex, position) in part.positions.iter_mut().enumerate() {
                *position = world.transform_point3(*position);
                if !position.is_finite() {
                    return Err(LoadError::NotFinite {
                        file: self.file.to_owned(),
                        place,
                        vertex,
                        found: position.to_array(),
                    });
                }
            }
            if mirrored {
                part.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            }
            parts.push(part);
        }
        if parts.is_empty() {
            self.note(format!("{name} has no triangles"));
        }
        Ok(parts)
    }

    /// Adds a note unless it is there: instances share their meshes.
    fn note(&mut self, note: String) {
        if self.said.insert(note.clone()) {
            self.model.notes.push(note);
        }
    }

    fn invalid(&self, node: &Node, found: &str, allowed: &str) -> LoadError {
        LoadError::invalid(self.file, described(node), found, allowed)
    }
}

fn described(node: &Node) -> String {
    format!("nodes[{}] {:?}", node.index(), node.name().unwrap_or(""))
}
