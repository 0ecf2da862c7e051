//! `malus analyse`: a camera's picture through a polarising filter, and how its light is polarised.

use crate::args;
use crate::failure::Failure;
use crate::number::{exact, significant};
use crate::output::Directory;
use crate::picture::{self, Exposure, Filter, Recording, Survey};
use crate::report::{print, warn};
use crate::table::{Edge, Table};
use anyhow::{Result, anyhow};
use std::path::Path;

/// Angles of filters in degrees: one full turn either way.
const ANGLES: f64 = 360.0;

/// Steps of exposure: more than any scene needs, and far from overflow.
const STEPS: f64 = 30.0;

/// A filter and its angle as it is printed.
#[derive(Clone, Debug)]
struct Turned {
    filter: Filter,
    angle: String,
}

/// Reads the picture, writes what filters show and how it is polarised, prints a table of that.
///
/// # Errors
/// Bad arguments, a bad picture, or a result that cannot be written.
pub fn analyse(command: &args::Analyse) -> Result<(), Failure> {
    let filters = filters(&command.angle).map_err(Failure::input)?;
    let ev = match &command.exposure {
        Some(text) => number("exposure", text, STEPS).map_err(Failure::input)?,
        None => 0.0,
    };
    let recording = Recording::read(&command.picture).map_err(Failure::input)?;
    if !recording.picture.complete {
        warn(&[format!(
            "{}: the run that made it was interrupted; it is noisier than was asked for",
            command.picture.display()
        )]);
    }
    let survey = Survey::of(&recording.picture);
    let exposure = Exposure::new(survey.bright, survey.median, ev);
    let directory = Directory::prepare(directory(command)).map_err(Failure::run)?;
    let stem = command.picture.file_stem().unwrap_or_default();
    let results = Results {
        name: stem.to_string_lossy().into_owned(),
        recording: &recording,
        survey,
        exposure,
        filters: &filters,
    };
    results.write(&directory).map_err(Failure::run)?;
    print(&results.text(&directory)).map_err(Failure::run)
}

/// Where the results go.
fn directory(command: &args::Analyse) -> &Path {
    let beside = command.picture.parent().unwrap_or(Path::new(""));
    let beside = if beside.as_os_str().is_empty() {
        Path::new(".")
    } else {
        beside
    };
    command.output.as_deref().unwrap_or(beside)
}

/// The filters asked for.
fn filters(angles: &[String]) -> Result<Vec<Turned>> {
    let turned = |text: &String| {
        let angle = number("angle", text, ANGLES)?;
        Ok(Turned {
            filter: Filter::at(angle),
            angle: exact(angle)?,
        })
    };
    angles.iter().map(turned).collect()
}

/// The value of an option, a number from −`most` to `most`.
fn number(option: &str, text: &str, most: f64) -> Result<f64> {
    let number = text.trim().parse().ok();
    let number = number.filter(|value: &f64| value.is_finite() && value.abs() <= most);
    // The sum makes 0 of −0.
    number.map(|value| value + 0.0).ok_or_else(|| {
        anyhow!("--{option} {text}: must be a number from -{most} to {most}, found {text:?}")
    })
}

/// What is written and printed.
#[derive(Debug)]
struct Results<'a> {
    /// The picture's name, with which every file begins.
    name: String,
    recording: &'a Recording,
    survey: Survey,
    exposure: Exposure,
    filters: &'a [Turned],
}

