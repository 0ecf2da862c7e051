//! The paper's "80-90 times": what local estimates save against direct modelling, and what the whole estimator saves.

use crate::closed::measured;
use std::time::Instant;

/// The paper's room, with a sensor in the middle of its floor.
fn room(a: &str) -> String {
    format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [[shape]]
        kind = 'disc'
        centre = [0.5, 0.5, 1]
        normal = [0, 0, -1]
        radius = 0.05
        material = 'lamp'
        [material.wall]
        rho = 0.5
        a = {a}
        [material.lamp]
        rho = 0
        exitance = 1
        [[sensor]]
        name = 'centre'
        points = [[0.5, 0.5, 0]]
        normal = [0, 0, 1]"
    )
}

/// Sobolev's planes, wide enough that their rim does not matter, with a sensor at a distance of 1 from the source's foot.
fn planes() -> String {
    "[[shape]]
    kind = 'rectangle'
    origin = [-50, -50, 0]
    u = [100, 0, 0]
    v = [0, 100, 0]
    material = 'plane'
    [[shape]]
    kind = 'rectangle'
    origin = [-50, -50, 1]
    u = [0, 100, 0]
    v = [100, 0, 0]
    material = 'plane'
    [material.plane]
    rho = 0.5
    [[source]]
    kind = 'point'
    position = [0, 0, 0.5]
    intensity = 1
    [[sensor]]
    name = 'aside'
    points = [[1, 0, 0]]
    normal = [0, 0, 1]"
        .into()
}

/// One setting: variance × time of a scene's first point, relative to the square of its value, and its value.
fn cost(scene: &str, settings: &str) -> (f64, f64, f64) {
    let toml = format!("{scene}\n[run]\ncompare = []\n{settings}");
    let started = Instant::now();
    let reading = measured(&toml)[0];
    let seconds = started.elapsed().as_secs_f64();
    let relative = reading.standard_error[0] / reading.stokes[0];
    (relative * relative * seconds, reading.stokes[0], relative)
}

pub fn print() {
    println!("\n## Local estimates against direct modelling\n");
    println!(
        "The paper says that local estimates are 80-90 times faster than direct modelling. The measure is variance × time at one point, so that twice as fast to the same error is a ratio of two. \
         Direct modelling counts walks in a cell, and every halving of the cell's side costs four times as many walks: the ratio is whatever one makes of the cell. Times are of one run each on a machine with other work; ratios are good to a third or so.\n"
    );
    println!("| scene, point | cell, m | bias of the cell | direct / local | direct / auto |");
    println!("|---|---|---|---|---|");
    let scenes = [
        ("Sobolev's planes, ρ = 0.5, r = 1", planes()),
        ("paper's room, a = 0, centre of the floor", room("0")),
        ("paper's room, a = 0.6, centre of the floor", room("0.6")),
    ];
    for (name, scene) in &scenes {
        let (local, _, _) = cost(scene, "estimator = 'local'\nsamples = 1048576");
        let (auto, exact, _) = cost(scene, "estimator = 'auto'\nsamples = 524288");
        for cell in ["0.2", "0.1", "0.05", "0.02"] {
            let settings = format!("estimator = 'direct'\ncell = {cell}\nsamples = 8388608");
            let (direct, value, relative) = cost(scene, &settings);
            println!(
                "| {name} | {cell} | {:+.2} ± {:.2} % | {:.0} | {:.0} |",
                100.0 * (value / exact - 1.0),
                100.0 * relative,
                direct / local,
                direct / auto
            );
        }
    }
    println!(
        "\nAt a = 0.6 `local` does not see light whose last reflection is mirror-like, so its column is the cost of a smaller quantity."
    );
}
