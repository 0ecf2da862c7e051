//! Wavefront OBJ.
//!
//! Read line by line: so an error names its line, `usemtl` of an undefined material keeps its name, and a face
//! costs its indices only. (The crate tobj loses the first two and takes some 100 bytes a face.)

mod group;
mod library;

#[cfg(test)]
mod traps;

use super::polygon::Clipper;
use super::text::{Line, Lines, words};
use super::{LoadError, Model, Placement};
use glam::{DAffine3, DVec3};
use group::Groups;
use library::Library;
use std::fs::File;
use std::path::Path;

/// Reads an OBJ file and its material libraries.
///
/// An `o` begins an object. So does a `g` as long as the file has had no `o`. Vertex normals and texture
/// coordinates are passed over unread.
pub(super) fn read(file: &Path, placement: &Placement) -> Result<Model, LoadError> {
    let opened = File::open(file).map_err(|reason| LoadError::unreadable(file, reason))?;
    let mut reader = Reader {
        file,
        placement: placement.transform(),
        positions: Vec::new(),
        groups: Groups::new(file),
        library: Library::new(file),
        clipper: Clipper::new(),
        face: Vec::new(),
        corners: Vec::new(),
        ignored: Vec::new(),
        ragged: Tally::default(),
    };
    Lines::of(file, opened).visit(|line| reader.line(&line))?;
    Ok(reader.finish(placement))
}

struct Reader<'a> {
    file: &'a Path,
    placement: DAffine3,
    /// All vertices so far, in the world.
    positions: Vec<DVec3>,
    groups: Groups,
    library: Library<'a>,
    clipper: Clipper,
    /// Vertices of the present face, by index and by place.
    face: Vec<u32>,
    corners: Vec<DVec3>,
    /// Elements that are no faces, by keyword.
    ignored: Vec<(String, Tally)>,
    /// Polygons that cross themselves, have no area or fewer than three corners.
    ragged: Tally,
}

/// How often something occurred, and the line of the first time.
#[derive(Default)]
struct Tally {
    count: usize,
    first: u64,
}

impl Tally {
    fn add(&mut self, line: u64) {
        if self.count == 0 {
            self.first = line;
        }
        self.count += 1;
    }
}

impl Reader<'_> {
    fn line(&mut self, line: &Line) -> Result<(), LoadError> {
        match line.keyword {
            "v" => self.vertex(line)?,
            "f" => self.face(line)?,
            "o" => self.groups.begin_object(line.rest),
            "g" => self.groups.begin_group(line.rest),
            "usemtl" => {
                let material = self.library.material(line);
                self.groups.choose(material);
            }
            "mtllib" => self.library.read(line)?,
            "l" | "p" | "curv" | "curv2" | "surf" => {
                let known = self.ignored.iter().position(|i| i.0 == line.keyword);
                let index = known.unwrap_or_else(|| {
                    self.ignored
                        .push((line.keyword.to_owned(), Tally::default()));
                    self.ignored.len() - 1
                });
                self.ignored[index].1.add(line.number);
            }
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, line: &Line) -> Result<(), LoadError> {
        let mut found = [f64::NAN; 3];
        let mut words = words(line.rest);
        for value in &mut found {
            *value = words
                .next()
                .and_then(|word| word.parse().ok())
                .ok_or_else(|| self.invalid(line, "a vertex has three numbers"))?;
        }
        let position = self.placement.transform_point3(DVec3::from_array(found));
        if !position.is_finite() {
            return Err(LoadError::NotFinite {
                file: self.file.to_owned(),
                place: format!(
                    "line {}, object {}",
                    line.number,
                    self.groups.current_name()
                ),
                vertex: self.positions.len() + 1,
                found,
            });
        }
        self.positions.push(position);
        Ok(())
    }

    fn face(&mut self, line: &Line) -> Result<(), LoadError> {
        self.face.clear();
        for word in words(line.rest) {
            let vertex = self.corner(line, word)?;
            self.face.push(vertex);
        }
        if self.face.len() < 3 {
            self.ragged.add(line.number);
            return Ok(());
        }
        self.corners.clear();
        self.corners
            .extend(self.face.iter().map(|&v| self.positions[v as usize]));
        let clipped = self.clipper.clip(&self.corners);
        if !clipped.simple {
            self.ragged.add(line.number);
        }
        let face = &self.face;
        self.groups.add(
            clipped
                .triangles
                .iter()
                .map(|t| t.map(|corner| face[corner as usize])),
        );
        Ok(())
    }

    /// The vertex of one corner, `v`, `v/vt`, `v//vn` or `v/vt/vn`: counted from 1, or back from −1.
    fn corner(&self, line: &Line, word: &str) -> Result<u32, LoadError> {
        let number = word.split('/').next().unwrap_or_default();
        let index: i64 = number
            .parse()
            .map_err(|_| self.invalid(line, "a face has vertex numbers such as 7, 7/1 or 7/1/3"))?;
        let count = self.positions.len();
        let place = if index < 0 {
            usize::try_from(index.unsigned_abs())
                .ok()
                .and_then(|back| count.checked_sub(back))
        } else {
            usize::try_from(index).ok().and_then(|i| i.checked_sub(1))
        };
        place
            .filter(|&p| p < count)
            .and_then(|p| u32::try_from(p).ok())
            .ok_or_else(|| LoadError::Index {
                file: self.file.to_owned(),
                place: format!(
                    "line {}, object {}",
                    line.number,
                    self.groups.current_name()
                ),
                index,
                count,
            })
    }

    fn invalid(&self, line: &Line, allowed: &str) -> LoadError {
        LoadError::invalid(
            self.file,
            format!(
                "line {}, object {}",
                line.number,
                self.groups.current_name()
            ),
            format!("{} {}", line.keyword, line.rest),
            allowed,
        )
    }

    fn finish(self, placement: &Placement) -> Model {
        let mut notes = Vec::new();
        for (keyword, tally) in &self.ignored {
            notes.push(format!(
                "{} {keyword} elements (first in line {}) are no surfaces and ignored",
                tally.count, tally.first
            ));
        }
        if self.ragged.count > 0 {
            notes.push(format!(
                "{} faces (first in line {}) cross themselves or have no area: their triangles may not be what was meant",
                self.ragged.count, self.ragged.first
            ));
        }
        // OBJ has no local axes; an object's are the file's, in the world's directions.
        let frame = placement.transform() * DAffine3::from_mat3(placement.up.turn().transpose());
        let materials = self.library.finish(&mut notes);
        let objects = self
            .groups
            .finish(&self.positions, frame, &materials, &mut notes);
        Model {
            objects,
            materials,
            lamps: Vec::new(),
            notes,
        }
    }
}
