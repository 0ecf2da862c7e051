//! The materials of the scene file: which of them give a value to a name.

use super::Origin;
use super::kind::Kind;
use crate::allowed::Allowed;
use crate::error::Error;
use crate::nearest::hint;
use crate::place::{Located, Place};
use crate::reader::{Field, Reader};
use crate::source::state;
use glam::DVec3;
use globset::{Glob, GlobMatcher};

/// Values as written under one name; each may be missing.
#[derive(Debug, Default)]
pub(crate) struct Written {
    pub(crate) kind: Option<Located<Kind>>,
    pub(crate) rho: Option<Located<f64>>,
    pub(crate) a: Option<Located<f64>>,
    pub(crate) n: Option<Located<f64>>,
    pub(crate) k: Option<Located<f64>>,
    pub(crate) tau: Option<Located<f64>>,
    pub(crate) exitance: Option<Located<f64>>,
    pub(crate) emission_stokes: Option<Located<[f64; 4]>>,
    pub(crate) emission_axis: Option<Located<DVec3>>,
    pub(crate) two_sided: Option<Located<bool>>,
}

/// One table `[material.NAME]`.
struct Definition {
    name: String,
    at: Place,
    /// None where the name is no valid glob.
    glob: Option<GlobMatcher>,
    written: Written,
}

/// All tables `[material.…]`, in the order of writing.
#[derive(Default)]
pub(crate) struct Library {
    definitions: Vec<Definition>,
}

impl Library {
    /// Reads `[material]`, where it is given.
    pub(crate) fn read(field: Option<Field>) -> Result<Self, Error> {
        let Some(field) = field else {
            return Ok(Self::default());
        };
        let mut definitions = Vec::new();
        for entry in field.table()?.rest() {
            let shown = if entry
                .key
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || "_-".contains(c))
            {
                format!("[material.{}]", entry.key)
            } else {
                format!("[material.{:?}]", entry.key)
            };
            let written = Written::read(Field::new(shown, entry.node).table()?)?;
            definitions.push(Definition {
                glob: Glob::new(&entry.key)
                    .ok()
                    .map(|glob| glob.compile_matcher()),
                name: entry.key,
                at: entry.at,
                written,
            });
        }
        Ok(Self { definitions })
    }

    /// The value that the scene file gives to the material `name`: by exact name, else by the longest glob that
    /// gives this value, the later one of equal length.
    pub(crate) fn value<T: Clone>(
        &self,
        name: &str,
        pick: impl Fn(&Written) -> Option<&Located<T>>,
    ) -> Option<(T, Origin)> {
        let (definition, located) = self.find(name, pick)?;
        let at = &located.at;
        let origin = if definition.name == name {
            Origin::Exact(at.to_string())
        } else {
            Origin::Glob(format!("{:?} at {at}", definition.name))
        };
        Some((located.value.clone(), origin))
    }

    /// Where the value stands that [`value`](Self::value) finds, and how closely its table names the material: by the
    /// number of characters of its glob, `usize::MAX` for the exact name.
    pub(crate) fn place<'a, T: 'a>(
        &'a self,
        name: &str,
        pick: impl Fn(&Written) -> Option<&Located<T>>,
    ) -> Option<(&'a Place, usize)> {
        let (definition, located) = self.find(name, pick)?;
        let closeness = if definition.name == name {
            usize::MAX
        } else {
            definition.length()
        };
        Some((&located.at, closeness))
    }

    fn find<T>(
        &self,
        name: &str,
        pick: impl Fn(&Written) -> Option<&Located<T>>,
    ) -> Option<(&Definition, &Located<T>)> {
        let mut best: Option<(&Definition, &Located<T>)> = None;
        for definition in &self.definitions {
            let Some(located) = pick(&definition.written) else {
                continue;
            };
            if definition.name == name {
                return Some((definition, located));
            }
            let length = definition.length();
            if definition.matches(name)
                && best.is_none_or(|(longest, _)| length >= longest.length())
            {
                best = Some((definition, located));
            }
        }
        best
    }

    /// Whether the scene file says anything of the material `name`.
    pub(crate) fn knows(&self, name: &str) -> bool {
        let mut definitions = self.definitions.iter();
        definitions.any(|definition| definition.name == name || definition.matches(name))
    }

    /// Names of the tables, for messages.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.definitions
            .iter()
            .map(|definition| definition.name.as_str())
    }

    /// Tables that no material of the scene answers to are errors, since a misspelt name would go unnoticed.
    ///
    /// In a scene without mesh files an unused exact name is only a warning: its shapes name their materials, and a
    /// misspelling there is an error by itself.
    pub(crate) fn check_used(
        &self,
        names: &[&str],
        meshes: bool,
        warnings: &mut Vec<String>,
    ) -> Result<(), Error> {
        let mut errors = Vec::new();
        for definition in &self.definitions {
            let name = definition.name.as_str();
            if names
                .iter()
                .any(|&used| used == name || definition.matches(used))
            {
                continue;
            }
            if !meshes && !definition.is_glob() {
                let at = &definition.at;
                warnings.push(format!("{at}: the material {name:?} is used by nothing"));
                continue;
            }
            // OBJ exporters write a space as an underscore.
            let underscored = name.replace(' ', "_");
            let hint = if underscored != name && names.contains(&underscored.as_str()) {
                format!("; the nearest is {underscored:?} (OBJ turns a space into _)")
            } else {
                hint(name, names.iter().copied())
            };
            errors.push(Error::NoMatch {
                at: definition.at.to_string(),
                what: "material".into(),
                name: name.to_owned(),
                hint,
            });
        }
        Error::all(errors)
    }
}

impl Definition {
    fn matches(&self, name: &str) -> bool {
        self.is_glob() && self.glob.as_ref().is_some_and(|glob| glob.is_match(name))
    }

    fn length(&self) -> usize {
        self.name.chars().count()
    }

    fn is_glob(&self) -> bool {
        is_glob(&self.name)
    }
}

/// Whether a name holds any of the characters that make it a glob.
pub(crate) fn is_glob(name: &str) -> bool {
    name.contains(['*', '?', '[', '{'])
}

impl Written {
    fn read(mut table: Reader) -> Result<Self, Error> {
        let kind = table.take("kind");
        let mut number = |key, allowed| {
            let Some(field) = table.take(key) else {
                return Ok(None);
            };
            let at = field.at().clone();
            let value = field.number(allowed)?;
            Ok::<_, Error>(Some(Located { value, at }))
        };
        let written = Self {
            kind: located(kind, |field| field.choice(&Kind::CHOICES))?,
            rho: number("rho", Allowed::Share)?,
            a: number("a", Allowed::Share)?,
            n: number("n", Allowed::Index)?,
            k: number("k", Allowed::NotNegative)?,
            tau: number("tau", Allowed::Share)?,
            exitance: number("exitance", Allowed::NotNegative)?,
            emission_stokes: located(table.take("emission_stokes"), |field| state(&field))?,
            emission_axis: located(table.take("emission_axis"), |field| field.direction())?,
            two_sided: located(table.take("two_sided"), Field::flag)?,
        };
        table.finish()?;
        Ok(written)
    }
}

fn located<T>(
    field: Option<Field>,
    read: impl Fn(Field) -> Result<T, Error>,
) -> Result<Option<Located<T>>, Error> {
    let Some(field) = field else {
        return Ok(None);
    };
    let at = field.at().clone();
    Ok(Some(Located {
        value: read(field)?,
        at,
    }))
}

#[cfg(test)]
mod tests;
