//! Rays through the Blender office: first hits and Θ between two points.

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

criterion_group!(benches, rays);
criterion_main!(benches);
