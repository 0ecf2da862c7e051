//! Where the flux goes: what is emitted is absorbed, escapes, or is cut off.

use crate::cli::Folder;
use crate::experiment::{assert_estimate, assert_exact, evaluate, scene};
use malus_estimator::{Energy, Results};
use serde_json::Value;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

fn results(toml: &str) -> Results {
    evaluate(&scene(toml))
}

/// Asserts that the books close to within 4.5 standard errors, and that these are at most `ceiling` of what is emitted.
#[track_caller]
fn assert_closed(what: &str, energy: &Energy, ceiling: f64) {
    let (missing, error) = (energy.missing(), energy.standard_error);
    // Sums of some 10⁶ terms are rounded.
    let rounding = 1e-12 * energy.emitted;
    assert!(
        missing.abs() <= 4.5 * error + rounding,
        "{what}: {missing} ± {error} of {}",
        energy.emitted
    );
    assert!(
        error <= ceiling * energy.emitted,
        "{what}: ± {error} of {}",
        energy.emitted
    );
    let sum: f64 = energy.by_material.iter().map(|it| it.flux).sum();
    assert!((sum - energy.absorbed).abs() <= rounding, "{what}");
}

fn absorbed(energy: &Energy, material: &str) -> (f64, f64) {
    let mut materials = energy.by_material.iter();
    let found = materials.find(|it| it.material == material).unwrap();
    (found.flux, found.standard_error)
}

const BOX: &str = "
    [[shape]]
    kind = 'box'
    min = [0, 0, 0]
    max = [2, 1, 1]
    inward = true
    material = 'wall'
    [[sensor]]
    name = 'floor'
    grid = { origin = [0, 0, 0], u = [2, 0, 0], v = [0, 1, 0], counts = [8, 4] }
    normal = [0, 0, 1]
";

const POLARISED_SPOT: &str = "
    [[source]]
    kind = 'spot'
    position = [0.5, 0.5, 0.9]
    direction = [0.5, 0.1, -1]
    intensity = 2
    cone_deg = 80
    blend = 0.4
    stokes = [1, 0.6, 0.2, 0.5]
";

const WALLS: [(&str, &str); 5] = [
    ("diffuse", "rho = 0.7"),
    ("glossy", "rho = 0.7\na = 0.6"),
    ("dense", "rho = 0.9\na = 0.9\nn = 3"),
    ("metal", "rho = 0.3\na = 0.8\nn = 0.183\nk = 3.43"),
    ("mirror", "rho = 0.5\na = 0.5\nn = inf"),
];

#[test]
fn books_close_in_a_closed_room_for_every_reflector_model_and_estimator() {
    for (name, wall) in WALLS {
        let others = [
            "estimator = 'gather'",
            "model = 'scalar'\nestimator = 'local'",
            "model = 'diffuse'\nestimator = 'local'",
        ];
        let others = others.into_iter().filter(|_| name == "metal");
        for run in others.chain(["estimator = 'local'"]) {
            let toml = format!(
                "{BOX}{POLARISED_SPOT}[material.wall]\n{wall}\n[run]\nsamples = 8192\n{run}"
            );
            let results = results(&toml);
            let energy = &results.energy;
            assert_closed(&format!("{name}, {run}"), energy, 2e-2);
            assert!(energy.escaped <= 0.0 && energy.truncated <= 0.0);
            let told = results.warnings.join("\n");
            assert!(!told.contains("leaves the scene"), "{told}");
        }
    }
}

/// A lamp half hidden, a screen with a black back, and an open side.
#[test]
fn books_close_in_an_open_scene() {
    let toml = format!(
        "[[shape]]
        kind = 'rectangle'
        origin = [0, 0, 0]
        u = [2, 0, 0]
        v = [0, 2, 0]
        material = 'floor'
        [[shape]]
        kind = 'rectangle'
        origin = [0, 0, 2]
        u = [0, 1, 0]
        v = [1, 0, 0]
        material = 'lamp'
        [[shape]]
        kind = 'rectangle'
        origin = [0, 0, 2]
        u = [0, 1, 0]
        v = [0.5, 0, 0]
        material = 'shade'
        [[shape]]
        kind = 'rectangle'
        origin = [1.2, 0, 0]
        u = [0, 2, 0]
        v = [0, 0, 1.5]
        material = 'screen'
        {POLARISED_SPOT}
        [[source]]
        kind = 'distant'
        direction = [-1, -0.3, -0.5]
        irradiance = 1.5
        stokes = [1, -0.8, 0.1, 0]
        [material.floor]
        rho = 0.6
        a = 0.5
        [material.lamp]
        rho = 0.2
        exitance = 3
        emission_stokes = [1, 0.3, 0, 0]
        [material.shade]
        rho = 0.5
        [material.screen]
        rho = 0.9
        a = 0.7
        n = 2
        k = 1
        two_sided = false
        [[sensor]]
        name = 'floor'
        points = [[0.5, 0.5, 0], [1.5, 0.5, 0]]
        normal = [0, 0, 1]
        [run]
        samples = 65536"
    );
    let results = results(&toml);
    let energy = &results.energy;
    assert_closed("open", energy, 1e-2);
    assert!(energy.escaped > 0.1 * energy.emitted);
    let told = results.warnings.join("\n");
    assert!(!told.contains("leaves the scene"), "{told}");
}

