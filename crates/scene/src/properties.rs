//! The custom properties `malus_*` of objects, materials and lamps.

use crate::allowed::Allowed;
use crate::error::Error;
use crate::material::kind::Kind;
use crate::nearest::hint;
use crate::polarisation;
use malus_geometry::load::Properties;
use serde_json::Value;

/// What a set of custom properties belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Holder {
    Object,
    Material,
    Lamp,
}

/// What an object marked as a sensor stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Marker {
    Grid,
    Point,
    Mesh,
}

/// Emission as a custom property gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Emitted {
    /// Flux per area, in unit/m².
    Exitance(f64),
    /// Flux of all faces together, in the scene's unit.
    Flux(f64),
}

/// The custom properties of one holder, checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Custom {
    pub(crate) kind: Option<Kind>,
    pub(crate) rho: Option<f64>,
    pub(crate) a: Option<f64>,
    pub(crate) n: Option<f64>,
    pub(crate) k: Option<f64>,
    pub(crate) tau: Option<f64>,
    pub(crate) emitted: Option<Emitted>,
    pub(crate) state: Option<[f64; 4]>,
    pub(crate) sensor: Option<Marker>,
    pub(crate) nx: Option<usize>,
    pub(crate) ny: Option<usize>,
    pub(crate) ignore: bool,
}

/// Every key with the holders that may have it.
const KEYS: [(&str, &[Holder]); 13] = {
    use Holder::{Lamp, Material, Object};
    [
        ("malus_kind", &[Material, Object]),
        ("malus_rho", &[Material, Object]),
        ("malus_a", &[Material, Object]),
        ("malus_n", &[Material, Object]),
        ("malus_k", &[Material, Object]),
        ("malus_tau", &[Material, Object]),
        ("malus_exitance", &[Material, Object]),
        ("malus_emit_lm", &[Material, Object]),
        ("malus_polarisation", &[Material, Object, Lamp]),
        ("malus_sensor", &[Object]),
        ("malus_nx", &[Object]),
        ("malus_ny", &[Object]),
        ("malus_ignore", &[Object, Lamp]),
    ]
};

/// The largest number of cells along one side of a grid.
const MOST_CELLS: f64 = 10_000.0;

impl Custom {
    /// Reads the properties of a `holder` that is called `label` in messages.
    pub(crate) fn read(
        holder: Holder,
        label: &str,
        properties: &Properties,
    ) -> Result<Self, Error> {
        let mut custom = Self::default();
        let mut errors = Vec::new();
        for (key, value) in properties {
            if !key.to_lowercase().starts_with("malus") {
                continue;
            }
            if let Err((reason, hint)) = custom.set(holder, key, value) {
                errors.push(Error::Property {
                    holder: label.to_owned(),
                    key: key.clone(),
                    reason,
                    hint,
                });
            }
        }
        if let (Some(_), Some(_)) = (
            properties.get("malus_exitance"),
            properties.get("malus_emit_lm"),
        ) {
            errors.push(Error::Property {
                holder: label.to_owned(),
                key: "malus_emit_lm".into(),
                reason: "contradicts malus_exitance beside it; keep one of them".into(),
                hint: String::new(),
            });
        }
        Error::all(errors).map(|()| custom)
    }

    /// Whether any property of a material is among them.
    pub(crate) fn is_material(&self) -> bool {
        let numbers = [self.rho, self.a, self.n, self.k, self.tau];
        numbers.iter().any(Option::is_some)
            || self.kind.is_some()
            || self.emitted.is_some()
            || self.state.is_some()
    }

