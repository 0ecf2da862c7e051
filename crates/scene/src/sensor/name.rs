//! Names of sensors and cameras, which become names of files.

use crate::error::Error;
use crate::place::Located;
use crate::reader::Field;
use std::collections::BTreeSet;

/// Characters that some file system does not allow.
const FORBIDDEN: [char; 9] = ['/', '\\', ':', '*', '?', '"', '<', '>', '|'];

/// The longest name, in bytes: file systems allow 255, suffix included.
const LONGEST: usize = 200;

/// The name under `key`, which has to be able to name a file.
pub(crate) fn checked(field: Field, key: &str) -> Result<Located<String>, Error> {
    let name = field.text()?;
    match fault(&name.value) {
        None => Ok(name),
        Some(allowed) => Err(Error::BadValue {
            at: name.at.to_string(),
            key: key.to_owned(),
            found: format!("{:?}", name.value),
            allowed,
            hint: String::new(),
        }),
    }
}

/// Why `name` cannot be the name of a file; `None` if it can.
fn fault(name: &str) -> Option<String> {
    if name.trim().is_empty() {
        return Some("a name that is not empty".into());
    }
    if name.trim() != name || name.starts_with('.') || name.ends_with('.') {
        return Some("a name without a space or a dot at its ends, since it names a file".into());
    }
    if name.len() > LONGEST {
        return Some(format!(
            "a name of at most {LONGEST} bytes, since it names a file"
        ));
    }
    let bad = name.chars().find(|c| forbidden(*c))?;
    Some(format!("a name without {bad:?}, since it names a file"))
}

/// `name` with what no file name may hold replaced by `_`, and told apart from those `taken`.
pub(crate) fn usable(name: &str, taken: &BTreeSet<String>) -> String {
    let replaced: String = name
        .trim()
        .trim_matches('.')
        .chars()
        .map(|c| if forbidden(c) { '_' } else { c })
        .collect();
    let mut base = String::new();
    for c in replaced.chars() {
        if base.len() + c.len_utf8() > LONGEST - 8 {
            break;
        }
        base.push(c);
    }
    let base = match base.trim() {
        "" => "sensor",
        base => base,
    };
    let numbered = (2..).map(|number| format!("{base}_{number}"));
    let mut candidates = std::iter::once(base.to_owned()).chain(numbered);
    let free = candidates.find(|candidate| !taken.contains(&folded(candidate)));
    free.unwrap_or_else(|| base.to_owned())
}

/// A name as file systems compare it that do not tell upper from lower case.
pub(crate) fn folded(name: &str) -> String {
    name.to_lowercase()
}

fn forbidden(c: char) -> bool {
    FORBIDDEN.contains(&c) || c.is_control()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_no_file_names_are_found() {
        for name in ["", " ", "a/b", "..", ".hidden", "desk ", "a\nb", "x:y"] {
            assert!(fault(name).is_some(), "{name:?}");
        }
        for name in ["desk", "Büro 1", "SENSOR_Workplane.001"] {
            assert_eq!(fault(name), None, "{name:?}");
        }
        assert!(fault(&"x".repeat(201)).is_some());
    }

    #[test]
    fn a_name_from_a_mesh_file_is_made_usable_and_unique() {
        let mut taken = BTreeSet::new();
        assert_eq!(usable("SENSOR_a/b", &taken), "SENSOR_a_b");
        taken.insert(folded("Desk"));
        assert_eq!(usable("desk", &taken), "desk_2");
        for name in ["", "...", "a/b\\c", &"ü".repeat(300)] {
            assert_eq!(fault(&usable(name, &taken)), None, "{name:?}");
        }
    }
}
