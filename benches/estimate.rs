//! Inner loops of light at a surface, and whole runs: by number of components on the same walks, by estimator, and to a
//! relative error of 1 %; solve time alone. Ratios that are claimed come from `benches/scaling.py`, which alternates.

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use malus_estimator::{Answer, run};
use malus_optics::{Basis, Carried, Incidence, Index, Rotator, Stokes, angle_of_incidence};
use malus_scene::{Override, Scene};
use std::hint::black_box;
use std::path::Path;

fn scene(file: &str, changes: &[(&str, &str)]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let overrides: Vec<Override> = changes
        .iter()
        .chain(&[("run.compare", "[]")])
        .map(|(key, value)| Override {
            key: (*key).into(),
            value: (*value).into(),
        })
        .collect();
    Scene::load(&path, &overrides).expect("a scene of this repository")
}

/// Directions of incidence on a plane z = 0, from steep to grazing.
fn directions() -> Vec<DVec3> {
    (0..256)
        .map(|i| {
            let (azimuth, cos) = (f64::from(i) * 2.4, (f64::from(i) + 0.5) / 256.0);
            let sin = (1.0 - cos * cos).sqrt();
            DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), -cos)
        })
        .collect()
}

/// Light of each direction from its own basis into the plane of incidence and off the surface.
fn reflected<const N: usize>(index: Index, directions: &[DVec3]) -> f64 {
    directions
        .iter()
        .map(|&direction| {
            let beam = Basis::<Carried>::new(direction, DVec3::X);
            let (incidence, _) = Basis::<Incidence>::mirror(direction, DVec3::Z);
            let (cos, sin2) = angle_of_incidence(direction, DVec3::Z);
            let arriving = Rotator::new(&beam, &incidence) * Stokes::<N, _>::unpolarised(1.0);
            (index.reflection(cos, sin2) * arriving).components()[0]
        })
        .sum()
}

fn inner_loops(criterion: &mut Criterion) {
    let directions = directions();
    let mut group = criterion.benchmark_group("reflection");
    group.throughput(criterion::Throughput::Elements(directions.len() as u64));
    for (name, index) in [
        ("glass", Index::new(1.5, 0.0)),
        ("gold", Index::new(0.183, 3.43)),
    ] {
        let mut bench = |components: usize, of: fn(Index, &[DVec3]) -> f64| {
            group.bench_function(BenchmarkId::new(name, components), |bencher| {
                bencher.iter_batched_ref(
                    || directions.clone(),
                    |directions| black_box(of(index, directions)),
                    BatchSize::SmallInput,
                );
            });
        };
        bench(1, reflected::<1>);
        bench(3, reflected::<3>);
        bench(4, reflected::<4>);
    }
    group.finish();
}

fn representations(criterion: &mut Criterion) {
    for (name, file, samples) in [
        ("unit room", "scenes/unit-room.toml", "16384"),
        ("office", "scenes/office.toml", "256"),
    ] {
        let mut group = criterion.benchmark_group(format!("same walks, {name}"));
        for components in ["intensity", "linear", "full"] {
            let scene = scene(
                file,
                &[("run.representation", components), ("run.samples", samples)],
            );
            group.bench_function(components, |bencher| {
                bencher.iter(|| black_box(run(&scene, &scene.settings, &mut |_| Answer::Continue)));
            });
        }
        group.finish();
    }
}

fn estimators(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("16,384 samples, unit room");
    for estimator in ["auto", "gather", "local", "direct"] {
        let changes = [("run.estimator", estimator), ("run.samples", "16384")];
        let scene = scene("scenes/unit-room.toml", &changes);
        group.bench_function(estimator, |bencher| {
            bencher.iter(|| black_box(run(&scene, &scene.settings, &mut |_| Answer::Continue)));
        });
    }
    group.finish();
}

fn to_one_percent(criterion: &mut Criterion) {
    for (name, file, changes) in [
        (
            "unit room, a = 0, nine points to 1 %",
            "scenes/unit-room.toml",
            &[("material.plaster.a", "0")][..],
        ),
        (
            "unit room, a = 0.6, nine points to 1 %",
            "scenes/unit-room.toml",
            &[],
        ),
        (
            "reference office, 264 points to 1 %",
            "tests/data/reference_office.toml",
            &[],
        ),
    ] {
        let scene = scene(file, changes);
        let mut settings = scene.settings.clone();
        settings.samples = None;
        settings.relative_error = Some(0.01);
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| black_box(run(&scene, &settings, &mut |_| Answer::Continue)));
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = inner_loops, representations, estimators, to_one_percent
}
criterion_main!(benches);
