//! The reflector that a material is: its kind, and the numbers that belong to it.

use super::{Found, Sources, shown, value};
use crate::error::Error;
use crate::material::kind::{Kind, Number};
use crate::material::{Origin, Value};
use malus_optics::{Coated, Index, Material};

/// A reflector with what makes it.
pub(super) struct Reflector {
    pub(super) optics: Material,
    pub(super) kind: Found<Kind>,
    /// Whether the scene file or a custom property says which kind it is.
    pub(super) stated: bool,
    /// Its kind and numbers, in the order of `docs/scene-format.md`.
    pub(super) values: Vec<Value>,
}

impl Sources<'_> {
    /// The reflector; `unlike_a_pane` is where something is given that no pane can have, an exitance or a black back.
    pub(super) fn reflector(&self, unlike_a_pane: Option<&Origin>) -> Result<Reflector, Error> {
        let (kind, stated) = self.kind(unlike_a_pane);
        self.no_strangers(&kind, stated)?;
        let mut values = vec![value("kind", kind.0.word().to_owned(), &kind.1)];
        let mut put = |number: Number, found: Found<f64>| {
            values.push(shown(number.key(), &found));
            found.0
        };
        let of = |number, default| self.number_or(number, kind.0, default);
        let optics = match kind.0 {
            Kind::Mixture => Material::Mixture {
                rho: put(Number::Rho, self.rho(kind.0)?),
                fraction: put(Number::A, of(Number::A, 0.0)?),
                index: Index::new(
                    put(Number::N, of(Number::N, 1.5)?),
                    put(Number::K, of(Number::K, 0.0)?),
                ),
            },
            Kind::Coated => Material::Coated(Coated::new(
                put(Number::Rho, self.rho(kind.0)?),
                put(Number::N, of(Number::N, 1.5)?),
            )),
            Kind::Pane => Material::Pane {
                n: put(Number::N, of(Number::N, 1.5)?),
                tau: put(Number::Tau, of(Number::Tau, 1.0)?),
            },
        };
        Ok(Reflector {
            optics,
            kind,
            stated,
            values,
        })
    }

    /// The kind, and whether the scene file or a custom property says so.
    ///
    /// Where only the file's fields speak of a pane, whoever gives a value that no pane has means a mixture.
    fn kind(&self, unlike_a_pane: Option<&Origin>) -> (Found<Kind>, bool) {
        let stated = self
            .written(|written| written.kind.as_ref())
            .or_else(|| self.property("malus_kind", |custom| custom.kind));
        if let Some(found) = stated {
            return (found, true);
        }
        let Some(origin) = self.appearance.and_then(|appearance| appearance.pane) else {
            return ((Kind::Mixture, Origin::Default), false);
        };
        let mut scattering = [Number::Rho, Number::A, Number::K].into_iter();
        let given = scattering.find_map(|number| Some(self.given(number)?.1));
        let kind = match given.as_ref().or(unlike_a_pane) {
            Some(against) => (Kind::Mixture, against.clone()),
            None => (Kind::Pane, Origin::Field(origin.to_owned())),
        };
        (kind, false)
    }

    /// Refuses numbers that do not belong to the kind and are given at least as closely as the kind itself: an `a` for
    /// all materials, `[material."*"]`, is no reproach to the one pane among them.
    fn no_strangers(&self, kind: &Found<Kind>, stated: bool) -> Result<(), Error> {
        let closeness = self
            .library
            .place(self.name, |written| written.kind.as_ref());
        let own = match stated {
            true => Closeness::of(&kind.1, closeness.map(|(_, closeness)| closeness)),
            false => Closeness::NONE,
        };
        let mut errors = Vec::new();
        for number in Number::ALL {
            let Some((value, origin)) = self.given(number) else {
                continue;
            };
            let place = self
                .library
                .place(self.name, |written| number.written(written));
            let given = Closeness::of(&origin, place.map(|(_, closeness)| closeness));
            let Some(why) = kind.0.lacks(number, value).filter(|_| given >= own) else {
                continue;
            };
            let key = match &origin {
                Origin::Object(text) | Origin::Property(text) => text,
                _ => number.key(),
            };
            let instead = match number {
                Number::Tau => Kind::Pane,
                _ => Kind::Mixture,
            };
            errors.push(Error::Conflict {
                at: self.place_of(number, &origin),
                reason: format!(
                    "{key} is given for material {:?}, whose kind is {:?} ({}): {why}; leave it out, or give kind = {:?}",
                    self.name,
                    kind.0.word(),
                    kind.1,
                    instead.word()
                ),
            });
        }
        Error::all(errors)
    }

    /// ρ, which has no default.
    fn rho(&self, kind: Kind) -> Result<Found<f64>, Error> {
        let found = self.number(Number::Rho, kind)?;
        found
            .ok_or_else(|| Error::NoReflectance {
                holder: self.holder.clone(),
                name: self.name.to_owned(),
                reason: match (self.appearance, self.library.knows(self.name)) {
                    (Some(_), _) => {
                        "its file does not: no material library of it defines that name, or it has no Kd there".into()
                    }
                    (None, true) => "the scene file defines it without rho".into(),
                    (None, false) => "it is defined nowhere".into(),
                },
            })
    }

    fn number_or(&self, number: Number, kind: Kind, default: f64) -> Result<Found<f64>, Error> {
        let found = self.number(number, kind)?;
        Ok(found.unwrap_or((default, Origin::Default)))
    }

    /// A number from the first that gives it, in the range that the kind allows.
    fn number(&self, number: Number, kind: Kind) -> Result<Option<Found<f64>>, Error> {
        let allowed = number.allowed(kind);
        if let Some((found, origin)) = self.given(number) {
            if allowed.admits(found) {
                return Ok(Some((found, origin)));
            }
            return Err(Error::BadValue {
                at: self.place_of(number, &origin),
                key: format!(
                    "{} of material {:?}, whose kind is {:?},",
                    number.key(),
                    self.name,
                    kind.word()
                ),
                found: found.to_string(),
                allowed: allowed.words().to_owned(),
                hint: String::new(),
            });
        }
        // The index guessed for a metal is none of a coat or a pane.
        let metal = self.appearance.is_some_and(|it| it.k.is_some());
        if metal && number == Number::N && kind != Kind::Mixture {
            return Ok(None);
        }
        self.field(number.key(), allowed, |appearance| number.field(appearance))
    }

    /// A number that the scene file or a custom property gives.
    fn given(&self, number: Number) -> Option<Found<f64>> {
        let key = format!("malus_{}", number.key());
        self.written(|written| number.written(written))
            .or_else(|| self.property(&key, |custom| number.custom(custom)))
    }

    /// Where a given number stands, for the beginning of a message.
    fn place_of(&self, number: Number, origin: &Origin) -> String {
        self.place(origin, |written| number.written(written))
    }
}

/// How closely a value is given: the greater, the more binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Closeness(u8, usize);

impl Closeness {
    /// Of what nobody gives.
    const NONE: Self = Self(0, 0);

    /// Of a value from `origin`; `table` is how closely the scene file's table names the material.
    fn of(origin: &Origin, table: Option<usize>) -> Self {
        match origin {
            Origin::Exact(_) | Origin::Glob(_) => Self(4, table.unwrap_or(0)),
            Origin::Object(_) => Self(3, 0),
            Origin::Property(_) => Self(2, 0),
            Origin::Field(_) => Self(1, 0),
            Origin::Default => Self::NONE,
        }
    }
}
