//! The scene file as written, every table read and checked by itself.

use crate::Unit;
use crate::allowed::Allowed;
use crate::camera::Camera;
use crate::document::Node;
use crate::error::Error;
use crate::material::library::Library;
use crate::overrides::Override;
use crate::place::Located;
use crate::reader::{Field, Reader, WHOLE};
use crate::sensor::described::Described;
use crate::settings::Settings;
use crate::shape::Shape;
use crate::source::Source;
use glam::DVec3;
use malus_geometry::load::{Placement, Up};
use std::path::{Path, PathBuf};

/// A scene file.
pub(crate) struct SceneFile {
    pub(crate) name: String,
    pub(crate) unit: Unit,
    pub(crate) meshes: Vec<MeshFile>,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) library: Library,
    pub(crate) sources: Vec<Source>,
    pub(crate) sensors: Vec<Described>,
    pub(crate) cameras: Vec<Located<Camera>>,
    pub(crate) settings: Settings,
}

/// One `[[mesh]]`.
pub(crate) struct MeshFile {
    /// The file as written.
    pub(crate) file: Located<String>,
    /// The file from where the program runs.
    pub(crate) path: PathBuf,
    pub(crate) placement: Placement,
    /// Whether the lamps in the file count.
    pub(crate) lights: bool,
}

impl SceneFile {
    /// Reads the scene file at `path` with `overrides` in place of its own values.
    pub(crate) fn read(path: &Path, overrides: &[Override]) -> Result<Self, Error> {
        let mut document = Node::read(path)?;
        for entry in overrides {
            entry.apply(&mut document)?;
        }
        Self::typed(document, path)
    }

    /// Reads a parsed document that stands at `path`.
    pub(crate) fn typed(document: Node, path: &Path) -> Result<Self, Error> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut table = Reader::new(WHOLE.into(), document)?;
        // All keys are asked for first, so that a misspelt table is told before what is in the others.
        let scene = table.take("scene");
        let meshes = table.take("mesh");
        let shapes = table.take("shape");
        let materials = table.take("material");
        let sources = table.take("source");
        let sensors = table.take("sensor");
        let cameras = table.take("camera");
        let run = table.take("run");
        table.finish()?;

        let (name, unit) = header(scene)?;
        let stem = || path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self {
            name: name.unwrap_or_else(|| stem().into_owned()),
            unit,
            meshes: each(meshes, "mesh", |_, field| mesh(field, folder))?,
            shapes: each(shapes, "shape", Shape::read)?,
            library: Library::read(materials)?,
            sources: each(sources, "source", Source::read)?,
            sensors: each(sensors, "sensor", |_, field| Described::read(field, folder))?,
            cameras: each(cameras, "camera", |_, field| Camera::read(field))?,
            settings: Settings::read(run)?,
        })
    }
}

/// Reads every table of a list, each with its name as in `--set`: `shape.0`. All faulty tables are told at once.
fn each<T>(
    field: Option<Field>,
    kind: &str,
    read: impl Fn(String, Field) -> Result<T, Error>,
) -> Result<Vec<T>, Error> {
    let Some(field) = field else {
        return Ok(Vec::new());
    };
    let items = field.tables(kind)?;
    let mut good = Vec::with_capacity(items.len());
    let mut errors = Vec::new();
    for (index, item) in items.into_iter().enumerate() {
        match read(format!("{kind}.{index}"), item) {
            Ok(value) => good.push(value),
            Err(error) => errors.push(error),
        }
    }
    Error::all(errors).map(|()| good)
}

fn header(scene: Option<Field>) -> Result<(Option<String>, Unit), Error> {
    let Some(field) = scene else {
        return Ok((None, Unit::Lumen));
    };
    let mut table = field.table()?;
    let name = table.take("name").map(Field::text).transpose()?;
    let unit = match table.take("unit") {
        Some(field) => field.choice(&[("lm", Unit::Lumen), ("W", Unit::Watt)])?,
        None => Unit::Lumen,
    };
    table.finish()?;
    Ok((name.map(|name| name.value), unit))
}

fn mesh(field: Field, folder: &Path) -> Result<MeshFile, Error> {
    let mut table = field.table()?;
    let file = table.require("file", "the path of a .gltf, .glb or .obj file")?;
    let file = file.text()?;
    let scale = table.number_or("scale", Allowed::Positive, 1.0)?;
    let up = match table.take("up") {
        Some(field) => field.choice(&[("y", Up::Y), ("z", Up::Z)])?,
        None => Up::Y,
    };
    let translate = match table.take("translate") {
        Some(field) => field.vector()?,
        None => DVec3::ZERO,
    };
    let lights = table.flag_or("lights", true)?;
    table.finish()?;
    Ok(MeshFile {
        path: folder.join(&file.value),
        file,
        placement: Placement {
            scale,
            up,
            translate,
        },
        lights,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<SceneFile, String> {
        let document = Node::document(&"scenes/room.toml".into(), text).unwrap();
        SceneFile::typed(document, Path::new("scenes/room.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn an_empty_file_has_defaults_throughout() {
        let file = read("").unwrap();
        assert_eq!((file.name.as_str(), file.unit), ("room", Unit::Lumen));
        assert!(file.meshes.is_empty() && file.sensors.is_empty());
    }

    #[test]
    fn a_mesh_lies_relative_to_the_scene_file() {
        let text = "[[mesh]]\nfile = \"meshes/room.glb\"\nscale = 0.001\nup = \"z\"\ntranslate = [1, 2, 3]";
        let file = read(text).unwrap();
        assert_eq!(file.meshes[0].path, Path::new("scenes/meshes/room.glb"));
        let expected = Placement {
            scale: 0.001,
            up: Up::Z,
            translate: DVec3::new(1.0, 2.0, 3.0),
        };
        assert_eq!(file.meshes[0].placement, expected);
    }

    #[test]
    fn what_is_wrong_is_told_where_it_stands() {
        for (text, place, expected) in [
            ("[materal.x]\nrho = 1", "1:2", "the nearest is \"material\""),
            ("[scene]\nunits = \"lm\"", "2:1", "the nearest is \"unit\""),
            ("[scene]\nunit = \"lx\"", "2:8", "\"lm\" or \"W\""),
            ("[mesh]\nfile = \"x.glb\"", "1:1", "[[mesh]]"),
            ("[[mesh]]\nfile = 3", "2:8", "a string, found 3"),
            (
                "[[mesh]]\nfile = \"x.glb\"\nscale = 0",
                "3:9",
                "a number > 0",
            ),
            (
                "[[mesh]]\nfile = \"x.glb\"\nup = \"x\"",
                "3:6",
                "\"y\" or \"z\"",
            ),
            ("[[mesh]]\nscale = 1", "1:1", "lacks the key \"file\""),
            ("[run]\nsample = 3", "2:1", "the nearest is \"samples\""),
            ("scene = 3", "1:9", "a table, found 3"),
        ] {
            let error = read(text).err().unwrap();
            assert!(
                error.starts_with(&format!("scenes/room.toml:{place}: ")),
                "{error}"
            );
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn every_faulty_table_of_a_list_is_told_at_once() {
        let error = read("[[shape]]\n[[shape]]\nkind = \"cube\"").err().unwrap();
        assert_eq!(error.lines().count(), 2, "{error}");
        assert!(
            error.contains("room.toml:1:1") && error.contains("room.toml:3:8"),
            "{error}"
        );
    }
}
