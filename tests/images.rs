//! Light of a source without size by its images in flat mirrors and panes: every chain drawn on paper, no walk taken.

use crate::experiment::{measured, repository};
use glam::DVec3;
use malus_estimator::Reading;
use malus_optics::{
    Basis, Carried, Emergence, Incidence, Index, Material, Reflection, Rotator, Sensor, Stokes,
    angle_of_incidence,
};

/// A rectangle that mirrors light, or lets it through.
#[derive(Clone)]
pub struct Flat {
    pub origin: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    pub material: Material,
}

/// A source: a point with an intensity, or parallel light that comes from a direction with an irradiance.
#[derive(Clone, Copy)]
pub struct Source {
    pub at: DVec3,
    pub finite: bool,
    pub strength: f64,
    pub state: [f64; 4],
    pub axis: DVec3,
}

/// A sensor of irradiance.
#[derive(Clone, Copy)]
pub struct Eye {
    pub at: DVec3,
    pub normal: DVec3,
    pub axis: DVec3,
    pub fixed: bool,
}

/// What mirrors a part of the light and scatters nothing.
pub fn mirror(fraction: f64, n: f64, k: f64) -> Material {
    Material::Mixture {
        rho: 0.0,
        fraction,
        index: Index::new(n, k),
    }
}

/// A point source of elliptically polarised light.
pub fn point(at: DVec3) -> Source {
    Source {
        at,
        finite: true,
        strength: 3.0,
        state: [1.0, 0.4, -0.5, 0.6],
        axis: DVec3::new(0.6, 0.8, 0.1),
    }
}

/// Parallel light of the same state from a direction.
pub fn parallel(from: DVec3) -> Source {
    Source {
        at: from.normalize(),
        finite: false,
        ..point(from)
    }
}

/// Sensors at places with their normals, each with both frames.
pub fn eyes(places: &[(DVec3, DVec3)]) -> Vec<Eye> {
    let both = |&(at, normal): &(DVec3, DVec3)| {
        [false, true].map(|fixed| Eye {
            at,
            normal: normal.normalize(),
            axis: DVec3::new(0.1, 0.9, 0.3),
            fixed,
        })
    };
    places.iter().flat_map(both).collect()
}

impl Flat {
    fn normal(&self) -> DVec3 {
        self.u.cross(self.v).normalize()
    }

    /// The share of the way along `toward` at which the rectangle is crossed.
    fn crossing(&self, from: DVec3, toward: DVec3) -> Option<f64> {
        let normal = self.normal();
        let share = (self.origin - from).dot(normal) / toward.dot(normal);
        let at = from + toward * share - self.origin;
        let across = self.u.cross(self.v);
        // The two sides need not stand across each other.
        let along =
            |one: DVec3, other: DVec3| one.cross(other).dot(across) / across.length_squared();
        let inside = |part: f64| (0.0..=1.0).contains(&part);
        let within = inside(along(at, self.v)) && inside(along(self.u, at));
        (share > 1e-9 && share.is_finite() && within).then_some(share)
    }

    fn image(&self, point: DVec3, finite: bool) -> DVec3 {
        let normal = self.normal();
        let origin = if finite { self.origin } else { DVec3::ZERO };
        point - normal * (2.0 * (point - origin).dot(normal))
    }
}

/// A mirror or a pane on the way, as tracing from the sensor meets it.
struct Met {
    flat: usize,
    /// Direction in which light leaves it.
    leaving: DVec3,
    through: bool,
}

