//! A first reading of an OBJ file, which makes of it a text that tobj reads without an error or a panic.
//!
//! It does what tobj does not: it checks the numbers (tobj lets NaN pass) and says the line and the object in
//! errors, keeps the names of undefined materials, tells `o` from `g` and objects of one name apart, and leaves
//! out lines (tobj makes a triangle of an `l` of three vertices) and whatever would fill the memory unused.

use super::super::text::{Line, Lines, words};
use super::super::{LoadError, model::listed, mtl};
use glam::{DAffine3, DVec3};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs::File;
use std::path::{Path, PathBuf};

/// tobj needs some 100 bytes a face until the object's end; so an object is begun again after so many.
const FACES_AT_ONCE: u32 = 1 << 16;

/// What the lines so far have said.
pub(super) struct Scan<'a> {
    file: &'a Path,
    placement: DAffine3,
    /// The OBJ for tobj. Objects go by their number.
    pub text: String,
    /// All its materials, as MTL for tobj.
    pub library: String,
    libraries: HashSet<PathBuf>,
    /// Materials used, with the line of first use.
    used: BTreeMap<String, u64>,
    material: String,
    vertices: usize,
    faces: u32,
    /// Lines of the faces of more than three corners, in order.
    pub polygons: Vec<u64>,
    /// Faces that are none: of fewer than three corners, and what is found later.
    pub ragged: Tally,
    ignored: BTreeMap<String, Tally>,
    pub objects: Vec<Named>,
    current: usize,
    /// Groups made by `g`, by name: a group may be continued later in the file.
    groups: HashMap<String, usize>,
    /// Whether there has been an `o`; groups within objects do not split them.
    has_objects: bool,
    inheriting: Vec<String>,
    pub notes: Vec<String>,
}

/// An object.
pub(super) struct Named {
    pub name: String,
    /// Whether its material is a choice of its own, or noted as inherited.
    chose: bool,
}

/// How often something occurred, and the line of the first time.
#[derive(Default)]
pub(super) struct Tally {
    pub count: usize,
    pub first: u64,
}

impl Tally {
    pub(super) fn add(&mut self, line: u64) {
        if self.count == 0 || line < self.first {
            self.first = line;
        }
        self.count += 1;
    }
}

impl<'a> Scan<'a> {
    pub(super) fn of(file: &'a Path, placement: DAffine3) -> Result<Self, LoadError> {
        let opened = File::open(file).map_err(|reason| LoadError::unreadable(file, reason))?;
        let mut scan = Self {
            file,
            placement,
            text: "mtllib all\n".to_owned(),
            library: String::new(),
            libraries: HashSet::new(),
            used: BTreeMap::new(),
            material: String::new(),
            vertices: 0,
            faces: 0,
            polygons: Vec::new(),
            ragged: Tally::default(),
            ignored: BTreeMap::new(),
            objects: Vec::new(),
            current: 0,
            groups: HashMap::new(),
            has_objects: false,
            inheriting: Vec::new(),
            notes: Vec::new(),
        };
        // Faces before any `o` or `g` belong to an object of the file's name.
        scan.begin(&file.file_stem().unwrap_or_default().to_string_lossy());
        Lines::of(file, opened).visit(|line| scan.line(&line))?;
        scan.finish();
        Ok(scan)
    }

