//! Sensors of the scene file.

use super::aim::{Aim, aim, frame};
use super::{
    Frame, Layout, Quantity, Sensor, SensorPoint, along, cell_centres, default_axis, faces, name,
    points_file,
};
use crate::allowed::Allowed;
use crate::error::Error;
use crate::place::Located;
use crate::reader::{Field, Reader, unit};
use glam::DVec3;
use malus_geometry::load::Object;
use std::path::Path;

/// The largest number of cells or points along one direction.
const MOST: u64 = 10_000;

/// One `[[sensor]]`; where it lies on mesh objects they are still to be found.
#[derive(Debug)]
pub(crate) struct Described {
    pub(crate) name: Located<String>,
    frame: Frame,
    axis: Option<Located<DVec3>>,
    aim: Aim,
    place: Where,
}

/// Where the points of a sensor are.
#[derive(Debug)]
enum Where {
    Given(Vec<SensorPoint>, Layout),
    Objects {
        pattern: Located<String>,
        spacing: Option<f64>,
    },
}

impl Described {
    /// Reads one `[[sensor]]`; paths are relative to `folder`.
    pub(crate) fn read(field: Field, folder: &Path) -> Result<Self, Error> {
        let mut table = field.table()?;
        let name = table.require("name", "a string that can name a file")?;
        let name = name::checked(name, "[[sensor]] name")?;
        let aim = aim(&mut table)?;
        let place = place(&mut table, &aim, folder)?;
        let frame = frame(table.take("frame"), aim.quantity)?;
        let axis = match table.take("axis") {
            Some(field) => Some(Located {
                value: field.direction()?,
                at: field.at().clone(),
            }),
            None => None,
        };
        table.finish()?;
        Ok(Self {
            name,
            frame,
            axis,
            aim,
            place,
        })
    }

    /// Glob for the names of the mesh objects that the sensor lies on.
    pub(crate) fn objects(&self) -> Option<&Located<String>> {
        match &self.place {
            Where::Objects { pattern, .. } => Some(pattern),
            Where::Given(..) => None,
        }
    }

    /// The sensor, on these `objects` of mesh files where it lies on any.
    pub(crate) fn placed(
        self,
        objects: &[&Object],
        warnings: &mut Vec<String>,
    ) -> Result<Sensor, Error> {
        let (points, layout) = match self.place {
            Where::Given(points, layout) => (points, layout),
            Where::Objects { pattern, spacing } => {
                let mut all = Vec::new();
                let mut layouts = Vec::new();
                for object in objects {
                    let found = faces::points(object, spacing);
                    let (points, layout) = found.map_err(|reason| Error::Conflict {
                        at: pattern.at.to_string(),
                        reason: format!("object {:?} {reason}", object.name),
                    })?;
                    all.extend(points);
                    layouts.push(layout);
                }
                if let Some(direction) = self.aim.direction {
                    all.iter_mut().for_each(|point| point.normal = direction);
                }
                let layout = match layouts.len() {
                    1 => layouts.remove(0),
                    _ => Layout::Points,
                };
                (all, layout)
            }
        };
        let along_u = match &layout {
            Layout::Grid { u, .. } => unit(*u),
            _ => None,
        };
        if let Some(axis) = &self.axis
            && points.iter().any(|point| along(axis.value, point.normal))
        {
            let why = match self.aim.quantity {
                Quantity::Irradiance => {
                    "along its normal: light from straight above has no x axis there"
                }
                Quantity::Radiance => {
                    "along the direction it looks in: another x axis takes its place"
                }
            };
            warnings.push(format!(
                "{}: the axis of sensor {:?} lies {why}",
                axis.at, self.name.value
            ));
        }
        let axis = self.axis.map(|axis| axis.value);
        Ok(Sensor {
            name: self.name.value,
            quantity: self.aim.quantity,
            frame: self.frame,
            axis: axis.unwrap_or_else(|| default_axis(along_u, &points)),
            points,
            layout,
        })
    }
}