/// Half of the lamp is hidden by a shade that lies in it: M times the other half.
#[test]
fn what_is_emitted_is_exact() {
    let toml = format!(
        "{BOX}
        [material.wall]
        rho = 0.5
        [[shape]]
        kind = 'rectangle'
        origin = [0.5, 0.2, 1]
        u = [0, 0.5, 0]
        v = [0.5, 0, 0]
        material = 'lamp'
        [[shape]]
        kind = 'rectangle'
        origin = [0.5, 0.2, 1]
        u = [0, 0.5, 0]
        v = [0.25, 0, 0]
        material = 'shade'
        [material.lamp]
        rho = 0
        exitance = 8
        [material.shade]
        rho = 0
        [[source]]
        kind = 'point'
        position = [1, 0.5, 0.5]
        intensity = 2
        [run]
        samples = 4096"
    );
    let energy = results(&toml).energy;
    assert_exact("emitted", energy.emitted, 8.0 * 0.125 + 8.0 * PI, 1e-12);
    assert_closed("shaded lamp", &energy, 2e-2);
}

/// Between two infinite Lambert planes, as a box with ideal mirrors for side walls, plane 1 receives
/// 2π I0 (1 + ρ2)/(1 − ρ1 ρ2) and keeps 1 − ρ1 of it.
#[test]
fn each_of_two_planes_absorbs_its_share() {
    let toml = "
        [[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = [20, 20, 1]
        inward = true
        material = 'mirror'
        [[shape]]
        kind = 'rectangle'
        origin = [0, 0, 0]
        u = [20, 0, 0]
        v = [0, 20, 0]
        material = 'one'
        [[shape]]
        kind = 'rectangle'
        origin = [0, 0, 1]
        u = [0, 20, 0]
        v = [20, 0, 0]
        material = 'two'
        [material.mirror]
        rho = 0
        a = 1
        n = inf
        [material.one]
        rho = 0.3
        [material.two]
        rho = 0.8
        [[source]]
        kind = 'point'
        position = [4, 11, 0.4]
        intensity = 1
        [[sensor]]
        name = 'floor'
        grid = { origin = [0, 0, 0], u = [20, 0, 0], v = [0, 20, 0], counts = [8, 8] }
        normal = [0, 0, 1]
        [run]
        samples = 65536";
    let energy = results(toml).energy;
    assert_closed("planes", &energy, 3e-3);
    let many = 1.0 - 0.3 * 0.8;
    let one = 2.0 * PI * 1.8 / many * 0.7;
    let two = 2.0 * PI * 1.3 / many * 0.2;
    assert_estimate("one", absorbed(&energy, "one"), one, 5e-3);
    assert_estimate("two", absorbed(&energy, "two"), two, 1e-2);
    assert!(absorbed(&energy, "mirror").0.abs() < 1e-12);
}

/// A point source in a black room, and a mirroring ball of half its distance as radius: the ball meets (1 − √3/2)/2 of the flux,
/// and sends all of it on to where no technique can find it.
#[test]
fn light_that_no_technique_finds_is_measured() {
    let room = |estimator: &str| {
        results(&format!(
            "[[shape]]
            kind = 'box'
            min = [-3, -3, -3]
            max = [3, 3, 3]
            inward = true
            material = 'wall'
            [[shape]]
            kind = 'sphere'
            centre = [1, 0, 0]
            radius = 0.5
            subdivisions = 6
            material = 'mirror'
            [material.wall]
            rho = 0
            [material.mirror]
            rho = 0
            a = 1
            n = inf
            [[source]]
            kind = 'point'
            position = [0, 0, 0]
            intensity = 1
            [[sensor]]
            name = 'floor'
            grid = {{ origin = [-2, -2, -3], u = [4, 0, 0], v = [0, 4, 0], counts = [8, 8] }}
            normal = [0, 0, 1]
            [run]
            {estimator}
            samples = 16384"
        ))
    };
    let met = 0.5 - 0.25 * 3.0_f64.sqrt();
    let exact = met / (1.0 + met);
    for estimator in ["local", "gather", "auto"] {
        let results = room(&format!("estimator = '{estimator}'"));
        let unseen = results.unseen.unwrap();
        // The facets lie within 10⁻⁴ of the ball; the largest 64 of 41,000 `auto` does look into.
        let error = unseen.standard_error.hypot(2e-3 * exact);
        assert_estimate(estimator, (unseen.share, error), exact, 0.05);
        assert!(unseen.at_most > unseen.share);
        assert!(results.warnings[0].contains("on average over all surfaces that is"));
    }
    assert!(room("estimator = 'direct'\ncell = 0.5").unseen.is_none());
}

/// A plate of glass in parallel light at 45° keeps 1 − Rs of s-polarised and 1 − Rp of p-polarised light, Rs = 0.09201336,
/// Rp = Rs²; of the scalar model's walks, 1 − (Rs + Rp)/2 of either.
#[test]
fn what_glass_absorbs_depends_on_the_polarisation() {
    let rs = 0.092_013_36_f64;
    for (model, s1, kept) in [
        ("polarised", 1.0, 1.0 - rs),
        ("polarised", -1.0, 1.0 - rs * rs),
        ("scalar", 1.0, 1.0 - 0.5 * (rs + rs * rs)),
    ] {
        let toml = format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [-1, -1, 0]
            u = [2, 0, 0]
            v = [0, 2, 0]
            material = 'glass'
            [material.glass]
            rho = 0
            a = 1
            n = 1.5
            [[source]]
            kind = 'distant'
            direction = [1, 0, -1]
            irradiance = 10
            stokes = [1, {s1}, 0, 0]
            axis = [0, 1, 0]
            [[sensor]]
            name = 'above'
            points = [[0, 0, 0.5]]
            normal = [0, 0, 1]
            [run]
            model = '{model}'
            estimator = 'gather'
            samples = 1048576"
        );
        let energy = results(&toml).energy;
        assert_closed("glass", &energy, 2e-3);
        let met = 10.0 * 4.0 * FRAC_1_SQRT_2;
        assert_estimate(model, absorbed(&energy, "glass"), met * kept, 4e-3);
        // Of the light that passes through the great circle of radius √2, the rest goes by or is mirrored away.
        assert_exact("emitted", energy.emitted, 10.0 * PI * 2.0, 1e-6);
    }
}

/// A room of six walls, of which the ceiling has a slit of the given width.
fn slit(width: f64, samples: u64) -> Results {
    let half = 0.5 - width / 2.0;
    let wall = |origin: [f64; 3], u: [f64; 3], v: [f64; 3]| {
        format!(
            "[[shape]]
            kind = 'rectangle'
            origin = {origin:?}
            u = {u:?}
            v = {v:?}
            material = 'wall'\n"
        )
    };
    let walls = [
        wall([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        wall([0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        wall([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        wall([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
        wall([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        wall([0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [half, 0.0, 0.0]),
        wall([1.0 - half, 0.0, 1.0], [0.0, 1.0, 0.0], [half, 0.0, 0.0]),
    ];
    results(&format!(
        "{}
        [material.wall]
        rho = 0.5
        [[source]]
        kind = 'point'
        position = [0.5, 0.5, 0.5]
        intensity = 1
        [[source]]
        kind = 'distant'
        direction = [0.1, 0.2, -1]
        irradiance = 1
        [[sensor]]
        name = 'floor'
        points = [[0.1, 0.1, 0]]
        normal = [0, 0, 1]
        [run]
        estimator = 'local'
        samples = {samples}",
        walls.concat()
    ))
}

/// From the floor's corner no look upwards falls into a slit of 10 mm, but of the lamp's light its solid angle,
/// 4 atan(ab/(s √(s² + a² + b²))) for 2a × 2b at the distance s, leaves by it straight, and about as much again after
/// reflections. Daylight that passes the room by is no leak.
#[test]
fn a_leak_is_told_with_its_share() {
    let leaking = slit(1e-2, 1 << 20);
    let told = leaking.warnings.join("\n");
    assert!(
        told.contains("of the emitted flux leaves the scene"),
        "{told}"
    );
    assert_closed("slit", &leaking.energy, 1e-2);
    let share: f64 = told.split(' ').next().unwrap().parse().unwrap();
    let energy = &leaking.energy;
    let straight = 4.0 * (5e-3 * 0.5 / (0.5 * (0.25_f64 + 0.25 + 25e-6).sqrt())).atan();
    let leaked = share * energy.emitted;
    // Some 30 walks tell it.
    assert!(
        leaked > 0.7 * straight && leaked < 3.0 * straight,
        "{leaked}, straight {straight}"
    );
    assert!(
        leaked < 0.05 * energy.escaped,
        "{leaked}, {}",
        energy.escaped
    );

    let closed = slit(0.0, 1 << 14);
    let told = closed.warnings.join("\n");
    assert!(!told.contains("leaves the scene"), "{told}");
}

#[test]
fn the_summary_says_where_the_flux_goes() {
    let scene = format!("{BOX}{POLARISED_SPOT}[material.wall]\nrho = 0.6\na = 0.4\n");
    let folder = Folder::new(scene.as_bytes(), &[]);
    folder.run("out", &["--samples", "4096", "--estimator", "gather"]);
    let summary: Value = serde_json::from_str(&folder.text("out/summary.json")).unwrap();
    let energy = &summary["energy"];
    let of = |key: &str| energy[key].as_f64().unwrap();
    let missing = of("emitted") - of("absorbed") - of("escaped") - of("truncated");
    assert!(of("se") > 0.0 && missing.abs() < 4.5 * of("se"), "{energy}");
    let wall = &energy["materials"][0];
    assert_eq!(wall["name"], "wall");
    assert_eq!(wall["absorbed"], energy["absorbed"]);
    assert!(wall["se"].as_f64().unwrap() > 0.0);
}
