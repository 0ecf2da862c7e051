//! Rays through the Blender office: first hits, Θ between two points, and from one point to a grid of sensors.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use malus_scene::Scene;
use std::hint::black_box;
use std::path::Path;

/// Points spread evenly through the room (an additive recurrence), a metre off its walls.
fn points(count: u32) -> Vec<DVec3> {
    let steps = DVec3::new(
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_970_1,
    );
    (1..=count)
        .map(|i| {
            DVec3::new(0.5, 0.5, 0.5) + (steps * f64::from(i)).fract() * DVec3::new(5.0, 3.0, 1.8)
        })
        .collect()
}

fn rays(criterion: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/office.toml");
    let scene = Scene::load(&path, &[]).expect("the scene of this repository");
    let points = points(1024);
    let pairs: Vec<[DVec3; 2]> = points.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let mut group = criterion.benchmark_group("office");
    group.throughput(criterion::Throughput::Elements(pairs.len() as u64));
    group.bench_function("nearest", |bencher| {
        bencher.iter_batched_ref(
            || pairs.clone(),
            |pairs| {
                for [from, to] in pairs {
                    black_box(scene.surfaces.nearest(*from, (*to - *from).normalize()));
                }
            },
            BatchSize::SmallInput,
        );
    });
    group.bench_function("visible", |bencher| {
        bencher.iter_batched_ref(
            || pairs.clone(),
            |pairs| {
                for [from, to] in pairs {
                    black_box(scene.surfaces.visible(*from, *to));
                }
            },
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

fn sensors(criterion: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/office.toml");
    let scene = Scene::load(&path, &[]).expect("the scene of this repository");
    let grid: Vec<(DVec3, DVec3)> = (0..256)
        .map(|i| {
            let [x, y] = [i % 16, i / 16].map(f64::from);
            (DVec3::new(0.5 + 0.3 * x, 0.5 + 0.2 * y, 0.75), DVec3::Z)
        })
        .collect();
    let targets = scene.surfaces.targets(&grid);
    let from = points(64);
    let mut group = criterion.benchmark_group("office, a point to 256 sensors");
    group.throughput(criterion::Throughput::Elements(64 * 256));
    group.bench_function("in packets", |bencher| {
        let mut seen = Vec::new();
        bencher.iter(|| {
            for &point in &from {
                let surfaces = &scene.surfaces;
                surfaces.visible_from(point, DVec3::NEG_Z, &targets, &mut seen);
                black_box(&seen);
            }
        });
    });
    group.bench_function("one by one", |bencher| {
        bencher.iter(|| {
            for &point in &from {
                for &(sensor, _) in &grid {
                    black_box(point.z > sensor.z && scene.surfaces.visible(point, sensor));
                }
            }
        });
    });
    group.finish();
}

criterion_group!(benches, rays, sensors);
criterion_main!(benches);