    fn set(&mut self, holder: Holder, key: &str, value: &Value) -> Result<(), (String, String)> {
        let plain = |reason: String| (reason, String::new());
        let allowed_here = || {
            let here = KEYS.iter().filter(|(_, holders)| holders.contains(&holder));
            here.map(|(key, _)| *key)
        };
        match KEYS.iter().find(|(known, _)| *known == key) {
            None => return Err(("means nothing".into(), hint(key, allowed_here()))),
            Some((_, holders)) if !holders.contains(&holder) => {
                let places: Vec<&str> = holders.iter().map(|holder| holder.words()).collect();
                return Err(plain(format!("belongs on {}", places.join(" or "))));
            }
            Some(_) => {}
        }
        let number = |allowed: Allowed| number(value, allowed).map_err(plain);
        match key {
            "malus_kind" => self.kind = Some(kind(value)?),
            "malus_rho" => self.rho = Some(number(Allowed::Share)?),
            "malus_a" => self.a = Some(number(Allowed::Share)?),
            "malus_n" => self.n = Some(number(Allowed::Index)?),
            "malus_k" => self.k = Some(number(Allowed::NotNegative)?),
            "malus_tau" => self.tau = Some(number(Allowed::Share)?),
            "malus_exitance" => {
                self.emitted = Some(Emitted::Exitance(number(Allowed::NotNegative)?));
            }
            "malus_emit_lm" => self.emitted = Some(Emitted::Flux(number(Allowed::NotNegative)?)),
            "malus_polarisation" => self.state = Some(state(value)?),
            "malus_sensor" => self.sensor = Some(marker(value)?),
            "malus_nx" => self.nx = Some(cells(value).map_err(plain)?),
            "malus_ny" => self.ny = Some(cells(value).map_err(plain)?),
            _ => self.ignore = flag(value).map_err(plain)?,
        }
        Ok(())
    }
}

impl Holder {
    fn words(self) -> &'static str {
        match self {
            Self::Object => "an object",
            Self::Material => "a material",
            Self::Lamp => "a lamp",
        }
    }
}

fn refused(value: &Value, allowed: &str) -> String {
    format!("must be {allowed}, found {value}")
}

/// A number; the text "inf" stands for infinity, which a JSON number cannot.
fn number(value: &Value, allowed: Allowed) -> Result<f64, String> {
    let number = match value {
        Value::Number(number) => number.as_f64(),
        Value::String(text) if text.trim() == "inf" => Some(f64::INFINITY),
        _ => None,
    };
    number
        .filter(|number| allowed.admits(*number))
        .ok_or_else(|| refused(value, allowed.words()))
}

fn cells(value: &Value) -> Result<usize, String> {
    let cells = number(value, Allowed::Positive).unwrap_or(0.0);
    if cells.fract().abs() < f64::MIN_POSITIVE && (1.0..=MOST_CELLS).contains(&cells) {
        Ok(cells as usize)
    } else {
        Err(refused(value, "a whole number from 1 to 10000"))
    }
}

fn flag(value: &Value) -> Result<bool, String> {
    match (value, value.as_f64()) {
        (Value::Bool(flag), _) => Ok(*flag),
        (_, Some(number)) if [0.0, 1.0].contains(&number) => Ok(number > 0.5),
        _ => Err(refused(value, "true or false")),
    }
}

fn marker(value: &Value) -> Result<Marker, (String, String)> {
    let choices = [
        ("grid", Marker::Grid),
        ("point", Marker::Point),
        ("mesh", Marker::Mesh),
    ];
    choice(value, choices, "\"grid\", \"point\" or \"mesh\"")
}

fn kind(value: &Value) -> Result<Kind, (String, String)> {
    choice(value, Kind::CHOICES, "\"mixture\", \"coated\" or \"pane\"")
}

/// One of three words.
fn choice<T: Copy>(
    value: &Value,
    choices: [(&str, T); 3],
    allowed: &str,
) -> Result<T, (String, String)> {
    let found = value.as_str();
    let chosen = choices.iter().find(|(word, _)| found == Some(*word));
    chosen.map(|(_, choice)| *choice).ok_or_else(|| {
        let words = choices.map(|(word, _)| word);
        let nearest = found.map_or_else(String::new, |found| hint(found, words));
        (refused(value, allowed), nearest)
    })
}

