//! What a camera sees.

use crate::choose::techniques;
use crate::emitters::Emitters;
use crate::evaluate::Gathering;
use crate::gather::Way;
use crate::pass::{Modelled, Passes};
use crate::path::Path;
use crate::random::{Purpose, Stream};
use crate::receiver::Receiver;
use crate::results::Answer;
use crate::run::representation_of;
use crate::state::Shard;
use crate::statistics::REPLICAS;
use malus_optics::Representation;
use malus_scene::{Camera, Estimator, Scene, Settings};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Walks that a step takes in all, so that a watcher is asked several times a second.
const STEP: u64 = 1 << 17;

/// Least number of pixels in a step.
const LEAST: u64 = 16;

/// A picture in polarised light: the radiance Stokes vector in every pixel, in unit/(m²·sr).
///
/// In each pixel **d** is the direction in which light travels, towards the viewer, and **x** the camera's right vector
/// made perpendicular to it, so **y** = **d** × **x** points up in the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels in a row, ≥ 1.
    pub width: u32,
    /// Rows, ≥ 1.
    pub height: u32,
    /// Stokes vectors by rows, the top left pixel first: width × height of them.
    pub stokes: Vec<[f32; 4]>,
    /// Root mean square over the pixels of the standard error of S0, as a share of the mean S0.
    pub standard_error: f64,
    /// Whether all samples were taken; `false` where the user ended the run before.
    pub complete: bool,
}

/// What a camera has taken so far, in bands of pixels, row by row from the top.
///
/// As with [`State`](crate::State), joining two is a union, and what is there depends on nothing but scene, settings and
/// camera.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Film {
    bands: BTreeMap<u32, Band>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Band {
    stokes: Vec<[f32; 4]>,
    /// Sum of S0 over the pixels.
    sum: f64,
    /// Sum of the squares of its standard errors.
    variance: f64,
}

impl Film {
    /// Union with another part of the same picture; what stands in both is the same in both.
    pub fn merge(&mut self, mut other: Self) {
        self.bands.append(&mut other.bands);
    }

    /// The picture of the camera that the film was in, black where nothing was taken yet.
    #[must_use]
    pub fn developed(&self, camera: &Camera) -> Picture {
        let count = camera.width as usize * camera.height as usize;
        let pixels = band(camera);
        let complete = self.bands.len() == count.div_ceil(pixels);
        let mut stokes = Vec::with_capacity(count);
        let (mut sum, mut variance) = (0.0, 0.0);
        for (&number, band) in &self.bands {
            stokes.resize((number as usize * pixels).min(count), [0.0; 4]);
            stokes.extend_from_slice(&band.stokes);
            sum += band.sum;
            variance += band.variance;
        }
        stokes.resize(count, [0.0; 4]);
        Picture {
            width: camera.width,
            height: camera.height,
            stokes,
            standard_error: if sum > 0.0 {
                (variance * count as f64).sqrt() / sum
            } else {
                0.0
            },
            complete,
        }
    }
}

/// Pixels of a band, so that a watcher is asked several times a second: fewer than a row of them where each takes many
/// walks, but enough for the threads.
fn band(camera: &Camera) -> usize {
    (STEP / camera.samples.max(1)).max(LEAST) as usize
}

/// Takes a picture of a scene, or a shard of it: `camera.samples` walks in each pixel, spread evenly over it. What is on
/// the film already is not taken again.
///
/// `settings` gives the model, the representation and the seed. `watch` is told the share that is done, 0 to 1, and may
/// keep the film as it is between two bands; an answer of [`Answer::Interrupt`] leaves the rest out. A source without
/// geometry has no size, and is not seen but by what it lights. The same scene, settings and camera give the same picture
/// on any number of threads and in any number of shards.
pub fn expose(
    scene: &Scene,
    camera: &Camera,
    settings: &Settings,
    shard: Shard,
    film: &mut Film,
    watch: &mut dyn FnMut(f64, &Film) -> Answer,
) {
    match representation_of(scene, settings) {
        Representation::Intensity => take::<1>(scene, camera, settings, shard, film, watch),
        Representation::Linear => take::<3>(scene, camera, settings, shard, film, watch),
        Representation::Full => take::<4>(scene, camera, settings, shard, film, watch),
    }
}

