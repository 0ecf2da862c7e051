//! Points from a file: Radiance's lines of `x y z nx ny nz`.

use super::SensorPoint;
use crate::error::Error;
use crate::place::{Located, Place};
use crate::reader::unit;
use glam::DVec3;
use std::path::Path;
use std::sync::Arc;

/// Reads the points of `file`, relative to `folder`. A line of three numbers takes `normal`, and is an error
/// without one; blank lines and what follows a `#` are passed over.
pub(super) fn read(
    file: &Located<String>,
    folder: &Path,
    normal: Option<DVec3>,
) -> Result<Vec<SensorPoint>, Error> {
    let path = folder.join(&file.value);
    let shown: Arc<str> = path.display().to_string().into();
    let failed = |reason: String| Error::Conflict {
        at: file.at.to_string(),
        reason: format!("{shown}: {reason}"),
    };
    if path.is_dir() {
        return Err(failed("is a directory, not a file of points".into()));
    }
    let bytes = std::fs::read(&path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => failed("there is no such file".into()),
        _ => failed(format!("cannot be read: {error}")),
    })?;
    // Comments may be in any encoding; numbers are ASCII in all of them.
    let text = String::from_utf8_lossy(&bytes);
    let mut points = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or("").trim();
        if content.is_empty() {
            continue;
        }
        let at = Place::File {
            file: Arc::clone(&shown),
            line: index + 1,
            column: line.chars().take_while(|c| c.is_whitespace()).count() + 1,
        };
        points.push(point(content, normal).map_err(|allowed| Error::BadValue {
            at: at.to_string(),
            key: "a point".into(),
            found: format!("{content:?}"),
            allowed,
            hint: String::new(),
        })?);
    }
    if points.is_empty() {
        return Err(failed("there is no point in it".into()));
    }
    Ok(points)
}

fn point(line: &str, normal: Option<DVec3>) -> Result<SensorPoint, String> {
    let number = |word: &str| word.parse::<f64>().ok().filter(|n| n.is_finite());
    let numbers: Option<Vec<f64>> = line.split_whitespace().map(number).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => normal
            .map(|normal| SensorPoint::new(DVec3::new(x, y, z), normal))
            .ok_or_else(|| {
                "x y z nx ny nz with the direction looked in, since the sensor gives no direction for all".into()
            }),
        Some(&[x, y, z, nx, ny, nz]) => unit(DVec3::new(nx, ny, nz))
            .map(|normal| SensorPoint::new(DVec3::new(x, y, z), normal))
            .ok_or_else(|| "x y z nx ny nz with a normal that is not zero".into()),
        _ => Err("three finite numbers x y z, or six: x y z nx ny nz".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &[u8]) -> Result<Vec<SensorPoint>, String> {
        file_with(text, Some(DVec3::Z))
    }

    fn file_with(text: &[u8], normal: Option<DVec3>) -> Result<Vec<SensorPoint>, String> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("desk.pts"), text).unwrap();
        let name = Located {
            value: "desk.pts".to_owned(),
            at: Place::Override("file".into()),
        };
        read(&name, folder.path(), normal).map_err(|error| error.to_string())
    }

    #[test]
    fn the_lines_normals_win_over_the_given_one() {
        let points = file(b"# desk\n0.5 1 0.75  0 0 -2\r\n\n1 1 0.75 # here\n").unwrap();
        assert_eq!(points.len(), 2);
        assert_eq!(points[0].position, DVec3::new(0.5, 1.0, 0.75));
        assert_eq!(points[0].normal, DVec3::NEG_Z);
        assert_eq!(points[1].normal, DVec3::Z);
    }

    #[test]
    fn without_a_normal_every_line_has_to_give_one() {
        let points = file_with(b"1 2 3 0 3 0\n", None).unwrap();
        assert_eq!(points[0].normal, DVec3::Y);
        let error = file_with(b"1 2 3 0 3 0\n1 2 3\n", None).unwrap_err();
        assert!(
            error.contains("desk.pts:2:1: ") && error.contains("the direction looked in"),
            "{error}"
        );
    }

    #[test]
    fn a_bad_line_is_located() {
        for line in ["1 2", "1 2 x", "1 2 nan", "1 2 3 0 0 0", "1 2 3 4", "1,2,3"] {
            let error = file(format!("0 0 0 0 0 1\n  {line}\n").as_bytes()).unwrap_err();
            assert!(
                error.contains("desk.pts:2:3: ") && error.contains(line),
                "{error}"
            );
        }
    }

    #[test]
    fn an_empty_file_and_an_absent_one_are_errors_at_the_scene_file() {
        assert!(file(b"# nothing\n").unwrap_err().contains("no point"));
        let name = Located {
            value: "none.pts".to_owned(),
            at: Place::Override("sensor.0.file=none.pts".into()),
        };
        let error = read(&name, Path::new("."), Some(DVec3::Z))
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("--set sensor.0.file=none.pts: "),
            "{error}"
        );
        assert!(error.contains("no such file"), "{error}");
    }

    #[test]
    fn a_comment_in_another_encoding_is_no_error() {
        assert_eq!(file(b"1 2 3 # B\xfcro\n").unwrap().len(), 1);
    }
}
