//! Whole runs to a relative error of 1 %: the paper's nine points and a furnished office, solve time alone.

use criterion::{Criterion, criterion_group, criterion_main};
use malus_estimator::{Answer, run};
use malus_scene::{Override, Scene};
use std::hint::black_box;
use std::path::Path;

fn scene(file: &str, changes: &[(&str, &str)]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let overrides: Vec<Override> = changes
        .iter()
        .map(|(key, value)| Override {
            key: (*key).into(),
            value: (*value).into(),
        })
        .collect();
    Scene::load(&path, &overrides).expect("a scene of this repository")
}

fn to_one_percent(criterion: &mut Criterion, name: &str, scene: &Scene) {
    let mut settings = scene.settings.clone();
    settings.samples = None;
    settings.relative_error = Some(0.01);
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| black_box(run(scene, &settings, &mut |_| Answer::Continue)));
    });
}

fn runs(criterion: &mut Criterion) {
    let unit_room = scene(
        "scenes/unit-room.toml",
        &[("material.plaster.a", "0"), ("run.compare", "[]")],
    );
    to_one_percent(
        criterion,
        "unit room, a = 0, nine points to 1 %",
        &unit_room,
    );
    let office = scene("tests/data/reference_office.toml", &[("run.compare", "[]")]);
    to_one_percent(criterion, "reference office, 264 points to 1 %", &office);
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = runs
}
criterion_main!(benches);
