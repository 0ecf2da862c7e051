//! Puts a material together: every value from the first place that gives it.

mod reflector;

use super::kind::Kind;
use super::library::{Library, Written};
use super::{Emission, Material, Origin, Value};
use crate::allowed::Allowed;
use crate::appearance::{Appearance, Doubt, Given};
use crate::error::Error;
use crate::place::Located;
use crate::polarisation::UNPOLARISED;
use crate::properties::{Custom, Emitted};
use glam::DVec3;
use reflector::Reflector;

/// Where the values of one material on one object, or on all that share it, can come from.
pub(crate) struct Sources<'a> {
    pub(crate) library: &'a Library,
    /// Name of the material.
    pub(crate) name: &'a str,
    /// Who is to be named in messages: object and material, with their file.
    pub(crate) holder: String,
    /// The object, where its own properties or its axis matter.
    pub(crate) object: Option<Carrier<'a>>,
    /// The material's custom properties.
    pub(crate) custom: Option<&'a Custom>,
    /// The file's own fields.
    pub(crate) appearance: Option<&'a Appearance>,
    /// Area of all faces of the material in its file, in m².
    pub(crate) area: f64,
}

/// The object that carries a material.
pub(crate) struct Carrier<'a> {
    pub(crate) name: &'a str,
    pub(crate) custom: &'a Custom,
    /// Its local X in the world, a unit vector.
    pub(crate) local_x: DVec3,
    /// Area in m² over which its own flux is spread: of its faces that emit by themselves, else of all; `None` where
    /// this material does not emit and others of the object do.
    pub(crate) area: Option<f64>,
}

/// A value that has been found.
type Found<T> = (T, Origin);

