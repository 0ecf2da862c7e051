//! What a camera sees.

use crate::choose::techniques;
use crate::emitters::Emitters;
use crate::evaluate::Gathering;
use crate::gather::Way;
use crate::pass::{Modelled, Passes};
use crate::random::{Purpose, Stream};
use crate::receiver::Receiver;
use crate::results::Answer;
use crate::run::representation_of;
use crate::statistics::REPLICAS;
use crate::trace::Path;
use malus_optics::Representation;
use malus_scene::{Camera, Estimator, Scene, Settings};
use rayon::prelude::*;

/// Walks that a step takes in all, so that a watcher is asked several times a second.
const STEP: u64 = 1 << 17;

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

/// Takes a picture of a scene: `camera.samples` walks in each pixel, spread evenly over it.
///
/// `settings` gives the model, the representation and the seed. `watch` is told the share of the picture that is done, 0
/// to 1; an answer of [`Answer::Interrupt`] leaves the rest black. A source without geometry has no size, and is not seen
/// but by what it lights. The same scene, settings and camera give the same picture on any number of threads.
pub fn picture(
    scene: &Scene,
    camera: &Camera,
    settings: &Settings,
    watch: &mut dyn FnMut(f64) -> Answer,
) -> Picture {
    match representation_of(scene, settings) {
        Representation::Intensity => taken::<1>(scene, camera, settings, watch),
        Representation::Linear => taken::<3>(scene, camera, settings, watch),
        Representation::Full => taken::<4>(scene, camera, settings, watch),
    }
}

fn taken<const N: usize>(
    scene: &Scene,
    camera: &Camera,
    settings: &Settings,
    watch: &mut dyn FnMut(f64) -> Answer,
) -> Picture {
    let emitters = Emitters::new(scene);
    let modelled = Modelled::alone(scene, settings.model);
    let passes = Passes {
        main: modelled.medium(scene, &emitters),
        apart: None,
        techniques: techniques(Estimator::Auto, &[]).0,
    };
    // Beyond the replicas of the sensors, so that no walk is taken twice.
    let stream = Stream::new(settings.seed, REPLICAS);
    let width = camera.width as usize;
    let mut picture = Picture {
        width: camera.width,
        height: camera.height,
        stokes: vec![[0.0; 4]; width * camera.height as usize],
        standard_error: 0.0,
        complete: true,
    };
    let rows = (STEP / (camera.samples * u64::from(camera.width)).max(1)).max(1) as usize;
    let (mut sum, mut variance) = (0.0, 0.0);
    let count = picture.stokes.len();
    for (part, pixels) in picture.stokes.chunks_mut(rows * width).enumerate() {
        let first = part * rows * width;
        if watch(first as f64 / count as f64) == Answer::Interrupt {
            picture.complete = false;
            break;
        }
        let read: Vec<Pixel<N>> = (first..first + pixels.len())
            .into_par_iter()
            .map(|index| pixel(&passes, camera, stream, index))
            .collect();
        for (pixel, read) in pixels.iter_mut().zip(read) {
            for (component, value) in pixel.iter_mut().zip(read.stokes) {
                *component = value as f32;
            }
            sum += read.stokes[0];
            variance += read.variance;
        }
    }
    if sum > 0.0 {
        picture.standard_error = (variance * count as f64).sqrt() / sum;
    }
    picture
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
        let mut gathering = Gathering::<N>::new(&receiver);
        let way = Way {
            techniques: passes.techniques,
            medium: passes.main,
            receiver,
            uniforms,
            aim: None,
        };
        way.follow(&mut path, |path, part| {
            gathering.read(path, part, passes.main.first());
        });
        let read = gathering.sum();
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