/// The way from the sensor to the source by one chain: what is met, the direction at its start and that at its end.
fn way(
    flats: &[Flat],
    source: &Source,
    eye: &Eye,
    chain: &[usize],
) -> Option<(Vec<Met>, DVec3, DVec3, f64)> {
    let image = chain
        .iter()
        .rev()
        .fold(source.at, |at, &f| flats[f].image(at, source.finite));
    let span = if source.finite { image - eye.at } else { image };
    let start = span.normalize();
    let (mut from, mut toward) = (eye.at, start);
    let mut met = Vec::new();
    let mut next = chain.iter().copied();
    let mut wanted = next.next();
    let mut last = None;
    // What is left of the way to the image, which may stand before a mirror.
    let mut left = if source.finite {
        span.length()
    } else {
        f64::INFINITY
    };
    loop {
        let first = (0..flats.len())
            .filter(|&f| last != Some(f))
            .filter_map(|f| Some((flats[f].crossing(from, toward)?, f)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((share, flat)) = first.filter(|&(share, _)| share < left) else {
            let there = wanted.is_none();
            return there.then_some((met, start, toward, span.length_squared()));
        };
        let through = wanted != Some(flat);
        if through && !flats[flat].material.is_pane() {
            return None;
        }
        met.push(Met {
            flat,
            leaving: -toward,
            through,
        });
        from += toward * share;
        left -= share;
        last = Some(flat);
        if !through {
            let normal = flats[flat].normal();
            toward -= normal * (2.0 * toward.dot(normal));
            wanted = next.next();
        }
    }
}

/// What arrives by one chain.
fn arriving(flats: &[Flat], source: &Source, eye: &Eye, chain: &[usize]) -> Option<[f64; 4]> {
    let (met, start, end, square) = way(flats, source, eye, chain)?;
    let cos = start.dot(eye.normal);
    if cos <= 0.0 {
        return None;
    }
    let mut light = Stokes::<4, Carried>::new(source.state);
    let mut basis = Basis::<Carried>::new(-end, source.axis);
    for met in met.iter().rev() {
        let flat = &flats[met.flat];
        let side = flat.normal();
        let direction = basis.direction();
        let normal = if direction.dot(side) < 0.0 {
            side
        } else {
            -side
        };
        let (cos, sin2) = angle_of_incidence(direction, normal);
        let (incidence, emergence) = Basis::<Incidence>::mirror(direction, normal);
        let (matrix, onward): (Reflection, _) = if met.through {
            let onward = Basis::<Emergence>::new(direction, incidence.axis());
            (flat.material.through(cos, sin2), onward)
        } else {
            (flat.material.mirror(cos, sin2), emergence)
        };
        light = (matrix * (Rotator::new(&basis, &incidence) * light)).carried();
        basis = onward.carried();
        assert!(
            basis.direction().distance(met.leaving) < 1e-9,
            "a way does not close"
        );
    }
    let direction = -start;
    let sensor = if eye.fixed {
        Basis::<Sensor>::new(direction, eye.axis)
    } else {
        Basis::<Sensor>::in_plane_of_incidence(direction, eye.normal, eye.axis)
    };
    let square = if source.finite { square } else { 1.0 };
    let irradiance = source.strength * cos / square;
    let light = Rotator::new(&basis, &sensor) * light;
    Some(light.components().map(|c| c * irradiance))
}

/// The irradiance Stokes vector by all chains of at most `longest` mirrors, that straight from the source included.
pub fn by_images(flats: &[Flat], source: &Source, eye: &Eye, longest: usize) -> [f64; 4] {
    let mut sum = [0.0; 4];
    let mut chains = vec![Vec::new()];
    for length in 0..=longest {
        for chain in &chains {
            for (sum, c) in sum
                .iter_mut()
                .zip(arriving(flats, source, eye, chain).unwrap_or_default())
            {
                *sum += c;
            }
        }
        if length < longest {
            chains = chains
                .iter()
                .flat_map(|chain: &Vec<usize>| {
                    let others = (0..flats.len()).filter(|f| chain.last() != Some(f));
                    others.map(|f| chain.iter().copied().chain([f]).collect())
                })
                .collect();
        }
    }
    sum
}

fn triple(v: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

fn described(material: &Material) -> String {
    match *material {
        Material::Mixture {
            rho,
            fraction,
            index,
        } => {
            let (n, k) = match index {
                Index::Mirror => ("inf".to_owned(), 0.0),
                Index::Relative { n, k, .. } => (format!("{n:?}"), k),
            };
            format!("rho = {rho:?}\na = {fraction:?}\nn = {n}\nk = {k:?}")
        }
        Material::Pane { n, tau } => format!("kind = 'pane'\nn = {n:?}\ntau = {tau:?}"),
        Material::Coated(coated) => {
            format!(
                "kind = 'coated'\nrho = {:?}\nn = {:?}",
                coated.rho(),
                coated.n()
            )
        }
    }
}

/// The scene file of mirrors, sources and sensors, but for its `[run]`.
pub fn written(flats: &[Flat], sources: &[Source], eyes: &[Eye]) -> String {
    let mut text = String::new();
    for (i, flat) in flats.iter().enumerate() {
        let (origin, u, v) = (triple(flat.origin), triple(flat.u), triple(flat.v));
        text += &format!(
            "[[shape]]\nkind = 'rectangle'\norigin = {origin}\nu = {u}\nv = {v}\nmaterial = 'm{i}'\n\
             [material.m{i}]\n{}\n",
            described(&flat.material)
        );
    }
    for source in sources {
        let (at, strength) = (source.at, source.strength);
        text += &if source.finite {
            format!(
                "[[source]]\nkind = 'point'\nposition = {}\nintensity = {strength:?}\n",
                triple(at)
            )
        } else {
            format!(
                "[[source]]\nkind = 'distant'\ndirection = {}\nirradiance = {strength:?}\n",
                triple(-at)
            )
        };
        text += &format!(
            "stokes = {:?}\naxis = {}\n",
            source.state,
            triple(source.axis)
        );
    }
    for (i, eye) in eyes.iter().enumerate() {
        let (at, normal, axis) = (triple(eye.at), triple(eye.normal), triple(eye.axis));
        let frame = if eye.fixed { "fixed" } else { "incidence" };
        text += &format!(
            "[[sensor]]\nname = 's{i}'\npoints = [{at}]\nnormal = {normal}\nframe = '{frame}'\naxis = {axis}\n"
        );
    }
    text
}

/// Asserts all components within 4.5 standard errors, beside `digits` of S0, and the errors within `ceiling` of S0.
#[track_caller]
pub fn assert_stokes(what: &str, reading: &Reading, exact: [f64; 4], digits: f64, ceiling: f64) {
    for i in 0..4 {
        let (value, error) = (reading.stokes[i], reading.standard_error[i]);
        let off = (value - exact[i]).abs();
        assert!(
            off <= 4.5 * error + digits * exact[0],
            "{what}: S{i} = {value} ± {error}, exactly {} of {exact:?}: z = {:.2}, {:.1e} of S0",
            exact[i],
            off / error,
            off / exact[0]
        );
        assert!(
            error <= ceiling * exact[0],
            "{what}: S{i} = {value} ± {error} is {:.1e} of S0 = {}, above {ceiling:.1e}",
            error / exact[0],
            exact[0]
        );
    }
}

/// Runs mirrors and sources at all sensors and holds them against their images.
#[track_caller]
pub fn assert_images(
    what: &str,
    flats: &[Flat],
    sources: &[Source],
    eyes: &[Eye],
    longest: usize,
    samples: u64,
    ceiling: f64,
) {
    let text = written(flats, sources, eyes);
    let run = format!("[run]\nrepresentation = 'full'\nsamples = {samples}");
    let readings = measured(&format!("{text}{run}"));
    for (i, (reading, eye)) in readings.iter().zip(eyes).enumerate() {
        let mut exact = [0.0; 4];
        for source in sources {
            let light = by_images(flats, source, eye, longest);
            for (sum, c) in exact.iter_mut().zip(light) {
                *sum += c;
            }
        }
        // A source is moved by a billionth of the scene before its images are drawn.
        assert_stokes(
            &format!("{what}, sensor {i}"),
            reading,
            exact,
            1e-7,
            ceiling,
        );
    }
}

/// The transmittances of CIE 171, case 5.5: degrees, Ts, Tp.
pub fn slab() -> Vec<(f64, f64, f64)> {
    let text = std::fs::read_to_string(repository("tests/data/cie171.json")).unwrap();
    let table: serde_json::Value = serde_json::from_str(&text).unwrap();
    let cases = table["cases"].as_array().unwrap();
    let case = cases.iter().find(|case| case["id"] == "5.5-slab").unwrap();
    let rows = case["expected"].as_object().unwrap().iter();
    let row = |(degrees, row): (&String, &serde_json::Value)| {
        let number = |key: &str| row[key].as_f64().unwrap();
        (degrees.parse().unwrap(), number("Ts"), number("Tp"))
    };
    rows.map(row).collect()
}