fn take<const N: usize>(
    scene: &Scene,
    camera: &Camera,
    settings: &Settings,
    shard: Shard,
    film: &mut Film,
    watch: &mut dyn FnMut(f64, &Film) -> Answer,
) {
    let emitters = Emitters::new(scene);
    let modelled = Modelled::alone(scene, settings.model);
    let passes = Passes {
        main: modelled.medium(scene, &emitters),
        apart: None,
        techniques: techniques(Estimator::Auto, &scene.surfaces, &[]).0,
    };
    // Beyond the replicas of the sensors, so that no walk is taken twice.
    let stream = Stream::new(settings.seed, REPLICAS);
    let count = camera.width as usize * camera.height as usize;
    let pixels = band(camera);
    let owned: Vec<u32> = (0..count.div_ceil(pixels) as u32)
        .filter(|&number| shard.owns(number))
        .collect();
    for (done, &number) in owned.iter().enumerate() {
        if watch(done as f64 / owned.len() as f64, film) == Answer::Interrupt {
            return;
        }
        let first = number as usize * pixels;
        film.bands.entry(number).or_insert_with(|| {
            let read: Vec<Pixel<N>> = (first..(first + pixels).min(count))
                .into_par_iter()
                .map(|index| pixel(&passes, camera, stream, index))
                .collect();
            Band::of(&read)
        });
    }
}

impl Band {
    fn of<const N: usize>(read: &[Pixel<N>]) -> Self {
        let padded = |pixel: &Pixel<N>| {
            std::array::from_fn(|component| {
                pixel.stokes.get(component).copied().unwrap_or(0.0) as f32
            })
        };
        Self {
            stokes: read.iter().map(padded).collect(),
            sum: read.iter().map(|pixel| pixel.stokes[0]).sum(),
            variance: read.iter().map(|pixel| pixel.variance).sum(),
        }
    }
}

/// A reading of one pixel.
struct Pixel<const N: usize> {
    stokes: [f64; N],
    /// Square of the standard error of S0.
    variance: f64,
}

fn pixel<const N: usize>(
    passes: &Passes,
    camera: &Camera,
    stream: Stream,
    index: usize,
) -> Pixel<N> {
    let stream = stream.branch(index as u64);
    let (column, row) = (index % camera.width as usize, index / camera.width as usize);
    let mut path = Path::default();
    let mut stokes = [0.0; N];
    let mut squares = 0.0;
    for sample in 0..camera.samples {
        let uniforms = stream.walk(sample);
        let [u, v, ..] = uniforms.at(0, Purpose::Launch);
        let direction = camera.direction(column as f64 + u, row as f64 + v);
        let receiver = Receiver::of_radiance(camera.position, direction, camera.right);
        let mut gathering = Gathering::<N>::new(&receiver, 0);
        let way = Way {
            techniques: passes.techniques,
            medium: passes.main,
            receiver,
            uniforms,
            aim: None,
            partners: None,
            member: None,
        };
        way.follow(&mut path, |path, part| {
            gathering.read(path, part, passes.main.first());
        });
        // Nobody else sees what a pixel does.
        let read = gathering.readings()[0].light();
        squares += read[0] * read[0];
        for (sum, value) in stokes.iter_mut().zip(read) {
            *sum += value;
        }
    }
    let walks = camera.samples as f64;
    let stokes = stokes.map(|sum| sum / walks);
    let spread = (squares / walks - stokes[0] * stokes[0]).max(0.0);
    Pixel {
        stokes,
        variance: spread / (walks - 1.0).max(1.0),
    }
}
