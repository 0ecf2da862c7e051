//! Pictures of cameras: files of Stokes vectors, and what they look like.

mod canvas;
mod cycle;
mod description;
mod exposure;
mod filter;
mod font;
mod legend;
mod percentile;
mod png;
mod recording;
mod survey;
mod tiff;

pub use exposure::Exposure;
pub use filter::Filter;
pub use recording::Recording;
pub use survey::Survey;

use crate::colour::viridis;
use crate::output::Directory;
use anyhow::{Result, ensure};
use canvas::{Canvas, PAPER};
use description::Description;
use filter::{dolp, linear};
use malus_estimator::Picture;
use malus_scene::Scene;
use std::io::{Seek, Write};

/// Colour of the degree of polarisation where there is no light.
const NO_LIGHT: [u8; 3] = [0, 0, 0];

/// Writes what a camera sees as `<name>.tiff`, the Stokes vectors as 32-bit floats, and as `<name>.png`, S0 to look at.
///
/// # Errors
/// The picture holds something that is no number, or a file cannot be written.
pub fn write(picture: &Picture, scene: &Scene, directory: &Directory, name: &str) -> Result<()> {
    let finite = picture
        .stokes
        .as_flattened()
        .iter()
        .all(|sample| sample.is_finite());
    ensure!(
        finite,
        "{name}: found a sample that is no number, expected finite numbers"
    );
    let description = Description {
        scene: scene.name.clone(),
        unit: format!("{}/(m²·sr)", scene.unit.symbol()),
        channels: "S0 S1 S2 S3".to_owned(),
        standard_error: picture.standard_error,
        complete: picture.complete,
    };
    directory.write_by(&format!("{name}.tiff"), |file| {
        write_stokes(file, picture, &description)
    })?;
    let survey = Survey::of(picture);
    let exposure = Exposure::new(survey.bright, survey.median, 0.0);
    directory.write_by(&format!("{name}.png"), |file| {
        write_grey(file, picture, exposure, |stokes| stokes[0])
    })
}

/// Writes the Stokes vectors as a TIFF.
///
/// # Errors
/// The file cannot be written.
fn write_stokes(
    file: &mut (impl Write + Seek),
    picture: &Picture,
    description: &Description,
) -> Result<()> {
    let form = tiff::Form {
        sides: [picture.width, picture.height],
        channels: 4,
        description,
    };
    tiff::write(file, form, |pixels, strip| {
        strip.extend_from_slice(picture.stokes[pixels].as_flattened());
    })
}

/// Writes the radiance that a filter lets through as a TIFF of one channel.
///
/// # Errors
/// The file cannot be written.
pub fn write_filtered(
    file: &mut (impl Write + Seek),
    recording: &Recording,
    filter: Filter,
    angle: &str,
) -> Result<()> {
    let picture = &recording.picture;
    let form = tiff::Form {
        sides: [picture.width, picture.height],
        channels: 1,
        description: &Description {
            channels: format!(
                "S0 through a linear polarising filter at {angle} deg from the right"
            ),
            ..recording.description.clone()
        },
    };
    tiff::write(file, form, |pixels, strip| {
        let passed = |stokes: &[f32; 4]| filter.transmitted(stokes.map(f64::from)) as f32;
        strip.extend(picture.stokes[pixels].iter().map(passed));
    })
}

/// Writes a radiance of every pixel in grey.
///
/// # Errors
/// The file cannot be written.
pub fn write_grey(
    file: &mut impl Write,
    picture: &Picture,
    exposure: Exposure,
    radiance: impl Fn([f64; 4]) -> f64,
) -> Result<()> {
    let colour = |stokes| [exposure.grey(radiance(stokes)); 3];
    write_coloured(file, picture, colour, &Canvas::new(0, 0))
}

/// Writes the degree of linear polarisation with its legend; the scale ends at the share `end`.
///
/// # Errors
/// The file cannot be written.
pub fn write_degree(file: &mut impl Write, picture: &Picture, end: f64) -> Result<()> {
    let colour = |stokes: [f64; 4]| {
        if stokes[0] > 0.0 {
            viridis(dolp(stokes) / end)
        } else {
            NO_LIGHT
        }
    };
    let legend = legend::degree(picture.height as usize, end);
    write_coloured(file, picture, colour, &legend)
}

