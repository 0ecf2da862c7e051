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
    let mut lines = Lines::of(file, opened);
    let mut text = String::new();
    let mut name = String::new();
    while let Some(line) = lines.line()? {
        let (keyword, value) = match line.keyword {
            "newmtl" if line.rest.is_empty() => return Err(invalid(file, &line, "a name")),
            "newmtl" => {
                name = line.rest.to_owned();
                ("newmtl", name.clone())
            }
            // Fields before the first material are nobody's.
            _ if name.is_empty() => continue,
            keyword @ ("Kd" | "Ks" | "Ke" | "Tf") => {
                if let Some(kind @ ("spectral" | "xyz")) = words(line.rest).next() {
                    notes.push(format!(
                        "material {name}: its {keyword} is given as {kind}, which is not read"
                    ));
                    continue;
                }
                let [r, g, b] = color(file, &line)?;
                (keyword, format!("{r} {g} {b}"))
            }
            keyword @ ("Ni" | "d" | "Pr" | "Pm") => (keyword, number(file, &line)?.to_string()),
            "Tr" => ("d", (1.0 - number(file, &line)?).to_string()),
            "illum" => {
                let value = number(file, &line)?;
                let model = (0..=10).find(|&model| f64::from(model).total_cmp(&value).is_eq());
                let model: u8 = model
                    .ok_or_else(|| invalid(file, &line, "an illumination model is 0 to 10"))?;
                ("illum", model.to_string())
            }
            "map_Kd" => {
                notes.push(format!(
                    "material {name}: its texture (map_Kd) is not read, its Kd stands"
                ));
                ("map_Kd", format!("file {}", line.rest))
            }
            "map_Ke" => {
                notes.push(format!(
                    "material {name}: its emission texture (map_Ke) is not read, its Ke stands"
                ));
                continue;
            }
            _ => continue,
        };
        text += &format!("{keyword} {value}\n");
    }
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

/// One number (a grey) or three.
fn color(file: &Path, line: &Line) -> Result<[f64; 3], LoadError> {
    let values: Option<Vec<f64>> = words(line.rest).map(finite).collect();
    match values.as_deref() {
        Some(&[grey]) => Ok([grey; 3]),
        Some(&[r, g, b]) => Ok([r, g, b]),
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