fn state(value: &Value) -> Result<[f64; 4], (String, String)> {
    if let Some(word) = value.as_str() {
        let names = || polarisation::NAMED.iter().map(|(name, _)| *name);
        return polarisation::named(word).ok_or_else(|| {
            let allowed = format!("{} or the name of a state", polarisation::ALLOWED);
            (refused(value, &allowed), hint(word, names()))
        });
    }
    let numbers: Option<Vec<f64>> = value
        .as_array()
        .and_then(|items| items.iter().map(Value::as_f64).collect());
    numbers
        .and_then(|numbers| <[f64; 4]>::try_from(numbers).ok())
        .filter(|state| polarisation::admits(*state))
        .map(polarisation::normalised)
        .ok_or_else(|| (refused(value, polarisation::ALLOWED), String::new()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn read(holder: Holder, properties: Value) -> Result<Custom, String> {
        let properties: Properties = serde_json::from_value(properties).unwrap();
        Custom::read(holder, "object \"Chair\" (room.glb)", &properties)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn values_are_read_and_foreign_properties_left_alone() {
        let custom = read(
            Holder::Material,
            json!({"malus_rho": 0.25, "malus_n": "inf", "malus_emit_lm": 3600, "cycles": {"x": 1}}),
        )
        .unwrap();
        assert_eq!(custom.rho, Some(0.25));
        assert_eq!(custom.n, Some(f64::INFINITY));
        assert_eq!(custom.emitted, Some(Emitted::Flux(3600.0)));
    }

    #[test]
    fn an_unknown_key_names_the_nearest() {
        let error = read(Holder::Object, json!({"malus_roh": 0.25})).unwrap_err();
        assert!(
            error.starts_with("object \"Chair\" (room.glb): custom property \"malus_roh\""),
            "{error}"
        );
        assert!(error.contains("the nearest is \"malus_rho\""), "{error}");
        assert!(read(Holder::Object, json!({"Malus_rho": 0.25})).is_err());
    }

    #[test]
    fn a_key_in_the_wrong_place_tells_the_right_one() {
        let error = read(Holder::Material, json!({"malus_sensor": "grid"})).unwrap_err();
        assert!(error.contains("belongs on an object"), "{error}");
        let error = read(Holder::Lamp, json!({"malus_rho": 0.5})).unwrap_err();
        assert!(
            error.contains("belongs on a material or an object"),
            "{error}"
        );
    }

    #[test]
    fn bad_values_tell_what_was_found_and_what_is_allowed() {
        for (properties, allowed) in [
            (json!({"malus_rho": 1.5}), "from 0 to 1, found 1.5"),
            (json!({"malus_a": "half"}), "from 0 to 1, found \"half\""),
            (
                json!({"malus_n": 0}),
                "> 0, or inf for an ideal mirror, found 0",
            ),
            (json!({"malus_k": -1}), "a number ≥ 0, found -1"),
            (json!({"malus_exitance": -1}), "a number ≥ 0, found -1"),
            (
                json!({"malus_nx": 2.5}),
                "a whole number from 1 to 10000, found 2.5",
            ),
            (
                json!({"malus_ignore": "yes"}),
                "true or false, found \"yes\"",
            ),
            (json!({"malus_sensor": "gird"}), "the nearest is \"grid\""),
            (json!({"malus_kind": "pain"}), "the nearest is \"pane\""),
            (json!({"malus_kind": 1}), "\"coated\" or \"pane\", found 1"),
            (json!({"malus_tau": 1.1}), "from 0 to 1, found 1.1"),
            (
                json!({"malus_polarisation": [1, 0.9, 0.9, 0]}),
                "q² + u² + v² ≤ 1",
            ),
            (
                json!({"malus_polarisation": [1, 0.9, 0.9]}),
                "q² + u² + v² ≤ 1",
            ),
            (
                json!({"malus_polarisation": "vertcal"}),
                "the nearest is \"vertical\"",
            ),
        ] {
            let error = read(Holder::Object, properties).unwrap_err();
            assert!(error.contains(allowed), "{error}");
        }
    }

    #[test]
    fn two_statements_of_the_emission_contradict_each_other() {
        let error = read(
            Holder::Material,
            json!({"malus_exitance": 1, "malus_emit_lm": 2}),
        )
        .unwrap_err();
        assert!(error.contains("contradicts malus_exitance"), "{error}");
    }

    #[test]
    fn blender_writes_flags_as_numbers_too() {
        for value in [json!(true), json!(1), json!(1.0)] {
            assert!(
                read(Holder::Lamp, json!({ "malus_ignore": value }))
                    .unwrap()
                    .ignore
            );
        }
        assert!(
            !read(Holder::Object, json!({"malus_ignore": 0}))
                .unwrap()
                .ignore
        );
    }
}
