//! Sensors from objects of a mesh file: Empties and meshes marked by a custom property or a name.

use super::{Frame, Layout, Quantity, Sensor, SensorPoint, cell_centres, default_axis, faces};
use crate::properties::{Custom, Marker};
use crate::reader::unit;
use glam::DVec3;
use malus_geometry::load::Object;

/// Cells along each side of an Empty's grid, where it does not say.
const CELLS: usize = 9;

/// What an object stands for as a sensor; `None` if it is none.
pub(crate) fn marked(object: &Object, custom: &Custom) -> Option<Marker> {
    let by_name = || {
        let marker = if object.parts.is_empty() {
            Marker::Grid
        } else {
            Marker::Mesh
        };
        object.name.starts_with("SENSOR_").then_some(marker)
    };
    custom.sensor.or_else(by_name)
}

/// The sensor that an object stands for, called `name`. The error is what the object lacks.
pub(crate) fn sensor(
    name: String,
    object: &Object,
    custom: &Custom,
    marker: Marker,
) -> Result<Sensor, String> {
    let (points, layout, u) = match marker {
        Marker::Grid => grid(object, custom)?,
        Marker::Point => {
            let normal = normal(object).ok_or("has no local Z, so no normal: its scale is zero")?;
            let point = SensorPoint::new(object.frame.translation, normal);
            (vec![point], Layout::Points, None)
        }
        Marker::Mesh => {
            let (points, layout) = faces::points(object, None)?;
            (points, layout, None)
        }
    };
    Ok(Sensor {
        name,
        quantity: Quantity::Irradiance,
        frame: Frame::Incidence,
        axis: default_axis(u, &points),
        points,
        layout,
    })
}

/// An Empty's local XY square from −1 to 1, its scale included.
fn grid(
    object: &Object,
    custom: &Custom,
) -> Result<(Vec<SensorPoint>, Layout, Option<DVec3>), String> {
    if !object.parts.is_empty() {
        return Err("is a mesh, but malus_sensor = \"grid\" needs an Empty; \"mesh\" measures at the faces' centres".into());
    }
    let origin = object.frame.transform_point3(DVec3::new(-1.0, -1.0, 0.0));
    let u = object.frame.transform_vector3(DVec3::X * 2.0);
    let v = object.frame.transform_vector3(DVec3::Y * 2.0);
    let (Some(along_u), Some(_)) = (unit(u), unit(u.cross(v))) else {
        return Err("spans no area: its scale along local X or Y is zero".into());
    };
    let counts = [custom.nx.unwrap_or(CELLS), custom.ny.unwrap_or(CELLS)];
    let normal = normal(object)
        .or_else(|| unit(u.cross(v)))
        .unwrap_or(DVec3::Z);
    let layout = Layout::Grid {
        origin,
        u,
        v,
        counts,
    };
    Ok((
        cell_centres(origin, u, v, counts, normal),
        layout,
        Some(along_u),
    ))
}

fn normal(object: &Object) -> Option<DVec3> {
    unit(object.frame.transform_vector3(DVec3::Z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3};
    use malus_geometry::load::{Part, Properties};

    fn empty(name: &str, scale: DVec3) -> Object {
        Object {
            name: name.into(),
            properties: Properties::new(),
            parts: Vec::new(),
            frame: DAffine3 {
                matrix3: DMat3::from_diagonal(scale),
                translation: DVec3::new(3.0, 2.0, 0.8),
            },
        }
    }

    fn marker(kind: Marker) -> Custom {
        Custom {
            sensor: Some(kind),
            ..Custom::default()
        }
    }

    #[test]
    fn a_name_or_a_property_marks_a_sensor_and_the_property_goes_first() {
        let plain = Custom::default();
        let named = empty("SENSOR_Eye", DVec3::ONE);
        assert_eq!(marked(&named, &plain), Some(Marker::Grid));
        assert_eq!(marked(&named, &marker(Marker::Point)), Some(Marker::Point));
        assert_eq!(marked(&empty("Eye", DVec3::ONE), &plain), None);
    }

    #[test]
    fn an_empty_is_a_grid_over_its_scale() {
        let empty = empty("SENSOR_Workplane", DVec3::new(2.5, 1.5, 1.0));
        let sensor = sensor("w".into(), &empty, &Custom::default(), Marker::Grid).unwrap();
        assert_eq!(sensor.points.len(), 81);
        assert_eq!(sensor.axis, DVec3::X);
        let Layout::Grid { origin, u, v, .. } = sensor.layout else {
            panic!("an Empty is a grid")
        };
        assert_eq!(
            (origin, u, v),
            (DVec3::new(0.5, 0.5, 0.8), DVec3::X * 5.0, DVec3::Y * 3.0)
        );
        assert_eq!(sensor.points[0].normal, DVec3::Z);
    }

    #[test]
    fn an_empty_scaled_flat_keeps_a_normal() {
        let flat = empty("SENSOR_a", DVec3::new(1.0, 1.0, 0.0));
        let sensor = sensor("a".into(), &flat, &Custom::default(), Marker::Grid).unwrap();
        assert_eq!(sensor.points[0].normal, DVec3::Z);
    }

    #[test]
    fn an_empty_without_area_is_refused() {
        let thin = empty("SENSOR_a", DVec3::new(1.0, 0.0, 1.0));
        let error = sensor("a".into(), &thin, &Custom::default(), Marker::Grid).unwrap_err();
        assert!(error.contains("spans no area"), "{error}");
    }

    #[test]
    fn a_point_looks_along_local_z() {
        let mut eye = empty("SENSOR_Eye", DVec3::ONE);
        eye.frame.matrix3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);
        let sensor = sensor("e".into(), &eye, &Custom::default(), Marker::Point).unwrap();
        let expected = SensorPoint::new(DVec3::new(3.0, 2.0, 0.8), DVec3::Y);
        assert_eq!(sensor.points, [expected]);
    }

    #[test]
    fn a_mesh_is_no_grid_and_an_empty_no_mesh() {
        let mut board = empty("Board", DVec3::ONE);
        let error = sensor("b".into(), &board, &Custom::default(), Marker::Mesh).unwrap_err();
        assert!(error.contains("no faces"), "{error}");
        board.parts.push(Part {
            material: None,
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            faces: vec![0],
        });
        let error = sensor("b".into(), &board, &Custom::default(), Marker::Grid).unwrap_err();
        assert!(error.contains("needs an Empty"), "{error}");
    }
}
