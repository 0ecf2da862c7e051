//! The materials of an OBJ file.

use super::super::model::listed;
use super::super::text::{Line, words};
use super::super::{FileMaterial, LoadError, Properties, mtl};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs::File;
use std::path::{Path, PathBuf};

/// Materials by order of first mention, in a library or by a `usemtl`.
pub(super) struct Library<'a> {
    file: &'a Path,
    list: Vec<FileMaterial>,
    by_name: HashMap<String, usize>,
    /// Those used and not defined so far, with the line of first use.
    undefined: BTreeMap<usize, u64>,
    read: BTreeSet<PathBuf>,
    notes: Vec<String>,
}

impl<'a> Library<'a> {
    pub(super) fn new(file: &'a Path) -> Self {
        Self {
            file,
            list: Vec::new(),
            by_name: HashMap::new(),
            undefined: BTreeMap::new(),
            read: BTreeSet::new(),
            notes: Vec::new(),
        }
    }

    /// The material that a `usemtl` names; kept by its name where no library has defined it.
    pub(super) fn material(&mut self, line: &Line) -> usize {
        let known = self.list.len();
        let index = self.index(line.rest);
        if index == known {
            self.undefined.insert(index, line.number);
        }
        index
    }

    fn index(&mut self, name: &str) -> usize {
        if let Some(&index) = self.by_name.get(name) {
            return index;
        }
        self.by_name.insert(name.to_owned(), self.list.len());
        self.list.push(FileMaterial {
            name: name.to_owned(),
            properties: Properties::new(),
            look: mtl::unsaid(),
        });
        self.list.len() - 1
    }

    /// Reads the files of a `mtllib`: one whose name may hold spaces, or several.
    pub(super) fn read(&mut self, line: &Line) -> Result<(), LoadError> {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let whole = folder.join(line.rest);
        if whole.is_file() {
            return self.read_file(line, whole);
        }
        words(line.rest).try_for_each(|name| self.read_file(line, folder.join(name)))
    }

    fn read_file(&mut self, line: &Line, path: PathBuf) -> Result<(), LoadError> {
        if !self.read.insert(path.clone()) {
            return Ok(());
        }
        let opened = File::open(&path).map_err(|reason| LoadError::Companion {
            file: self.file.to_owned(),
            place: format!("line {} (mtllib)", line.number),
            needed: path.clone(),
            reason,
            remedy: "put it there, or delete that line and give the materials in the scene file",
        })?;
        for (name, look) in mtl::read(&path, opened, &mut self.notes)? {
            let known = self.list.len();
            let index = self.index(&name);
            if index < known && self.undefined.remove(&index).is_none() {
                self.notes.push(format!(
                    "material {name} is defined twice; the later one holds"
                ));
            }
            self.list[index].look = look;
        }
        Ok(())
    }

    pub(super) fn finish(mut self, notes: &mut Vec<String>) -> Vec<FileMaterial> {
        notes.append(&mut self.notes);
        if !self.undefined.is_empty() {
            let names: Vec<String> = self
                .undefined
                .iter()
                .map(|(&index, line)| format!("{:?} (line {line})", self.list[index].name))
                .collect();
            notes.push(format!(
                "materials used and defined in no .mtl file: {}",
                listed(&names)
            ));
        }
        self.list
    }
}
