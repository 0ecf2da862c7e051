//! Which scene, and which settings, sums and results belong to.

use crate::{Material, Scene, Settings};
use malus_geometry::Mesh;
use serde::{Deserialize, Serialize};
use siphasher::sip128::{Hasher128, SipHasher13};
use std::fmt::{self, Debug, Write};
use std::hash::Hasher;
use std::sync::Arc;

/// What is told apart, in the words of the scene file.
const PARTS: [&str; 12] = [
    "[scene]",
    "geometry",
    "materials",
    "sources",
    "sensors",
    "cameras",
    "run.model",
    "run.compare",
    "run.representation",
    "run.estimator",
    "run.cell",
    "run.seed",
];

/// Which of them the geometry is.
const GEOMETRY: usize = 1;

/// All that the sums of a run depend on, but how many they are: two scenes that give the same numbers for any number of
/// samples have the same fingerprint, and any others do not.
///
/// It is taken of values as they are resolved, so it does not matter where files lie, what a file says that has no
/// effect, or whether a value stands in the file or was given with `--set`. The stopping rules take no part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint([u128; PARTS.len()]);

impl Fingerprint {
    /// What two fingerprints differ in, in the words of the scene file; nothing if they are the same.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Vec<&'static str> {
        let parts = PARTS.into_iter().zip(self.0.iter().zip(&other.0));
        parts
            .filter_map(|(part, (one, other))| (one != other).then_some(part))
            .collect()
    }
}

impl Scene {
    /// What results depend on that are computed of this scene with `settings` in place of its own.
    #[must_use]
    pub fn fingerprint(&self, settings: &Settings) -> Fingerprint {
        self.fingerprint_with(settings, digest_of_mesh(self.surfaces.mesh()))
    }

    /// The same where another scene's is known: geometry that the two share is not looked through again.
    #[must_use]
    pub fn fingerprint_beside(
        &self,
        settings: &Settings,
        other: &Self,
        known: &Fingerprint,
    ) -> Fingerprint {
        if Arc::ptr_eq(&self.surfaces, &other.surfaces) {
            self.fingerprint_with(settings, known.0[GEOMETRY])
        } else {
            self.fingerprint(settings)
        }
    }

    fn fingerprint_with(&self, settings: &Settings, geometry: u128) -> Fingerprint {
        let Self {
            name,
            unit,
            materials,
            sources,
            sensors,
            cameras,
            // Given as an argument.
            settings: _,
            // Its digest is given too.
            surfaces: _,
            // They follow from the rest, or are words for people.
            need: _,
            objects: _,
            coincidences: _,
            warnings: _,
        } = self;
        let materials: Vec<_> = materials.iter().map(resolved).collect();
        let Settings {
            model,
            compare_scalar,
            compare_diffuse,
            representation,
            estimator,
            cell,
            seed,
            // The stopping rules.
            samples: _,
            relative_error: _,
            seconds: _,
        } = settings;
        Fingerprint([
            digest(&(name, unit)),
            geometry,
            digest(&materials),
            digest(sources),
            digest(sensors),
            digest(cameras),
            digest(model),
            digest(&(compare_scalar, compare_diffuse)),
            digest(representation),
            digest(estimator),
            digest(cell),
            digest(seed),
        ])
    }
}

/// A material without the places that its values come from.
fn resolved(material: &Material) -> impl Debug + '_ {
    let Material {
        name,
        object,
        optics,
        two_sided,
        emission,
        values: _,
    } = material;
    (name, object, optics, two_sided, emission)
}

/// Digest of all that a value holds: what derives `Debug` leaves no field out, and a float is written so that it reads
/// back to the same bits.
pub(crate) fn digest(value: &impl Debug) -> u128 {
    let mut text = Text(SipHasher13::new());
    write!(text, "{value:?}").expect("a digest takes any text");
    text.0.finish128().as_u128()
}

/// Digest of a mesh, which is too large to be put into words.
fn digest_of_mesh(mesh: &Mesh) -> u128 {
    let Mesh {
        positions,
        triangles,
        surfaces,
        objects,
    } = mesh;
    let mut hasher = SipHasher13::new();
    for coordinate in positions.iter().flat_map(|position| position.to_array()) {
        hasher.write_u64(coordinate.to_bits());
    }
    for index in triangles
        .as_flattened()
        .iter()
        .chain(surfaces)
        .chain(objects)
    {
        hasher.write_u32(*index);
    }
    hasher.finish128().as_u128()
}

/// Text that goes into a digest.
struct Text(SipHasher13);

impl Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Override;

    const ROOM: &str = "# A comment
        [[shape]]
        kind = \"box\"
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = \"wall\"
        [material.wall]
        rho = 0.5
        [[source]]
        kind = \"point\"
        position = [0.5, 0.5, 0.9]
        intensity = 10
        [[sensor]]
        name = \"floor\"
        points = [[0.5, 0.5, 0]]
        normal = [0, 0, 1]
        [[camera]]
        name = \"eye\"
        position = [0.1, 0.1, 0.5]
        look_at = [0.5, 0.5, 0.5]
        ";

    fn fingerprint(text: &str, set: &[(&str, &str)]) -> Fingerprint {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.toml");
        std::fs::write(&path, text).unwrap();
        let set: Vec<Override> = set
            .iter()
            .map(|(key, value)| Override {
                key: (*key).into(),
                value: (*value).into(),
            })
            .collect();
        let scene = Scene::load(&path, &set).unwrap_or_else(|error| panic!("{error}"));
        scene.fingerprint(&scene.settings)
    }

    #[test]
    fn what_changes_no_number_changes_no_fingerprint() {
        let plain = fingerprint(ROOM, &[]);
        let moved = ROOM.replace("# A comment", "\n\n# Another place\n");
        assert_eq!(fingerprint(&moved, &[]), plain);
        let elsewhere = ROOM.replace("rho = 0.5", "rho = 0.7");
        assert_eq!(
            fingerprint(&elsewhere, &[("material.wall.rho", "0.5")]),
            plain
        );
        for stop in ["samples", "relative_error", "seconds"] {
            assert_eq!(fingerprint(ROOM, &[(&format!("run.{stop}"), "1")]), plain);
        }
    }

    #[test]
    fn what_changes_a_number_is_told_by_its_name() {
        let plain = fingerprint(ROOM, &[]);
        for (key, value, part) in [
            ("scene.unit", "W", "[scene]"),
            ("shape.0.max.2", "1.0000000000000002", "geometry"),
            ("material.wall.rho", "0.5000000000000001", "materials"),
            ("source.0.intensity", "11", "sources"),
            ("sensor.floor.normal", "[0, 0, -1]", "sensors"),
            ("camera.0.samples", "65", "cameras"),
            ("run.seed", "2", "run.seed"),
            ("run.model", "scalar", "run.model"),
            ("run.compare", "[\"diffuse\"]", "run.compare"),
            ("run.representation", "full", "run.representation"),
            ("run.estimator", "gather", "run.estimator"),
        ] {
            let other = fingerprint(ROOM, &[(key, value)]);
            assert_eq!(plain.differences(&other), [part], "{key}");
        }
    }
}
