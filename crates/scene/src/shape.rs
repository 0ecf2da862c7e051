//! Geometry of the scene file: `[[shape]]`.

use crate::allowed::Allowed;
use crate::error::Error;
use crate::place::Located;
use crate::reader::{Field, unit};
use glam::DVec3;
use malus_geometry::shape;

/// One `[[shape]]`, as triangles.
#[derive(Debug)]
pub(crate) struct Shape {
    /// `shape.0`, as in `--set`.
    pub(crate) name: String,
    pub(crate) material: Located<String>,
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// Reads one `[[shape]]`, which is called `name` in messages.
    pub(crate) fn read(name: String, field: Field) -> Result<Self, Error> {
        #[derive(Clone)]
        enum Kind {
            Rectangle,
            Box,
            Disc,
            Sphere,
        }
        let mut table = field.table()?;
        let kind = table.require("kind", "\"rectangle\", \"box\", \"disc\" or \"sphere\"")?;
        let kind = kind.choice(&[
            ("rectangle", Kind::Rectangle),
            ("box", Kind::Box),
            ("disc", Kind::Disc),
            ("sphere", Kind::Sphere),
        ])?;
        let mut required = |key, expected: &str| table.require(key, expected);
        const POINT: &str = "[x, y, z] in metres";
        let (positions, triangles) = match kind {
            Kind::Rectangle => {
                let origin = required("origin", POINT)?.vector()?;
                let u = required("u", "[x, y, z], the first side")?.vector()?;
                let side = required("v", "[x, y, z], the second side")?;
                let v = side.vector()?;
                if unit(u.cross(v)).is_none() {
                    let allowed = "a side that spans an area together with u";
                    return Err(side.refused(allowed, format!(" ({v}, u is {u})")));
                }
                shape::rectangle(origin, u, v)
            }
            Kind::Box => {
                let min = required("min", POINT)?.vector()?;
                let corner = required("max", POINT)?;
                let max = corner.vector()?;
                if !max.cmpgt(min).all() {
                    let allowed = "greater than min in x, y and z";
                    return Err(corner.refused(allowed, format!(" ({max}, min is {min})")));
                }
                shape::cuboid(min, max, table.flag_or("inward", false)?)
            }
            Kind::Disc => {
                let centre = required("centre", POINT)?.vector()?;
                let normal = required("normal", "[x, y, z]")?.direction()?;
                let radius = required("radius", "metres")?.number(Allowed::Positive)?;
                let segments = match table.take("segments") {
                    Some(field) => field.whole(3, 100_000)?,
                    None => 128,
                };
                shape::disc(centre, normal, radius, segments as u32)
            }
            Kind::Sphere => {
                let centre = required("centre", POINT)?.vector()?;
                let radius = required("radius", "metres")?.number(Allowed::Positive)?;
                let inward = table.flag_or("inward", false)?;
                // 20 · 4⁹ = 5 million triangles.
                let subdivisions = match table.take("subdivisions") {
                    Some(field) => field.whole(0, 9)?,
                    None => 5,
                };
                shape::sphere(centre, radius, inward, subdivisions as u32)
            }
        };
        let material = table
            .require("material", "the name of a [material.…]")?
            .text()?;
        table.finish()?;
        Ok(Self {
            name,
            material,
            positions,
            triangles,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Node;

    fn read(text: &str) -> Result<Shape, String> {
        let node = Node::document(&"room.toml".into(), text).unwrap();
        Shape::read("shape.0".into(), Field::new("[[shape]]".into(), node))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn every_kind_has_its_triangles_and_defaults() {
        for (text, triangles) in [
            (
                "kind = \"rectangle\"\norigin = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 1, 0]",
                2,
            ),
            ("kind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]", 12),
            (
                "kind = \"disc\"\ncentre = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1",
                // A polygon of n corners is n − 2 triangles.
                126,
            ),
            (
                "kind = \"disc\"\ncentre = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\nsegments = 6",
                4,
            ),
            (
                "kind = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1",
                20 * 1024,
            ),
            (
                "kind = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1\nsubdivisions = 0",
                20,
            ),
        ] {
            let shape = read(&format!("{text}\nmaterial = \"plaster\"")).unwrap();
            assert_eq!(shape.triangles.len(), triangles, "{text}");
            assert_eq!(shape.material.value, "plaster");
        }
    }

    #[test]
    fn an_inward_box_shows_its_inside() {
        let text = "kind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"x\"\ninward = ";
        for (inward, sign) in [("true", -1.0), ("false", 1.0)] {
            let shape = read(&format!("{text}{inward}")).unwrap();
            for corners in &shape.triangles {
                let [a, b, c] = corners.map(|corner| shape.positions[corner as usize]);
                let outward = (a + b + c) / 3.0 - DVec3::splat(0.5);
                assert!((b - a).cross(c - a).dot(outward) * sign > 0.0);
            }
        }
    }

    #[test]
    fn what_is_wrong_is_told_where_it_stands() {
        for (text, place, expected) in [
            ("kind = \"cube\"", "1:8", "\"box\""),
            (
                "kind = \"box\"\nmin = [0, 0, 0]",
                "1:1",
                "lacks the key \"max\"",
            ),
            (
                "kind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 0]",
                "3:7",
                "greater than min",
            ),
            (
                "kind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]",
                "1:1",
                "lacks the key \"material\"",
            ),
            (
                "kind = \"rectangle\"\norigin = [0, 0, 0]\nu = [1, 0, 0]\nv = [2, 0, 0]",
                "4:5",
                "spans an area",
            ),
            (
                "kind = \"sphere\"\ncentre = [0, 0, 0]\nradius = -1",
                "3:10",
                "a number > 0",
            ),
            (
                "kind = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1\nsubdivisions = 30",
                "4:16",
                "from 0 to 9",
            ),
            (
                "kind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"x\"\nradius = 1",
                "5:1",
                "no key \"radius\"",
            ),
        ] {
            let error = read(text).unwrap_err();
            assert!(
                error.starts_with(&format!("room.toml:{place}: ")),
                "{error}"
            );
            assert!(error.contains(expected), "{error}");
        }
    }
}
