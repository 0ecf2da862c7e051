//! The same bytes whatever the threads, the steps and the interruptions.

use crate::experiment::{evaluate, readings, scene};
use malus_estimator::{Answer, Reading, Shard, State, Stop, resume, run};
use malus_scene::Scene;

fn room(estimator: &str, run: &str) -> Scene {
    scene(&format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [material.wall]
        rho = 0.6
        a = 0.5
        n = 1.8
        k = 0.5
        [[shape]]
        kind = 'sphere'
        centre = [0.4, 0.6, 0.7]
        radius = 0.1
        subdivisions = 2
        material = 'lamp'
        [material.lamp]
        rho = 0.1
        exitance = 3
        [[source]]
        kind = 'spot'
        position = [0.8, 0.2, 0.9]
        direction = [-0.3, 0.2, -1]
        intensity = 0.05
        cone_deg = 60
        blend = 0.3
        stokes = [1, 0.5, 0.1, 0.2]
        [[sensor]]
        name = 'floor'
        grid = {{ origin = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0], counts = [5, 5] }}
        normal = [0, 0, 1]
        [run]
        estimator = '{estimator}'
        compare = ['scalar', 'diffuse']
        {run}"
    ))
}

fn bits(readings: &[Reading]) -> Vec<u64> {
    readings
        .iter()
        .flat_map(|r| {
            let pairs = [r.scalar, r.diffuse].into_iter().flatten().flat_map(|p| {
                [
                    p.value,
                    p.standard_error,
                    p.difference,
                    p.difference_standard_error,
                ]
            });
            r.stokes
                .into_iter()
                .chain(r.standard_error)
                .chain([r.dolp, r.dolp_standard_error])
                .chain(pairs)
                .map(f64::to_bits)
                .collect::<Vec<_>>()
        })
        .collect()
}

fn on_threads(threads: usize, scene: &Scene) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    bits(&pool.install(|| readings(&evaluate(scene))))
}

#[test]
fn one_thread_and_many_give_the_same_bits() {
    for estimator in ["local", "gather"] {
        let scene = room(estimator, "samples = 5000");
        let one = on_threads(1, &scene);
        assert_eq!(one, on_threads(2, &scene));
        assert_eq!(one, on_threads(7, &scene));
    }
}

#[test]
fn an_interrupted_run_has_the_bits_of_one_asked_for_so_many_samples() {
    for estimator in ["local", "gather"] {
        let scene = room(estimator, "relative_error = 1e-9");
        let mut asked = 0;
        let results = run(&scene, &scene.settings, &mut |_| {
            asked += 1;
            if asked == 5 {
                Answer::Interrupt
            } else {
                Answer::Continue
            }
        });
        assert_eq!(results.stop, Stop::Interrupted);
        assert!(!results.complete);
        let whole = evaluate(&room(estimator, &format!("samples = {}", results.samples)));
        assert!(whole.complete);
        assert_eq!(whole.samples, results.samples);
        assert_eq!(bits(&readings(&whole)), bits(&readings(&results)));
    }
}

/// A shard, set aside after every second step.
fn in_pieces(scene: &Scene, shard: Shard) -> State {
    let mut state = State::new(shard);
    let mut asked = 0;
    loop {
        let results = resume(scene, &scene.settings, &mut state, &mut |_, _| {
            asked += 1;
            if asked % 2 == 0 {
                Answer::Interrupt
            } else {
                Answer::Continue
            }
        });
        if results.unwrap().complete {
            return state;
        }
    }
}

#[test]
fn shards_that_are_set_aside_and_joined_have_the_bits_of_a_run_in_one_piece() {
    for (estimator, cell) in [
        ("auto", ""),
        ("local", ""),
        ("gather", ""),
        ("direct", "cell = 0.1"),
    ] {
        let scene = room(estimator, &format!("samples = 1000\n{cell}"));
        let whole = evaluate(&scene);
        let shards = [2, 3, 1].map(|index| in_pieces(&scene, Shard::new(index, 3).unwrap()));
        let joined = shards
            .into_iter()
            .reduce(|one, other| one.merge(other).unwrap());
        let mut joined = joined.unwrap();
        assert_eq!(joined.samples(), whole.samples);
        let mut looks = 0;
        let results = resume(&scene, &scene.settings, &mut joined, &mut |_, _| {
            looks += 1;
            Answer::Continue
        });
        let results = results.unwrap();
        assert_eq!(
            looks, 1,
            "{estimator}: all samples are there, and some are taken again"
        );
        assert_eq!(
            bits(&readings(&results)),
            bits(&readings(&whole)),
            "{estimator}"
        );
        assert_eq!(results.energy, whole.energy, "{estimator}");
        assert_eq!(results.warnings, whole.warnings, "{estimator}");
        let errors = [&results, &whole].map(|it| it.relative_error_max.to_bits());
        assert_eq!(errors[0], errors[1], "{estimator}");
    }
}

#[test]
fn another_seed_differs_within_errors_only() {
    let first = readings(&evaluate(&room("gather", "samples = 8192")));
    let second = readings(&evaluate(&room("gather", "samples = 8192\nseed = 2")));
    for (a, b) in first.iter().zip(&second) {
        assert_ne!(a.stokes[0].to_bits(), b.stokes[0].to_bits());
        for i in 0..4 {
            let z = (a.stokes[i] - b.stokes[i]) / a.standard_error[i].hypot(b.standard_error[i]);
            assert!(z.abs() < 4.5, "S{i}: z = {z}");
        }
    }
}
