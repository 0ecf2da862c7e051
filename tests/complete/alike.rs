//! `auto` against plain `gather`: what one of them loses or counts twice, the other does not.

use crate::experiment::measured;
use malus_estimator::Reading;

/// One room by both estimators: the four components, and the differences to the scalar and the diffuse model.
#[track_caller]
fn agree(what: &str, room: &str, [auto, gather]: [u64; 2], ceiling: f64) {
    let by = |estimator: &str, samples: u64| {
        measured(&format!(
            "{room}
            [run]
            estimator = '{estimator}'
            representation = 'full'
            compare = ['scalar', 'diffuse']
            samples = {samples}"
        ))
    };
    let mut wrong = String::new();
    for (i, (one, other)) in by("auto", auto)
        .iter()
        .zip(by("gather", gather))
        .enumerate()
    {
        let scale = other.stokes[0];
        let parts = |r: &Reading| {
            let (scalar, diffuse) = (r.scalar.unwrap(), r.diffuse.unwrap());
            let stokes = (0..4).map(|c| (r.stokes[c], r.standard_error[c]));
            let differences = [
                (scalar.difference, scalar.difference_standard_error),
                (diffuse.difference, diffuse.difference_standard_error),
            ];
            stokes.chain(differences).collect::<Vec<_>>()
        };
        let names = ["S0", "S1", "S2", "S3", "ds0", "dd0"];
        for ((name, a), b) in names.iter().zip(parts(one)).zip(parts(&other)) {
            let z = (a.0 - b.0) / a.1.hypot(b.1).max(1e-12 * scale);
            if z.abs() >= 4.5 || a.1 > ceiling * scale || b.1 > ceiling * scale {
                wrong +=
                    &format!("\n{what}, sensor {i}, {name}: auto {a:?}, gather {b:?}: z = {z:.2}");
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

const LAMP: &str = "
    [[shape]]
    kind = 'rectangle'
    origin = [0.35, 0.3, 0.98]
    u = [0, 0.3, 0]
    v = [0.3, 0, 0]
    material = 'lamp'
    [material.lamp]
    rho = 0.2
    exitance = 5
    two_sided = false
";

const SENSORS: &str = "
    [[sensor]]
    name = 'floor'
    points = [[0.5, 0.5, 0], [0.97, 0.04, 0]]
    normal = [0, 0, 1]
    [[sensor]]
    name = 'beside a wall'
    points = [[0.003, 0.4, 0.6]]
    normal = [0.28, 0, 0.96]
    frame = 'fixed'
    axis = [0, 1, 0]
    [[sensor]]
    name = 'facing a wall'
    points = [[0.6, 0.98, 0.3]]
    normal = [0, 1, 0]
";

pub(super) fn room(wall: &str) -> String {
    format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [1, 1, 1]
        inward = true
        material = 'wall'
        [material.wall]
        {wall}
        {LAMP}
        {SENSORS}"
    )
}

const GLOSSY: &str = "rho = 0.6\na = 0.5\nn = 1.6";

#[test]
fn a_furnished_glossy_room_is_the_same_by_both_estimators() {
    let furniture = "
        [[shape]]
        kind = 'box'
        min = [0.15, 0.2, 0]
        max = [0.4, 0.5, 0.45]
        material = 'desk'
        [[shape]]
        kind = 'box'
        min = [0.7, 0.55, 0.2]
        max = [0.9, 0.85, 0.6]
        material = 'shelf'
        [material.desk]
        rho = 0.3
        a = 0.8
        n = 2.2
        [material.shelf]
        rho = 0.7";
    agree(
        "furnished",
        &(room(GLOSSY) + furniture),
        [16_384, 65_536],
        2e-2,
    );
}

#[test]
fn a_thin_wall_glossy_on_both_sides_is_the_same_by_both_estimators() {
    let wall = "
        [[shape]]
        kind = 'rectangle'
        origin = [0.45, 0, 0]
        u = [0.2, 0.7, 0]
        v = [0, 0, 0.8]
        material = 'thin'
        [material.thin]
        rho = 0.4
        a = 0.7
        n = 3";
    agree("thin wall", &(room(GLOSSY) + wall), [16_384, 65_536], 2e-2);
}

#[test]
fn a_curved_mirror_is_the_same_by_both_estimators() {
    let ball = "
        [[shape]]
        kind = 'sphere'
        centre = [0.4, 0.55, 0.3]
        radius = 0.22
        subdivisions = 3
        material = 'ball'
        [material.ball]
        rho = 0.3
        a = 0.9
        n = 0.183
        k = 3.43";
    agree("ball", &(room(GLOSSY) + ball), [32_768, 65_536], 2e-2);
}

#[test]
fn gold_and_a_polarised_lamp_are_the_same_by_both_estimators() {
    let lamp = "
        emission_stokes = [1, 0.4, -0.5, 0.6]
        emission_axis = [0.6, 0.8, 0]
        [[shape]]
        kind = 'rectangle'
        origin = [0.999, 0.2, 0.2]
        u = [0, 0, 0.6]
        v = [0, 0.7, 0]
        material = 'gold'
        [material.gold]
        rho = 0
        a = 1
        n = 0.183
        k = 3.43";
    let room = room("rho = 0.5").replace(
        "exitance = 5",
        &format!("exitance = 5\n{lamp}\n[material.x]"),
    );
    let room = room.replace("[material.x]\n    two_sided = false", "");
    agree("gold", &room, [16_384, 65_536], 2e-2);
}

#[test]
fn ideal_mirrors_and_black_backs_are_the_same_by_both_estimators() {
    let mirrors = "
        [[shape]]
        kind = 'rectangle'
        origin = [0, 0.001, 0.1]
        u = [0.9, 0, 0]
        v = [0, 0, 0.7]
        material = 'mirror'
        [[shape]]
        kind = 'rectangle'
        origin = [0.2, 0.8, 0.2]
        u = [0, 0, 0.5]
        v = [0.6, 0, 0]
        material = 'black backed'
        [material.mirror]
        rho = 0
        a = 1
        n = inf
        [material.'black backed']
        rho = 0.2
        a = 0.9
        n = inf
        two_sided = false";
    // The mirror at y = 0 faces −y, so its other side is the one in the room.
    agree(
        "ideal",
        &(room("rho = 0.5") + mirrors),
        [16_384, 65_536],
        2e-2,
    );
}

#[test]
fn several_lamps_of_several_states_are_the_same_by_both_estimators() {
    let lamps = "
        [[shape]]
        kind = 'sphere'
        centre = [0.2, 0.8, 0.5]
        radius = 0.06
        subdivisions = 2
        material = 'bulb'
        [[shape]]
        kind = 'rectangle'
        origin = [0.998, 0.6, 0.4]
        u = [0, 0, 0.2]
        v = [0, 0.2, 0]
        material = 'sign'
        [material.bulb]
        rho = 0.5
        a = 0.5
        n = 1.5
        exitance = 8
        emission_stokes = [1, 0, 0, 0.9]
        [material.sign]
        rho = 0.1
        exitance = 30
        emission_stokes = [1, -0.7, 0.2, 0]
        emission_axis = [0, 0, 1]";
    let metal = "rho = 0.4\na = 0.6\nn = 1.2\nk = 1.7";
    agree("lamps", &(room(metal) + lamps), [16_384, 65_536], 3e-2);
}

#[test]
fn walls_that_emit_and_mirror_are_the_same_by_both_estimators() {
    let glow = format!("{GLOSSY}\nexitance = 0.3\nemission_stokes = [1, 0.3, 0.3, 0.3]");
    agree("glow", &room(&glow), [16_384, 65_536], 2e-2);
}