/// Reads the one key that says where the points are.
fn place(table: &mut Reader, aim: &Aim, folder: &Path) -> Result<Where, Error> {
    const KEYS: [&str; 5] = ["grid", "points", "line", "file", "mesh"];
    let spacing = table.take("spacing");
    let mut given: Vec<(&str, Field)> = KEYS
        .iter()
        .filter_map(|key| table.take(key).map(|field| (*key, field)))
        .collect();
    if given.len() > 1 {
        return Err(Error::Conflict {
            at: given[1].1.at().to_string(),
            reason: format!(
                "a sensor is either {} or {}, not both; make two of them",
                given[0].0, given[1].0
            ),
        });
    }
    let Some((key, field)) = given.pop() else {
        let expected = "or one of points, line, file and mesh: where the sensor's points are";
        return Err(table
            .require("grid", expected)
            .err()
            .unwrap_or_else(|| Error::Conflict {
                at: table.at().to_string(),
                reason: expected.into(),
            }));
    };
    if let Some(spacing) = spacing.as_ref().filter(|_| key != "mesh") {
        return Err(Error::Conflict {
            at: spacing.at().to_string(),
            reason: format!("spacing goes with mesh, not with {key}"),
        });
    }
    let radiance = aim.quantity == Quantity::Radiance;
    if radiance && aim.direction.is_none() && key != "file" {
        let expected = "[x, y, z], where the sensor looks";
        table.require("direction", expected)?;
    }
    let normal = aim.direction.unwrap_or(DVec3::Z);
    Ok(match key {
        "grid" => grid(field, normal)?,
        "points" => points(field, normal)?,
        "line" => line(field, normal)?,
        "file" => Where::Given(
            points_file::read(
                &field.text()?,
                folder,
                aim.direction.or((!radiance).then_some(DVec3::Z)),
            )?,
            Layout::Points,
        ),
        _ => Where::Objects {
            pattern: field.text()?,
            spacing: spacing
                .map(|field| field.number(Allowed::Positive))
                .transpose()?,
        },
    })
}

fn grid(field: Field, normal: DVec3) -> Result<Where, Error> {
    let mut table = field.table()?;
    let origin = table.require("origin", "[x, y, z], a corner")?.vector()?;
    let u = table.require("u", "[x, y, z], the first side")?.vector()?;
    let v = table.require("v", "[x, y, z], the second side")?;
    let counts = table.require("counts", "[cells along u, cells along v]")?;
    let side = v.vector()?;
    if unit(u).zip(unit(side)).is_none_or(|(u, v)| along(u, v)) {
        return Err(v.refused(
            "a side that spans an area together with u",
            format!(" ({side}, u is {u})"),
        ));
    }
    let at = counts.at().clone();
    let counts: Vec<u64> = counts
        .list()?
        .iter()
        .map(|count| count.whole(1, MOST))
        .collect::<Result<_, _>>()?;
    let &[along_u, along_v] = counts.as_slice() else {
        return Err(Error::BadValue {
            at: at.to_string(),
            key: "[[sensor]] grid counts".into(),
            found: format!("a list of {}", counts.len()),
            allowed: "a list of 2 whole numbers".into(),
            hint: String::new(),
        });
    };
    if along_u * along_v > 10_000_000 {
        return Err(Error::Conflict {
            at: at.to_string(),
            reason: "a grid of more than ten million cells".into(),
        });
    }
    table.finish()?;
    let counts = [along_u as usize, along_v as usize];
    let points = cell_centres(origin, u, side, counts, normal);
    let layout = Layout::Grid {
        origin,
        u,
        v: side,
        counts,
    };
    Ok(Where::Given(points, layout))
}

fn points(field: Field, normal: DVec3) -> Result<Where, Error> {
    let empty = field.refused("a list of at least one point [x, y, z]", String::new());
    let points: Vec<SensorPoint> = field
        .list()?
        .iter()
        .map(|point| Ok(SensorPoint::new(point.vector()?, normal)))
        .collect::<Result<_, Error>>()?;
    if points.is_empty() {
        return Err(empty);
    }
    Ok(Where::Given(points, Layout::Points))
}

fn line(field: Field, normal: DVec3) -> Result<Where, Error> {
    let mut table = field.table()?;
    let from = table
        .require("from", "[x, y, z], the first point")?
        .vector()?;
    let end = table.require("to", "[x, y, z], the last point")?;
    let to = end.vector()?;
    let count = table
        .require("count", "the number of points, both ends included")?
        .whole(2, MOST * MOST / 10)?;
    table.finish()?;
    if unit(to - from).is_none() {
        return Err(end.refused("another point than from", String::new()));
    }
    let points = (0..count)
        .map(|index| {
            let share = index as f64 / (count - 1) as f64;
            // Both ends are met exactly.
            let position = if index + 1 == count {
                to
            } else {
                from + share * (to - from)
            };
            SensorPoint::new(position, normal)
        })
        .collect();
    Ok(Where::Given(points, Layout::Line))
}

#[cfg(test)]
mod tests;
