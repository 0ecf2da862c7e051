//! Wavefront MTL: the materials of an OBJ file.
//!
//! The crate tobj reads them, from a text that it can read: it panics at a colour of one number (a grey, as the
//! format allows), knows nothing of `Tr`, spectra or options before a number, and lets NaN pass.

use super::text::{Line, Lines, words};
use super::{LoadError, Look};
use std::fs::File;
use std::path::Path;

/// The text of a file as tobj reads it: the fields of [`Look::Mtl`] with their values checked, one a line.
pub(super) fn cleaned(
    file: &Path,
    opened: File,
    notes: &mut Vec<String>,
) -> Result<String, LoadError> {
    let mut text = String::new();
    let mut name = String::new();
    Lines::of(file, opened).visit(|line| {
        let (mut keyword, rest) = (line.keyword, line.rest);
        let value = match keyword {
            "newmtl" if rest.is_empty() => return Err(invalid(file, &line, "a name")),
            "newmtl" => {
                rest.clone_into(&mut name);
                rest.to_owned()
            }
            // Fields before the first material are nobody's.
            _ if name.is_empty() => return Ok(()),
            "Kd" | "Ks" | "Ke" | "Tf" => match words(rest).next() {
                Some(kind @ ("spectral" | "xyz")) => {
                    notes.push(format!(
                        "material {name}: its {keyword} is given as {kind}, which is not read"
                    ));
                    return Ok(());
                }
                _ => color(file, &line)?,
            },
            "Ni" | "d" | "Pr" | "Pm" => number(file, &line)?.to_string(),
            "Tr" => {
                keyword = "d";
                (1.0 - number(file, &line)?).to_string()
            }
            "illum" => {
                let model = words(rest).next().and_then(|word| word.parse().ok());
                let model = model
                    .filter(|model: &u8| *model <= 10)
                    .ok_or_else(|| invalid(file, &line, "an illumination model is 0 to 10"))?;
                model.to_string()
            }
            "map_Kd" | "map_Ke" => {
                let (what, value) = match keyword {
                    "map_Kd" => ("texture", "Kd"),
                    _ => ("emission texture", "Ke"),
                };
                notes.push(format!(
                    "material {name}: its {what} ({keyword}) is not read, its {value} stands"
                ));
                format!("file {rest}")
            }
            _ => return Ok(()),
        };
        text += &format!("{keyword} {value}\n");
        Ok(())
    })?;
    Ok(text)
}

/// The fields of a material that tobj has read from a cleaned text; all none for a new one.
pub(super) fn look(material: &tobj::Material) -> Look {
    // What tobj does not know it keeps as text.
    let numbers = |keyword: &str| -> Vec<f64> {
        let text = material.unknown_param.get(keyword);
        let words = text.iter().flat_map(|text| words(text));
        words.filter_map(|word| word.parse().ok()).collect()
    };
    Look::Mtl {
        kd: material.diffuse,
        ks: material.specular,
        ke: material.emissive,
        ni: material.optical_density,
        d: material.dissolve,
        tf: numbers("Tf").try_into().ok(),
        illum: material.illumination_model,
        textured: material.diffuse_texture.is_some(),
        pr: numbers("Pr").first().copied(),
        pm: numbers("Pm").first().copied(),
    }
}

/// Three numbers, also where there is one (a grey).
fn color(file: &Path, line: &Line) -> Result<String, LoadError> {
    let values: Option<Vec<f64>> = words(line.rest).map(finite).collect();
    match values.as_deref() {
        Some([grey]) => Ok(format!("{grey} {grey} {grey}")),
        Some([r, g, b]) => Ok(format!("{r} {g} {b}")),
        _ => Err(invalid(file, line, "one finite number or three")),
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
        let cleaned = cleaned(&path, File::open(&path).unwrap(), &mut notes)?;
        let (found, _) = tobj::load_mtl_buf(&mut cleaned.as_bytes()).unwrap();
        let looks = found.iter().map(|m| (m.name.clone(), look(m)));
        Ok((looks.collect(), notes))
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
        assert_eq!(read[1], ("B".to_owned(), look(&tobj::Material::default())));
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
        assert_eq!(read[0].1, look(&tobj::Material::default()));
        assert!(notes[0].contains("Kd") && notes[0].contains("spectral"));
    }
}