impl Sources<'_> {
    /// The material, with what is to be warned of.
    pub(crate) fn resolve(&self) -> Result<(Material, Vec<String>), Error> {
        let exitance = self.exitance()?;
        let (state, axis) = self.state();
        let two_sided = self
            .written(|written| written.two_sided.as_ref())
            .unwrap_or((true, Origin::Default));
        let emits = (exitance.0 > 0.0).then_some(&exitance.1);
        let one_sided = (!two_sided.0).then_some(&two_sided.1);
        let reflector = self.reflector(emits.or(one_sided))?;
        if reflector.kind.0 == Kind::Pane {
            self.whole(emits, one_sided)?;
        }
        let doubts = self.doubts(&reflector);
        let mut values = reflector.values;
        values.push(shown("exitance", &exitance));
        let emission = (exitance.0 > 0.0).then(|| {
            let text = |list: &[f64]| format!("{list:?}");
            values.push(value("emission_stokes", text(&state.0), &state.1));
            values.push(value("emission_axis", text(&axis.0.to_array()), &axis.1));
            Emission {
                exitance: exitance.0,
                state: state.0,
                axis: axis.0,
            }
        });
        values.push(value("two_sided", two_sided.0.to_string(), &two_sided.1));
        let material = Material {
            name: self.name.to_owned(),
            object: self.object.as_ref().map(|object| object.name.to_owned()),
            optics: reflector.optics,
            two_sided: two_sided.0,
            emission,
            values,
        };
        Ok((material, doubts))
    }

    /// Refuses a pane that emits or has a black side.
    fn whole(&self, emits: Option<&Origin>, one_sided: Option<&Origin>) -> Result<(), Error> {
        let pane = format!("material {:?} is a pane", self.name);
        let (at, reason) = if let Some(origin) = emits {
            let at = self.place(origin, |written| written.exitance.as_ref());
            let why = format!("{pane} and emits light ({origin}), which a pane cannot");
            (
                at,
                format!("{why}; give exitance = 0, or kind = \"mixture\""),
            )
        } else if let Some(origin) = one_sided {
            let at = self.place(origin, |written| written.two_sided.as_ref());
            let why = format!("{pane}, which has no black side");
            (
                at,
                format!("{why}; leave two_sided = false out, or give kind = \"mixture\""),
            )
        } else {
            return Ok(());
        };
        Err(Error::Conflict { at, reason })
    }

    /// Where a value stands, for the beginning of a message: in the scene file, else who holds it.
    fn place<T>(&self, origin: &Origin, pick: impl Fn(&Written) -> Option<&Located<T>>) -> String {
        let written = matches!(origin, Origin::Exact(_) | Origin::Glob(_));
        let place = self.library.place(self.name, pick).filter(|_| written);
        place.map_or_else(|| self.holder.clone(), |(at, _)| at.to_string())
    }

    /// State of the emitted light, with its axis: that of a custom property is the object's local X.
    fn state(&self) -> (Found<[f64; 4]>, Found<DVec3>) {
        let axis = self.written(|written| written.emission_axis.as_ref());
        if let Some(state) = self.written(|written| written.emission_stokes.as_ref()) {
            return (state, axis.unwrap_or((DVec3::X, Origin::Default)));
        }
        let Some(state) = self.property("malus_polarisation", |custom| custom.state) else {
            let state = (UNPOLARISED, Origin::Default);
            return (state, axis.unwrap_or((DVec3::X, Origin::Default)));
        };
        let local = self.object.as_ref().map(|object| {
            let origin = format!("local X of object {:?}", object.name);
            (object.local_x, Origin::Object(origin))
        });
        let axis = axis.or(local).unwrap_or((DVec3::X, Origin::Default));
        (state, axis)
    }

    /// Exitance in unit/m², a given flux being spread over its area.
    fn exitance(&self) -> Result<Found<f64>, Error> {
        if let Some(found) = self.written(|written| written.exitance.as_ref()) {
            return Ok(found);
        }
        let spread = |emitted, area: f64, origin: fn(String) -> Origin, who: &str| match emitted {
            Emitted::Exitance(exitance) => (exitance, origin(format!("malus_exitance of {who}"))),
            Emitted::Flux(flux) => {
                let exitance = if area > 0.0 { flux / area } else { 0.0 };
                let text = format!("malus_emit_lm {flux} of {who} over {area:.6} m²");
                (exitance, origin(text))
            }
        };
        if let Some(object) = &self.object
            && let Some(emitted) = object.custom.emitted
            && let Some(area) = object.area
        {
            let who = format!("object {:?}", object.name);
            return Ok(spread(emitted, area, Origin::Object, &who));
        }
        if let Some(emitted) = self.custom.and_then(|custom| custom.emitted) {
            return Ok(spread(emitted, self.area, Origin::Property, "the material"));
        }
        self.field("exitance", Allowed::NotNegative, |appearance| {
            appearance.exitance
        })
        .map(|found| found.unwrap_or((0.0, Origin::Default)))
    }

    fn written<T: Clone>(
        &self,
        pick: impl Fn(&Written) -> Option<&Located<T>>,
    ) -> Option<Found<T>> {
        self.library.value(self.name, pick)
    }

    /// The value of a custom property: the object's before the material's.
    fn property<T>(&self, key: &str, pick: impl Fn(&Custom) -> Option<T>) -> Option<Found<T>> {
        if let Some(object) = &self.object
            && let Some(value) = pick(object.custom)
        {
            let text = format!("{key} of object {:?}", object.name);
            return Some((value, Origin::Object(text)));
        }
        let value = pick(self.custom?)?;
        Some((value, Origin::Property(format!("{key} of the material"))))
    }

    /// The value that the file's fields give; only here its range is checked, since another may have been given for it.
    fn field(
        &self,
        key: &str,
        allowed: Allowed,
        pick: impl Fn(&Appearance) -> Option<Given>,
    ) -> Result<Option<Found<f64>>, Error> {
        let Some((number, origin)) = self.appearance.and_then(pick) else {
            return Ok(None);
        };
        if allowed.admits(number) {
            return Ok(Some((number, Origin::Field(origin.to_owned()))));
        }
        Err(Error::BadMaterial {
            holder: self.holder.clone(),
            key: key.to_owned(),
            found: number.to_string(),
            allowed: allowed.words().to_owned(),
            origin: origin.to_owned(),
        })
    }

    /// What the file's fields leave in doubt, as far as their values are in use.
    fn doubts(&self, reflector: &Reflector) -> Vec<String> {
        let Some(appearance) = self.appearance else {
            return Vec::new();
        };
        let in_use = |key: &&str| {
            let mut values = reflector.values.iter();
            values.any(|value| value.key == *key && matches!(value.origin, Origin::Field(_)))
        };
        let told = |doubt: &Doubt| match doubt {
            Doubt::Value(keys, _) => keys.iter().any(in_use),
            Doubt::Opaque(_) => reflector.kind.0 != Kind::Pane && !reflector.stated,
        };
        let doubts = appearance.doubts.iter().filter(|doubt| told(doubt));
        doubts.map(ToString::to_string).collect()
    }
}

fn shown(key: &'static str, (number, origin): &Found<f64>) -> Value {
    // Fifteen digits: what was written, without the noise of a product.
    value(key, format!("{}", rounded(*number)), origin)
}

/// The nearest number of fifteen decimal digits.
fn rounded(number: f64) -> f64 {
    format!("{number:.14e}").parse().unwrap_or(number)
}

fn value(key: &'static str, value: String, origin: &Origin) -> Value {
    Value {
        key,
        value,
        origin: origin.clone(),
    }
}

#[cfg(test)]
mod tests;
