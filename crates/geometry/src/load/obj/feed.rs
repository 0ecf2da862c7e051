//! What tobj is given to read: the file's lines, checked and made fit for it.
//!
//! tobj says neither line nor name in its errors, lets NaN and infinity pass, takes an `l` of three vertices for
//! a triangle, forgets the names of undefined materials, and makes of an `o` and a `g` the same. Whatever passes
//! here it reads without an error and without a panic.

use super::super::text::{Line, Lines, words};
use super::super::{LoadError, mtl};
use glam::{DAffine3, DVec3};
use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};
use std::fs::File;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

/// tobj holds some 100 bytes for each face of the object that it is in, until the next `o`; so the same object
/// is begun again after so many.
const FACES_AT_ONCE: u32 = 1 << 16;

/// Materials and the place of each name among them, as tobj gives and takes them.
pub(super) type Library = (Vec<tobj::Material>, HashMap<String, usize>);

/// The reader from which tobj takes one line at a time, so that it has done all before it.
pub(super) struct Feed<'a> {
    lines: Lines<'a>,
    pub sieve: Sieve<'a>,
    /// Bytes of the present text that tobj has taken.
    taken: usize,
    /// Why the text ended early; tobj does not pass it on.
    pub failure: Option<LoadError>,
}

impl<'a> Feed<'a> {
    /// `library` is where a `mtllib` of the text leaves its materials for tobj.
    pub(super) fn new(
        file: &'a Path,
        opened: File,
        placement: DAffine3,
        library: &'a Cell<Library>,
    ) -> Self {
        Self {
            lines: Lines::of(file, opened),
            sieve: Sieve::new(file, placement, library),
            taken: 0,
            failure: None,
        }
    }

    fn advance(&mut self) -> Result<bool, LoadError> {
        self.taken = 0;
        self.sieve.text.clear();
        let Some(line) = self.lines.line()? else {
            return Ok(false);
        };
        self.sieve.line(&line)?;
        Ok(true)
    }
}

impl BufRead for Feed<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        while self.taken == self.sieve.text.len() {
            match self.advance() {
                Ok(true) => {}
                Ok(false) => break,
                Err(failure) => {
                    self.failure = Some(failure);
                    return Err(io::ErrorKind::InvalidData.into());
                }
            }
        }
        Ok(&self.sieve.text.as_bytes()[self.taken..])
    }

    fn consume(&mut self, amount: usize) {
        self.taken += amount;
    }
}

impl Read for Feed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(buffer)?;
        self.consume(read);
        Ok(read)
    }
}

/// What the lines so far have said, and what tobj gets of the last one.
pub(super) struct Sieve<'a> {
    file: &'a Path,
    placement: DAffine3,
    text: String,
    vertices: usize,
    faces: u32,
    /// Lines of the faces of more than three corners, in order.
    pub polygons: Vec<u64>,
    /// Faces of fewer than three corners.
    pub ragged: Tally,
    /// Elements that are no faces, by keyword.
    pub ignored: Vec<(String, Tally)>,
    pub objects: Vec<Named>,
    current: usize,
    /// Groups made by `g`, by name: a group may be continued later in the file.
    groups: HashMap<String, usize>,
    /// Whether there has been an `o`; groups within objects do not split them.
    has_objects: bool,
    material: Option<String>,
    /// Objects with faces before any `usemtl` of their own, and the materials that these inherit.
    pub inheriting: Vec<String>,
    library: &'a Cell<Library>,
    /// Names of materials that tobj has been given.
    given: BTreeSet<String>,
    /// Materials used before a library has defined them, with the line of first use.
    pub undefined: HashMap<String, u64>,
    libraries: BTreeSet<PathBuf>,
    /// What the libraries have left aside.
    pub notes: Vec<String>,
}

/// An object. tobj is given its number, because names repeat.
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
        self.first = if self.count == 0 {
            line
        } else {
            self.first.min(line)
        };
        self.count += 1;
    }
}

