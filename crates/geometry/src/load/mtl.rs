//! Wavefront MTL: the materials of an OBJ file.

use super::text::{Line, Lines, words};
use super::{LoadError, Look};
use std::fs::File;
use std::path::Path;

/// The materials of a file in its order.
///
/// One number instead of three is a grey, as the format allows; fields without a meaning here are passed over.
pub(super) fn read(
    file: &Path,
    opened: File,
    notes: &mut Vec<String>,
) -> Result<Vec<(String, Look)>, LoadError> {
    let mut materials = Vec::new();
    Lines::of(file, opened).visit(|line| {
        if line.keyword == "newmtl" {
            materials.push((line.rest.to_owned(), unsaid()));
        } else if let Some((name, look)) = materials.last_mut() {
            set(file, &line, name, look, notes)?;
        }
        Ok(())
    })?;
    Ok(materials)
}

/// A look of which the file says nothing.
pub(super) fn unsaid() -> Look {
    Look::Mtl {
        kd: None,
        ks: None,
        ke: None,
        ni: None,
        d: None,
        tf: None,
        illum: None,
        textured: false,
        pr: None,
        pm: None,
    }
}

fn set(
    file: &Path,
    line: &Line,
    name: &str,
    look: &mut Look,
    notes: &mut Vec<String>,
) -> Result<(), LoadError> {
    let Look::Mtl {
        kd,
        ks,
        ke,
        ni,
        d,
        tf,
        illum,
        textured,
        pr,
        pm,
    } = look
    else {
        return Ok(());
    };
    match line.keyword {
        "Kd" => *kd = color(file, line, name, notes)?,
        "Ks" => *ks = color(file, line, name, notes)?,
        "Ke" => *ke = color(file, line, name, notes)?,
        "Tf" => *tf = color(file, line, name, notes)?,
        "Ni" => *ni = Some(number(file, line)?),
        "d" => *d = Some(number(file, line)?),
        "Tr" => *d = Some(1.0 - number(file, line)?),
        "Pr" => *pr = Some(number(file, line)?),
        "Pm" => *pm = Some(number(file, line)?),
        "illum" => {
            let value = number(file, line)?;
            *illum = (0..=10).find(|&model| f64::from(model).total_cmp(&value).is_eq());
            if illum.is_none() {
                return Err(invalid(file, line, "an illumination model is 0 to 10"));
            }
        }
        "map_Kd" => {
            *textured = true;
            notes.push(format!(
                "material {name}: its texture (map_Kd) is not read, its Kd stands"
            ));
        }
        "map_Ke" => notes.push(format!(
            "material {name}: its emission texture (map_Ke) is not read, its Ke stands"
        )),
        _ => {}
    }
    Ok(())
}

/// One number (a grey) or three; none, with a note, where the colour is a spectrum or in CIE XYZ.
fn color(
    file: &Path,
    line: &Line,
    name: &str,
    notes: &mut Vec<String>,
) -> Result<Option<[f64; 3]>, LoadError> {
    if let Some(kind @ ("spectral" | "xyz")) = words(line.rest).next() {
        notes.push(format!(
            "material {name}: its {} is given as {kind}, which is not read",
            line.keyword
        ));
        return Ok(None);
    }
    let allowed = "one finite number or three";
    let values = words(line.rest)
        .map(|word| finite(word).ok_or_else(|| invalid(file, line, allowed)))
        .collect::<Result<Vec<f64>, _>>()?;
    match values[..] {
        [grey] => Ok(Some([grey; 3])),
        [r, g, b] => Ok(Some([r, g, b])),
        _ => Err(invalid(file, line, allowed)),
    }
}

/// The last word as a number: options such as `d -halo 0.5` stand before it.
fn number(file: &Path, line: &Line) -> Result<f64, LoadError> {
    words(line.rest)
        .last()
        .and_then(finite)
        .ok_or_else(|| invalid(file, line, "a finite number"))
}

fn finite(word: &str) -> Option<f64> {
    word.parse().ok().filter(|value: &f64| value.is_finite())
}

fn invalid(file: &Path, line: &Line, allowed: &str) -> LoadError {
    LoadError::invalid(
        file,
        format!("line {}", line.number),
        format!("{} {}", line.keyword, line.rest),
        format!("allowed: {allowed}"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    type Read = (Vec<(String, Look)>, Vec<String>);

    fn materials(text: &[u8]) -> Result<Read, LoadError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.mtl");
        std::fs::write(&path, text).unwrap();
        let mut notes = Vec::new();
        let read = read(&path, File::open(&path).unwrap(), &mut notes)?;
        Ok((read, notes))
    }

    #[test]
    fn every_field_that_blender_writes_arrives() {
        let text =
            b"newmtl Wall\nKd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nKe 1 2 3\nNi 1.45\nd 0.75\nillum 3\n\
                     Pr 0.25\nPm 1\nTf 1 0.5 0\nmap_Kd wall.png\n";
        let (read, notes) = materials(text).unwrap();
        let look = Look::Mtl {
            kd: Some([0.1, 0.2, 0.3]),
            ks: Some([0.5; 3]),
            ke: Some([1.0, 2.0, 3.0]),
            ni: Some(1.45),
            d: Some(0.75),
            tf: Some([1.0, 0.5, 0.0]),
            illum: Some(3),
            textured: true,
            pr: Some(0.25),
            pm: Some(1.0),
        };
        assert_eq!(read, [("Wall".to_owned(), look)]);
        assert!(notes[0].contains("Wall") && notes[0].contains("map_Kd"));
    }

    #[test]
    fn one_number_is_a_grey_and_what_is_not_given_is_none() {
        let (read, _) = materials(b"newmtl A\nKd 0.5\nTr 0.25\nnewmtl B\n").unwrap();
        let Look::Mtl { kd, d, ni, .. } = read[0].1 else {
            panic!()
        };
        assert_eq!((kd, d, ni), (Some([0.5; 3]), Some(0.75), None));
        assert_eq!(read[1], ("B".to_owned(), unsaid()));
    }

    #[test]
    fn a_value_that_is_no_number_is_an_error_with_its_line() {
        for bad in [
            "Kd 0,5 0,5 0,5",
            "Kd 1 2",
            "Kd",
            "Ni",
            "Ni nan",
            "d inf",
            "illum 2.5",
            "illum 11",
        ] {
            let message = materials(format!("newmtl A\n\n{bad}\n").as_bytes())
                .unwrap_err()
                .to_string();
            assert!(
                message.contains("line 3") && message.contains(bad),
                "{message}"
            );
        }
    }

    #[test]
    fn a_spectrum_is_passed_over_with_a_note() {
        let (read, notes) = materials(b"newmtl A\nKd spectral a.rfl 1\n").unwrap();
        assert_eq!(read[0].1, unsaid());
        assert!(notes[0].contains("Kd") && notes[0].contains("spectral"));
    }
}
