//! Sensor points on the faces of a mesh object.

use super::lattice::lattice;
use super::{Layout, SensorPoint};
use crate::reader::unit;
use glam::DVec3;
use malus_geometry::load::Object;

/// Points of an object with their layout: the centres of its faces, or a lattice of `spacing` where that is given.
///
/// The error is what the object lacks.
pub(crate) fn points(
    object: &Object,
    spacing: Option<f64>,
) -> Result<(Vec<SensorPoint>, Layout), String> {
    let faces = faces(object);
    if faces.is_empty() {
        return Err("has no faces to measure at".into());
    }
    match spacing {
        Some(spacing) => lattice(&triangles(object), spacing),
        None => Ok((faces, Layout::Points)),
    }
}

/// Corners of all triangles of an object.
fn triangles(object: &Object) -> Vec<[DVec3; 3]> {
    let parts = object.parts.iter();
    parts
        .flat_map(|part| {
            let triangles = part.triangles.iter();
            triangles.map(|corners| corners.map(|corner| part.positions[corner as usize]))
        })
        .collect()
}

/// Centre of area and normal of each face, in the order of the file; faces without area are left out.
fn faces(object: &Object) -> Vec<SensorPoint> {
    let mut points = Vec::new();
    for part in &object.parts {
        let mut face = Face::default();
        let mut previous = None;
        for (corners, number) in part.triangles.iter().zip(&part.faces) {
            if previous != Some(number) {
                points.extend(std::mem::take(&mut face).point());
                previous = Some(number);
            }
            face.add(corners.map(|corner| part.positions[corner as usize]));
        }
        points.extend(face.point());
    }
    points
}

/// Sums over the triangles of one face.
#[derive(Default)]
struct Face {
    /// Sum of area × normal, in m².
    area: DVec3,
    /// Sum of |area| × centre, in m³, and of |area|.
    moment: DVec3,
    weight: f64,
}

impl Face {
    fn add(&mut self, [a, b, c]: [DVec3; 3]) {
        let area = 0.5 * (b - a).cross(c - a);
        let weight = area.length();
        self.area += area;
        self.moment += weight * (a + b + c) / 3.0;
        self.weight += weight;
    }

    fn point(self) -> Option<SensorPoint> {
        let normal = unit(self.area)?;
        (self.weight > 0.0).then(|| SensorPoint::new(self.moment / self.weight, normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;
    use malus_geometry::load::{Part, Properties};

    fn quads(faces: Vec<u32>) -> Object {
        let corners = [(0., 0.), (2., 0.), (2., 1.), (0., 1.)];
        Object {
            name: "SENSOR_Board".into(),
            properties: Properties::new(),
            parts: vec![Part {
                material: None,
                positions: corners
                    .iter()
                    .map(|&(x, y)| DVec3::new(x, y, 1.0))
                    .collect(),
                triangles: vec![[0, 1, 2], [0, 2, 3], [0, 0, 1]],
                faces,
            }],
            frame: DAffine3::IDENTITY,
        }
    }

    #[test]
    fn a_polygon_has_one_point_at_its_centre() {
        let (points, layout) = points(&quads(vec![0, 0, 1]), None).unwrap();
        assert_eq!(
            points,
            [SensorPoint::new(DVec3::new(1.0, 0.5, 1.0), DVec3::Z)]
        );
        assert_eq!(layout, Layout::Points);
    }

    #[test]
    fn triangles_have_one_point_each_and_degenerate_ones_none() {
        let (points, _) = points(&quads(vec![0, 1, 2]), None).unwrap();
        assert_eq!(points.len(), 2);
        let centre = DVec3::new(4.0 / 3.0, 1.0 / 3.0, 1.0);
        assert!((points[0].position - centre).length() < 1e-15);
    }

    #[test]
    fn an_empty_has_no_faces() {
        let mut empty = quads(vec![0, 1, 2]);
        empty.parts.clear();
        assert!(points(&empty, None).unwrap_err().contains("no faces"));
    }
}