impl Results<'_> {
    /// The name of a file.
    fn file(&self, suffix: &str) -> String {
        format!("{}-{suffix}", self.name)
    }

    fn write(&self, directory: &Directory) -> Result<()> {
        let (picture, end) = (&self.recording.picture, self.survey.dolp_end);
        directory.write_by(&self.file("s0.png"), |file| {
            picture::write_grey(file, picture, self.exposure, |stokes| stokes[0])
        })?;
        directory.write_by(&self.file("dolp.png"), |file| {
            picture::write_degree(file, picture, end)
        })?;
        directory.write_by(&self.file("aolp.png"), |file| {
            picture::write_angle(file, picture, end)
        })?;
        for Turned { filter, angle } in self.filters {
            directory.write_by(&self.file(&format!("filter-{angle}.tiff")), |file| {
                picture::write_filtered(file, self.recording, *filter, angle)
            })?;
            directory.write_by(&self.file(&format!("filter-{angle}.png")), |file| {
                let passed = |stokes| filter.transmitted(stokes);
                picture::write_grey(file, picture, self.exposure, passed)
            })?;
        }
        Ok(())
    }

    /// The table of what was written, and what is to be known of the whole picture.
    fn text(&self, directory: &Directory) -> String {
        let (picture, survey) = (&self.recording.picture, &self.survey);
        let unit = match self.recording.description.unit.as_str() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let noise = match picture.standard_error {
            error if error > 0.0 => format!(
                "noise in a pixel, standard error of S0: {} %; it adds to the degree of polarisation\n",
                significant(100.0 * error, 2)
            ),
            _ => String::new(),
        };
        format!(
            "{}: {} × {} pixels, mean S0 {}{unit}\n\n{}\n{}{noise}\
             pictures show up to {}{unit} in proportion, highlights above are compressed\n\
             results in {}\n",
            self.name,
            picture.width,
            picture.height,
            significant(survey.mean[0], 5),
            self.table().text("  "),
            polarisation(survey),
            significant(self.exposure.proportional(), 4),
            directory.path().display(),
        )
    }

    /// One row a file.
    fn table(&self) -> Table {
        let survey = &self.survey;
        let columns = [
            ("file", Edge::Left),
            ("shows", Edge::Left),
            ("mean, %", Edge::Right),
        ];
        let mut table = Table::new(columns.map(|(title, edge)| (title.to_owned(), edge)));
        let mut row = |suffix: &str, shows: &str, mean: &str| {
            table.row([self.file(suffix), shows.to_owned(), mean.to_owned()]);
        };
        row("s0.png", "all light", "100");
        for Turned { filter, angle } in self.filters {
            let passed = share(filter.transmitted(survey.mean), survey.mean[0]);
            let shows = format!("what passes a filter at {angle}°");
            row(&format!("filter-{angle}.png"), &shows, &passed);
            row(
                &format!("filter-{angle}.tiff"),
                "the same as 32-bit floats",
                "",
            );
        }
        let dolp = percent(survey.dolp);
        row("dolp.png", "degree of linear polarisation", &dolp);
        row("aolp.png", "angle of linear polarisation", "");
        table
    }
}

/// How the whole picture is polarised, and what a filter does to it.
fn polarisation(survey: &Survey) -> String {
    let mut text = format!(
        "degree of polarisation, weighed by radiance: linear {} %, circular {} %\n",
        percent(survey.dolp),
        percent(survey.docp)
    );
    text += &match survey.darkest_deg() {
        Some(dark) => {
            let bright = (dark + 90.0) % 180.0;
            let passed = |angle| share(Filter::at(angle).transmitted(survey.mean), survey.mean[0]);
            format!(
                "a filter darkens the picture most at {dark:.1}°: {} % passes; least at {bright:.1}°: {} %\n",
                passed(dark),
                passed(bright)
            )
        }
        None => "a filter darkens the picture alike at all angles, to 0.1 %\n".to_owned(),
    };
    text
}

/// A part of a whole in per cent; 0 of nothing.
fn share(part: f64, whole: f64) -> String {
    percent(if whole > 0.0 { part / whole } else { 0.0 })
}

/// A share in per cent, to a tenth.
fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_keep_the_digits_that_matter() {
        let texts = ["90", "-22.50", "+45", "-0", "1e-7", " 30 "].map(str::to_owned);
        let filters = filters(&texts).expect("good angles");
        let angles: Vec<&str> = filters.iter().map(|turned| turned.angle.as_str()).collect();
        assert_eq!(angles, ["90", "-22.5", "45", "0", "1e-7", "30"]);
    }

    #[test]
    fn what_is_no_angle_is_refused() {
        for text in [
            "", "north", "nan", "inf", "-inf", "360.5", "1e300", "45°", "1,5",
        ] {
            let error = number("angle", text, ANGLES).expect_err("no angle");
            let expected =
                format!("--angle {text}: must be a number from -360 to 360, found {text:?}");
            assert_eq!(error.to_string(), expected);
        }
    }
}
