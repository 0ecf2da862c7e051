//! How the scene is to be computed: the table `[run]`.

use crate::allowed::Allowed;
use crate::error::Error;
use crate::reader::{Field, Reader};
use malus_optics::Representation;

/// What happens to light at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The mirror-like part carries the Stokes vector through Fresnel's Mueller matrices.
    Polarised,
    /// The same Fresnel reflectance for unpolarised light, no polarisation.
    Scalar,
    /// No mirror-like part at all: a = 0 everywhere.
    Diffuse,
}

/// How walks are joined to the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimator {
    /// Local and gathering estimates together, weighted against each other.
    Auto,
    /// Walks from the sources, every vertex joined to every sensor (eqs. 10–20).
    Local,
    /// Walks from the sensors, every vertex joined to the sources.
    Gather,
    /// Counting hits in rings about the sensors; refused until it exists.
    Direct,
}

/// Settings of a run.
///
/// At least one of `samples`, `relative_error` and `seconds` is given; the first one reached stops the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What happens to light at a surface.
    pub model: Model,
    /// Report the paired result of [`Model::Scalar`] beside the polarised one.
    pub compare_scalar: bool,
    /// Report the paired result of [`Model::Diffuse`] beside the main one.
    pub compare_diffuse: bool,
    /// Number of Stokes components carried; `None`: what the scene needs.
    pub representation: Option<Representation>,
    /// How walks are joined to the sensors.
    pub estimator: Estimator,
    /// Side of the counting cells of [`Estimator::Direct`] in m, > 0.
    pub cell: Option<f64>,
    /// Number of walks, > 0.
    pub samples: Option<u64>,
    /// Standard error of S0 as a share of S0 at which the run stops, > 0.
    pub relative_error: Option<f64>,
    /// Time in seconds after which the run stops, > 0.
    pub seconds: Option<f64>,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Settings {
    /// Reads `[run]`, where it is given.
    pub(crate) fn read(table: Option<Field>) -> Result<Self, Error> {
        let mut settings = Self {
            model: Model::Polarised,
            compare_scalar: true,
            compare_diffuse: false,
            representation: None,
            estimator: Estimator::Auto,
            cell: None,
            samples: None,
            relative_error: None,
            seconds: None,
            seed: 1,
        };
        if let Some(table) = table {
            settings.fill(table.table()?)?;
        }
        let limits = [settings.relative_error, settings.seconds];
        if settings.samples.is_none() && limits == [None, None] {
            settings.relative_error = Some(0.01);
        }
        Ok(settings)
    }

    fn fill(&mut self, mut table: Reader) -> Result<(), Error> {
        if let Some(field) = table.take("model") {
            self.model = field.choice(&[
                ("polarised", Model::Polarised),
                ("scalar", Model::Scalar),
                ("diffuse", Model::Diffuse),
            ])?;
        }
        if let Some(field) = table.take("compare") {
            self.compare(field)?;
        }
        if let Some(field) = table.take("representation") {
            self.representation = field.choice(&[
                ("auto", None),
                ("intensity", Some(Representation::Intensity)),
                ("linear", Some(Representation::Linear)),
                ("full", Some(Representation::Full)),
            ])?;
        }
        if let Some(field) = table.take("estimator") {
            self.estimator = field.choice(&[
                ("auto", Estimator::Auto),
                ("local", Estimator::Local),
                ("gather", Estimator::Gather),
                ("direct", Estimator::Direct),
            ])?;
            if self.estimator == Estimator::Direct {
                return Err(Error::NotAvailable {
                    at: field.at().to_string(),
                    what: "the estimator \"direct\"".into(),
                    instead: "use \"auto\", \"local\" or \"gather\"".into(),
                });
            }
        }
        if let Some(field) = table.take("samples") {
            self.samples = Some(field.whole(1, u64::MAX)?);
        }
        if let Some(field) = table.take("relative_error") {
            self.relative_error = Some(field.number(Allowed::Positive)?);
        }
        if let Some(field) = table.take("seconds") {
            self.seconds = Some(field.number(Allowed::Positive)?);
        }
        if let Some(field) = table.take("seed") {
            self.seed = field.whole(0, u64::MAX)?;
        }
        table.finish()
    }

    fn compare(&mut self, field: Field) -> Result<(), Error> {
        self.compare_scalar = false;
        for item in field.list()? {
            let other = item.choice(&[("scalar", Model::Scalar), ("diffuse", Model::Diffuse)])?;
            if other == Model::Scalar {
                self.compare_scalar = true;
            } else {
                self.compare_diffuse = true;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Node;

    fn read(text: &str) -> Result<Settings, String> {
        let node = Node::document(&"room.toml".into(), text).unwrap();
        Settings::read(Some(Field::new("[run]".into(), node))).map_err(|error| error.to_string())
    }

    #[test]
    fn without_any_limit_the_relative_error_is_one_percent() {
        assert_eq!(read("").unwrap().relative_error, Some(0.01));
        assert_eq!(read("samples = 64").unwrap().relative_error, None);
        assert_eq!(read("seconds = 1").unwrap().relative_error, None);
    }

    #[test]
    fn the_polarised_model_is_compared_with_the_scalar_one_unless_told_otherwise() {
        let settings = read("").unwrap();
        assert!(settings.compare_scalar && !settings.compare_diffuse);
        let settings = read("compare = []").unwrap();
        assert!(!settings.compare_scalar && !settings.compare_diffuse);
        let settings = read("compare = [\"diffuse\"]").unwrap();
        assert!(!settings.compare_scalar && settings.compare_diffuse);
    }

    #[test]
    fn any_model_is_compared_with_what_is_asked_for() {
        let settings = read("model = \"scalar\"\ncompare = [\"scalar\", \"diffuse\"]").unwrap();
        assert!(settings.compare_scalar && settings.compare_diffuse);
    }

    #[test]
    fn ring_counting_is_refused_until_it_exists() {
        let error = read("estimator = \"direct\"").unwrap_err();
        assert!(error.starts_with("room.toml:1:13: "), "{error}");
        assert!(error.contains("not available yet"), "{error}");
    }

    #[test]
    fn bad_limits_are_refused() {
        for text in [
            "samples = 0",
            "samples = -5",
            "relative_error = 0",
            "seconds = nan",
            "seed = 1.5",
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains("must be a"), "{text}: {error}");
        }
        assert_eq!(read("seed = 18446744073709551615").unwrap().seed, u64::MAX);
    }

    #[test]
    fn an_american_spelling_finds_the_british_one() {
        let error = read("model = \"polarized\"").unwrap_err();
        assert!(error.contains("the nearest is \"polarised\""), "{error}");
    }
}