    fn line(&mut self, line: &Line) -> Result<(), LoadError> {
        match line.keyword {
            "v" => self.vertex(line)?,
            "f" => self.face(line)?,
            "o" => {
                self.has_objects = true;
                self.begin(line.rest);
            }
            "g" if !self.has_objects => match self.groups.get(line.rest) {
                Some(&group) => self.resume(group),
                None => {
                    self.begin(line.rest);
                    self.groups.insert(line.rest.to_owned(), self.current);
                }
            },
            "usemtl" => {
                let name = line.rest;
                if name.is_empty() {
                    return Err(self.invalid(line, "a usemtl has a name"));
                }
                self.text.extend(["usemtl ", name, "\n"]);
                self.used.entry(name.to_owned()).or_insert(line.number);
                name.clone_into(&mut self.material);
                self.objects[self.current].chose = true;
            }
            "mtllib" => self.read_libraries(line)?,
            keyword @ ("l" | "p" | "curv" | "curv2" | "surf") => {
                let tally = self.ignored.entry(keyword.to_owned()).or_default();
                tally.add(line.number);
            }
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, line: &Line) -> Result<(), LoadError> {
        let mut found = [f64::NAN; 3];
        let mut words = words(line.rest);
        self.text.push('v');
        for value in &mut found {
            let word = words.next().unwrap_or_default();
            *value = word
                .parse()
                .map_err(|_| self.invalid(line, "a vertex has three numbers"))?;
            self.text.extend([" ", word]);
        }
        self.text.push('\n');
        self.vertices += 1;
        let position = self.placement.transform_point3(DVec3::from_array(found));
        if !position.is_finite() {
            return Err(LoadError::NotFinite {
                file: self.file.to_owned(),
                place: self.place(line),
                vertex: self.vertices,
                found,
            });
        }
        Ok(())
    }

    fn face(&mut self, line: &Line) -> Result<(), LoadError> {
        let start = self.text.len();
        let mut corners = 0;
        self.text.push('f');
        for word in words(line.rest) {
            let number = word.split('/').next().unwrap_or_default();
            let index: i64 = number.parse().map_err(|_| {
                self.invalid(line, "a face has vertex numbers such as 7, 7/1 or 7/1/3")
            })?;
            // Counted from 1, or back from −1.
            if !(1..=self.vertices as u64).contains(&index.unsigned_abs()) {
                return Err(LoadError::Index {
                    file: self.file.to_owned(),
                    place: self.place(line),
                    index,
                    count: self.vertices,
                });
            }
            self.text.extend([" ", number]);
            corners += 1;
        }
        self.text.push('\n');
        if corners < 3 {
            self.text.truncate(start);
            self.ragged.add(line.number);
            return Ok(());
        }
        if corners > 3 {
            self.polygons.push(line.number);
        }
        let object = &mut self.objects[self.current];
        if !object.chose && !self.material.is_empty() {
            object.chose = true;
            self.inheriting
                .push(format!("{} ({})", object.name, self.material));
        }
        self.faces += 1;
        if self.faces == FACES_AT_ONCE {
            self.resume(self.current);
        }
        Ok(())
    }

    fn begin(&mut self, name: &str) {
        self.objects.push(Named {
            name: name.to_owned(),
            chose: false,
        });
        self.resume(self.objects.len() - 1);
    }

    fn resume(&mut self, object: usize) {
        self.current = object;
        self.faces = 0;
        self.text += &format!("o {object}\n");
    }

    /// Reads the files of a `mtllib`: one whose name may hold spaces, or several.
    fn read_libraries(&mut self, line: &Line) -> Result<(), LoadError> {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let whole = folder.join(line.rest);
        let paths = if whole.is_file() {
            vec![whole]
        } else {
            words(line.rest).map(|name| folder.join(name)).collect()
        };
        for path in paths {
            if !self.libraries.insert(path.clone()) {
                continue;
            }
            let opened = File::open(&path).map_err(|reason| LoadError::Companion {
                file: self.file.to_owned(),
                place: format!("line {} (mtllib)", line.number),
                needed: path.clone(),
                reason,
                remedy: "put it there, or delete that line and give the materials in the scene file",
            })?;
            self.library += &mtl::cleaned(&path, opened, &mut self.notes)?;
        }
        Ok(())
    }

    /// Adds the undefined materials to the library, and the notes.
    fn finish(&mut self) {
        let mut defined = HashSet::new();
        let definitions = self.library.lines();
        for name in definitions.filter_map(|line| line.strip_prefix("newmtl ")) {
            if !defined.insert(name) {
                self.notes.push(format!(
                    "material {name} is defined twice; the later one holds"
                ));
            }
        }
        let used = self.used.iter();
        let mut undefined: Vec<_> = used
            .filter(|(name, _)| !defined.contains(name.as_str()))
            .collect();
        undefined.sort_by_key(|(_, line)| **line);
        let mut names = Vec::new();
        for (name, line) in undefined {
            self.library += &format!("newmtl {name}\n");
            names.push(format!("{name:?} (line {line})"));
        }
        note(
            &mut self.notes,
            "materials used and defined in no .mtl file",
            &names,
        );
        note(
            &mut self.notes,
            "objects without a usemtl take the material before them",
            &self.inheriting,
        );
        for (keyword, tally) in &self.ignored {
            self.notes.push(format!(
                "{} {keyword} elements (first in line {}) are no surfaces and ignored",
                tally.count, tally.first
            ));
        }
    }

    fn place(&self, line: &Line) -> String {
        format!(
            "line {}, object {}",
            line.number, self.objects[self.current].name
        )
    }

    fn invalid(&self, line: &Line, allowed: &str) -> LoadError {
        let found = format!("{} {}", line.keyword, line.rest);
        LoadError::invalid(self.file, self.place(line), found, allowed)
    }
}

/// Notes what all of `which` are, where there are any.
pub(super) fn note(notes: &mut Vec<String>, what: &str, which: &[String]) {
    if !which.is_empty() {
        notes.push(format!("{what}: {}", listed(which)));
    }
}