/// Writes the angle of linear polarisation with its legend; colours are full from the degree `end` on.
///
/// # Errors
/// The file cannot be written.
pub fn write_angle(file: &mut impl Write, picture: &Picture, end: f64) -> Result<()> {
    let colour = |stokes: [f64; 4]| {
        // The angle of S1 and S2 is twice that of the axis.
        let length = linear(stokes).max(f64::MIN_POSITIVE);
        cycle::colour(stokes[1] / length, stokes[2] / length, dolp(stokes) / end)
    };
    let legend = legend::angle(picture.height as usize, end);
    write_coloured(file, picture, colour, &legend)
}

/// Writes a colour for every pixel, and to their right a legend.
fn write_coloured(
    file: &mut impl Write,
    picture: &Picture,
    colour: impl Fn([f64; 4]) -> [u8; 3],
    legend: &Canvas,
) -> Result<()> {
    let [width, height] = [picture.width, picture.height].map(|side| side as usize);
    let sides = [width + legend.width(), height.max(legend.height())];
    png::write(file, sides, |index, row| {
        let (left, right) = row.split_at_mut(width);
        if index < height {
            let stokes = &picture.stokes[index * width..][..width];
            for (pixel, stokes) in left.iter_mut().zip(stokes) {
                *pixel = colour(stokes.map(f64::from));
            }
        } else {
            left.fill(PAPER);
        }
        if let Some(drawn) = legend.row(index) {
            right.copy_from_slice(drawn);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    /// A picture that gets brighter to the right, and from the top down polarised in every direction.
    pub fn picture(width: u32, height: u32) -> Picture {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let stokes = pixels.map(|(x, y)| {
            let radiance = 1.0 + x as f32;
            let turn = std::f32::consts::TAU * y as f32 / height as f32;
            let degree = 0.8 * x as f32 / width as f32;
            let polarised = degree * radiance;
            [
                radiance,
                polarised * turn.cos(),
                polarised * turn.sin(),
                0.0,
            ]
        });
        Picture {
            width,
            height,
            stokes: stokes.collect(),
            standard_error: 0.01,
            complete: true,
        }
    }

    /// The picture as the bytes of a file.
    pub fn stokes_file(picture: &Picture) -> Vec<u8> {
        let description = Description {
            scene: "room".to_owned(),
            unit: "lm/(m²·sr)".to_owned(),
            channels: "S0 S1 S2 S3".to_owned(),
            standard_error: picture.standard_error,
            complete: picture.complete,
        };
        let mut file = Cursor::new(Vec::new());
        write_stokes(&mut file, picture, &description).expect("written");
        file.into_inner()
    }

    /// A loaded scene, and an empty directory.
    fn surroundings() -> (Scene, tempfile::TempDir, Directory) {
        let text = "[scene]\nname = \"Büro\"\nunit = \"W\"\n\
                    [[shape]]\nkind = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1\ninward = true\nmaterial = \"m\"\n\
                    [material.m]\nrho = 0.5\nexitance = 1\n\
                    [[sensor]]\nname = \"s\"\npoints = [[0, 0, 0]]\nnormal = [0, 0, 1]\n";
        let temporary = tempfile::tempdir().expect("a directory");
        let file = temporary.path().join("scene.toml");
        std::fs::write(&file, text).expect("written");
        let scene = Scene::load(&file, &[]).expect("a good scene");
        let directory = Directory::prepare(&temporary.path().join("out")).expect("writable");
        (scene, temporary, directory)
    }

    #[test]
    fn a_picture_is_written_to_be_read_back_and_to_be_looked_at() {
        let (scene, _kept, directory) = surroundings();
        let picture = Picture {
            complete: false,
            ..picture(31, 17)
        };
        write(&picture, &scene, &directory, "view").expect("written");
        let recording = Recording::read(&directory.path().join("view.tiff")).expect("whole");
        assert_eq!(recording.picture, picture);
        assert_eq!(recording.description.unit, "W/(m²·sr)");
        assert_eq!(recording.description.scene, "B\\u{fc}ro");
        assert_eq!(recording.description.channels, "S0 S1 S2 S3");
        let file = std::fs::File::open(directory.path().join("view.png")).expect("there");
        let reader = ::png::Decoder::new(std::io::BufReader::new(file)).read_info();
        let reader = reader.expect("a PNG");
        assert_eq!((reader.info().width, reader.info().height), (31, 17));
    }

    #[test]
    fn a_sample_that_is_no_number_is_not_written() {
        let (scene, _kept, directory) = surroundings();
        let mut picture = picture(3, 3);
        picture.stokes[4][3] = f32::NAN;
        let error = write(&picture, &scene, &directory, "view").expect_err("no number");
        assert!(
            error
                .to_string()
                .starts_with("view: found a sample that is no number")
        );
        assert!(!directory.path().join("view.tiff").exists());
    }
}