impl<'a> Sieve<'a> {
    fn new(file: &'a Path, placement: DAffine3, library: &'a Cell<Library>) -> Self {
        let mut sieve = Self {
            file,
            placement,
            text: String::new(),
            vertices: 0,
            faces: 0,
            polygons: Vec::new(),
            ragged: Tally::default(),
            ignored: Vec::new(),
            objects: Vec::new(),
            current: 0,
            groups: HashMap::new(),
            has_objects: false,
            material: None,
            inheriting: Vec::new(),
            library,
            given: BTreeSet::new(),
            undefined: HashMap::new(),
            libraries: BTreeSet::new(),
            notes: Vec::new(),
        };
        // Faces before any `o` or `g` belong to an object of the file's name.
        sieve.begin(&file.file_stem().unwrap_or_default().to_string_lossy());
        sieve
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
            "usemtl" => self.choose(line)?,
            "mtllib" => self.read_libraries(line)?,
            "l" | "p" | "curv" | "curv2" | "surf" => {
                let known = self.ignored.iter().position(|i| i.0 == line.keyword);
                let index = known.unwrap_or(self.ignored.len());
                if known.is_none() {
                    let keyword = line.keyword.to_owned();
                    self.ignored.push((keyword, Tally::default()));
                }
                self.ignored[index].1.add(line.number);
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
        if !self
            .placement
            .transform_point3(DVec3::from_array(found))
            .is_finite()
        {
            return Err(LoadError::NotFinite {
                file: self.file.to_owned(),
                place: self.place(line),
                vertex: self.vertices,
                found,
            });
        }
        Ok(())
    }

    /// Gives the vertices alone: texture coordinates and normals would only fill the memory.
    fn face(&mut self, line: &Line) -> Result<(), LoadError> {
        self.text.push('f');
        let mut corners = 0;
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
            self.text.clear();
            self.ragged.add(line.number);
            return Ok(());
        }
        if corners > 3 {
            self.polygons.push(line.number);
        }
        let object = &mut self.objects[self.current];
        if let Some(material) = &self.material
            && !object.chose
        {
            object.chose = true;
            self.inheriting
                .push(format!("{} ({material})", object.name));
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

    /// A material that no library has defined so far becomes a library of its own.
    fn choose(&mut self, line: &Line) -> Result<(), LoadError> {
        let name = line.rest.to_owned();
        if name.is_empty() {
            return Err(self.invalid(line, "usemtl names a material"));
        }
        if self.given.insert(name.clone()) {
            self.undefined.insert(name.clone(), line.number);
            let material = tobj::Material {
                name: name.clone(),
                ..Default::default()
            };
            self.give((vec![material], HashMap::from([(name.clone(), 0)])));
        }
        self.text += &format!("usemtl {name}\n");
        self.material = Some(name);
        self.objects[self.current].chose = true;
        Ok(())
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
        let mut text = String::new();
        for path in paths {
            if self.libraries.contains(&path) {
                continue;
            }
            let opened = File::open(&path).map_err(|reason| LoadError::Companion {
                file: self.file.to_owned(),
                place: format!("line {} (mtllib)", line.number),
                needed: path.clone(),
                reason,
                remedy: "put it there, or delete that line and give the materials in the scene file",
            })?;
            text += &mtl::cleaned(&path, opened, &mut self.notes)?;
            self.libraries.insert(path);
        }
        let library = tobj::load_mtl_buf(&mut text.as_bytes())
            .map_err(|reason| self.invalid(line, reason.to_string()))?;
        self.given.extend(library.1.keys().cloned());
        self.give(library);
        Ok(())
    }

    /// Has tobj ask for these materials.
    fn give(&mut self, library: Library) {
        self.library.set(library);
        self.text += "mtllib given\n";
    }

    fn place(&self, line: &Line) -> String {
        format!(
            "line {}, object {}",
            line.number, self.objects[self.current].name
        )
    }

    fn invalid(&self, line: &Line, allowed: impl Into<String>) -> LoadError {
        let found = format!("{} {}", line.keyword, line.rest);
        LoadError::invalid(self.file, self.place(line), found, allowed)
    }
}
