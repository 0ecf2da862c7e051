//! Cameras: where a picture is taken from.

use crate::allowed::Allowed;
use crate::error::Error;
use crate::place::Located;
use crate::reader::{Field, Reader, unit};
use crate::sensor::{along, name};
use glam::DVec3;

/// The largest number of picture elements along one side.
const MOST: u64 = 16_384;

/// A pinhole camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name, usable as a file name.
    pub name: String,
    /// Where it stands, in metres.
    pub position: DVec3,
    /// Where it looks, a unit vector.
    pub forward: DVec3,
    /// To the right of the picture, a unit vector perpendicular to `forward`.
    pub right: DVec3,
    /// Upwards in the picture, a unit vector perpendicular to both.
    pub up: DVec3,
    /// Angle across the picture's width in degrees, > 0 and < 180.
    pub fov_deg: f64,
    /// Picture elements across, 1 … 16384.
    pub width: u32,
    /// Picture elements from top to bottom, 1 … 16384. They are square.
    pub height: u32,
    /// Walks a picture element, ≥ 1.
    pub samples: u64,
}

impl Camera {
    /// Direction in which the camera looks at a point of its picture, a unit vector.
    ///
    /// `x` counts picture elements from the left edge, 0 … `width`, and `y` from the top edge, 0 … `height`; the
    /// centre of the first one is at (½, ½).
    #[must_use]
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        let half_width = 0.5 * f64::from(self.width);
        let half_height = 0.5 * f64::from(self.height);
        let scale = libm::tan(0.5 * self.fov_deg.to_radians()) / half_width;
        let across = scale * (x - half_width);
        let upwards = scale * (half_height - y);
        let ray = self.forward + across * self.right + upwards * self.up;
        ray / ray.length()
    }

    /// Reads one `[[camera]]`; the name keeps its place for messages about others of the same name.
    pub(crate) fn read(field: Field) -> Result<Located<Self>, Error> {
        let mut table = field.table()?;
        let name = table.require("name", "a string that can name a file")?;
        let name = name::checked(name, "[[camera]] name")?;
        let position = table.require("position", "[x, y, z], where the camera stands")?;
        let position = position.vector()?;
        let target = table.require("look_at", "[x, y, z], a point it looks at")?;
        let (forward, right) = view(position, &target, table.take("up"))?;
        let fov_deg = table.number_or("fov_deg", Allowed::View, 60.0)?;
        let camera = Self {
            name: name.value,
            position,
            forward,
            right,
            up: right.cross(forward),
            fov_deg,
            width: elements(&mut table, "width", 640)?,
            height: elements(&mut table, "height", 480)?,
            samples: match table.take("samples") {
                Some(field) => field.whole(1, u64::MAX)?,
                None => 64,
            },
        };
        table.finish()?;
        Ok(Located {
            value: camera,
            at: name.at,
        })
    }
}

/// Unit vectors forward and to the right.
fn view(position: DVec3, target: &Field, up: Option<Field>) -> Result<(DVec3, DVec3), Error> {
    let look_at = target.vector()?;
    let forward = unit(look_at - position)
        .ok_or_else(|| target.refused("another point than position", format!(" ({look_at})")))?;
    let vertical = up.as_ref().map_or(Ok(DVec3::Z), Field::direction)?;
    let right = unit(forward.cross(vertical)).filter(|_| !along(vertical, forward));
    let right = right.ok_or_else(|| match &up {
        Some(up) => up.refused(
            "a direction across the view",
            format!(" ({vertical}, and the camera looks along {forward})"),
        ),
        None => Error::Conflict {
            at: target.at().to_string(),
            reason: format!(
                "[[camera]] look_at lies straight above or below position (the camera looks along {forward}), and up is [0, 0, 1] where it is not given; give up, such as [0, 1, 0]"
            ),
        },
    })?;
    Ok((forward, right))
}

/// Takes a number of picture elements, or `default`.
fn elements(table: &mut Reader, key: &'static str, default: u32) -> Result<u32, Error> {
    match table.take(key) {
        // At most 16384, so it fits.
        Some(field) => Ok(field.whole(1, MOST)? as u32),
        None => Ok(default),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Node;

    const EYE: &str = "name = \"eye\"\nposition = [0, -4, 1]\nlook_at = [0, 2, 1]\n";

    fn read(text: &str) -> Result<Camera, String> {
        let node = Node::document(&"room.toml".into(), text).unwrap();
        let camera = Camera::read(Field::new("[[camera]]".into(), node));
        camera
            .map(|camera| camera.value)
            .map_err(|error| error.to_string())
    }

    fn near(found: DVec3, expected: DVec3) -> bool {
        (found - expected).length() < 1e-15
    }

    #[test]
    fn a_camera_has_defaults_for_its_picture() {
        let camera = read(EYE).unwrap();
        assert_eq!(
            (camera.width, camera.height, camera.samples),
            (640, 480, 64)
        );
        assert!((camera.fov_deg - 60.0).abs() < 1e-15);
        assert_eq!(
            (camera.forward, camera.right, camera.up),
            (DVec3::Y, DVec3::X, DVec3::Z)
        );
    }

    #[test]
    fn up_is_made_perpendicular_to_the_view() {
        let camera = read(&format!("{EYE}up = [0, 3, 4]")).unwrap();
        assert!(near(camera.up, DVec3::Z) && near(camera.right, DVec3::X));
        let camera = read(&EYE.replace("[0, 2, 1]", "[0, 0, 5]")).unwrap();
        assert!(near(
            camera.forward,
            DVec3::new(0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt())
        ));
        assert!(near(
            camera.up,
            DVec3::new(0.0, -(0.5_f64.sqrt()), 0.5_f64.sqrt())
        ));
    }

    #[test]
    fn a_camera_that_looks_down_needs_its_own_up() {
        let down = EYE.replace("[0, 2, 1]", "[0, -4, 0]");
        let error = read(&down).unwrap_err();
        assert!(
            error.starts_with("room.toml:3:11: ") && error.contains("give up"),
            "{error}"
        );
        let camera = read(&format!("{down}up = [0, 1, 0]")).unwrap();
        assert_eq!((camera.right, camera.up), (DVec3::X, DVec3::Y));
    }

    #[test]
    fn the_field_of_view_reaches_across_the_width_and_elements_are_square() {
        let camera = read(&format!("{EYE}fov_deg = 90\nwidth = 400\nheight = 200")).unwrap();
        let unit = |x: f64, z: f64| DVec3::new(x, 1.0, z).normalize();
        for (x, y, expected) in [
            (200.0, 100.0, DVec3::Y),
            (0.0, 100.0, unit(-1.0, 0.0)),
            (400.0, 100.0, unit(1.0, 0.0)),
            (200.0, 0.0, unit(0.0, 0.5)),
            (400.0, 200.0, unit(1.0, -0.5)),
        ] {
            let found = camera.direction(x, y);
            assert!((found - expected).length() < 1e-15, "{x}, {y}: {found}");
        }
    }

    #[test]
    fn what_is_wrong_is_told_where_it_stands() {
        for (from, to, place, expected) in [
            ("name = \"eye\"\n", "", "1:1", "lacks the key \"name\""),
            (
                "\"eye\"",
                "\"a/b\"",
                "1:8",
                "[[camera]] name must be a name without '/'",
            ),
            (
                "position = [0, -4, 1]\n",
                "",
                "1:1",
                "lacks the key \"position\"",
            ),
            (
                "look_at = [0, 2, 1]\n",
                "",
                "1:1",
                "lacks the key \"look_at\"",
            ),
            ("look_at", "lookat", "3:1", "the nearest is \"look_at\""),
            (
                "[0, 2, 1]",
                "[0, -4, 1]",
                "3:11",
                "another point than position",
            ),
            ("[0, 2, 1]", "[0, 2]", "3:11", "a list of 3 numbers"),
        ] {
            let error = read(&EYE.replace(from, to)).unwrap_err();
            assert!(
                error.starts_with(&format!("room.toml:{place}: ")),
                "{error}"
            );
            assert!(error.contains(expected), "{error}");
        }
        for (line, place, expected) in [
            ("up = [0, -2, 0]", "4:6", "a direction across the view"),
            ("up = [0, 0, 0]", "4:6", "a direction, not zero"),
            (
                "fov_deg = 180",
                "4:11",
                "an angle > 0 and < 180 degrees, found 180",
            ),
            (
                "fov_deg = 0",
                "4:11",
                "an angle > 0 and < 180 degrees, found 0",
            ),
            (
                "width = 0",
                "4:9",
                "a whole number from 1 to 16384, found 0",
            ),
            (
                "height = 16385",
                "4:10",
                "a whole number from 1 to 16384, found 16385",
            ),
            ("samples = 0", "4:11", "a whole number ≥ 1, found 0"),
            ("fov = 50", "4:1", "the nearest is \"fov_deg\""),
        ] {
            let error = read(&format!("{EYE}{line}")).unwrap_err();
            assert!(
                error.starts_with(&format!("room.toml:{place}: ")),
                "{error}"
            );
            assert!(error.contains(expected), "{error}");
        }
    }
}
