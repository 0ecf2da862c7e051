//! Cases in the spirit of CIE 171:2006, every expected number from a closed form (`tests/data/cie171.json`).

use crate::experiment::{assert_estimate, assert_exact, measured, repository, s0};
use malus_estimator::Reading;
use serde_json::Value;

/// The six digits of the table: half of the last one.
const DIGITS: f64 = 5e-6;

fn case(id: &str) -> Value {
    let text = std::fs::read_to_string(repository("tests/data/cie171.json")).unwrap();
    let table: Value = serde_json::from_str(&text).unwrap();
    table["cases"]
        .as_array()
        .unwrap()
        .iter()
        .find(|case| case["id"] == id)
        .unwrap()["expected"]
        .clone()
}

/// The points of a case as sensors of their own, with the values expected there.
fn points(id: &str) -> (String, Vec<f64>) {
    let case = case(id);
    let mut sensors = String::new();
    let mut expected = Vec::new();
    for (name, point) in case.as_object().unwrap() {
        sensors += &format!(
            "[[sensor]]\nname = '{name}'\npoints = [{}]\nnormal = {}\n",
            point["p"], point["n"]
        );
        expected.push(point["E"].as_f64().unwrap());
    }
    (sensors, expected)
}

fn assert_points(id: &str, scene: &str, ceiling: f64) {
    let (sensors, expected) = points(id);
    for (reading, exact) in measured(&format!("{scene}\n{sensors}"))
        .iter()
        .zip(expected)
    {
        let (value, error) = s0(reading);
        if exact.abs() == 0.0 {
            assert!(value.abs() == 0.0, "{id}: {value} in full shadow");
        } else if ceiling > 0.0 {
            assert_estimate(id, (value, error.hypot(DIGITS * exact)), exact, ceiling);
        } else {
            assert!(error.abs() == 0.0, "{id}: nothing is left to chance");
            assert_exact(id, value, exact, DIGITS);
        }
    }
}

#[test]
fn case_5_2_point_sources() {
    let lambertian = "[[source]]\nkind = 'point'\nposition = [0, 0, 3]\nintensity = 1000\n\
                      distribution = 'cosine'\ndirection = [0, 0, -1]";
    assert_points("5.2-lambertian", lambertian, 0.0);
    let intensity = 10_000.0 / (4.0 * std::f64::consts::PI);
    let isotropic =
        format!("[[source]]\nkind = 'point'\nposition = [0, 0, 3]\nintensity = {intensity}");
    assert_points("5.2-isotropic", &isotropic, 0.0);
}

#[test]
fn case_5_3_an_area_source_in_a_black_room() {
    let exitance = 1000.0 * std::f64::consts::PI;
    let scene = |estimator: &str| {
        format!(
            "[[shape]]
            kind = 'box'
            min = [0, 0, 0]
            max = [4, 4, 3]
            inward = true
            material = 'black'
            [[shape]]
            kind = 'rectangle'
            origin = [1.5, 1.5, 3]
            u = [0, 1, 0]
            v = [1, 0, 0]
            material = 'lamp'
            [material.black]
            rho = 0
            [material.lamp]
            rho = 0
            exitance = {exitance}
            [run]
            estimator = '{estimator}'
            samples = 262144"
        )
    };
    for estimator in ["local", "gather"] {
        assert_points("5.3-lambertian", &scene(estimator), 2e-3);
    }
}

/// Nodes and weights of Gauss and Legendre on the two halves of [0, 1], eight points each.
fn gauss() -> [(f64, f64); 16] {
    let half = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_361_96),
        (0.525_532_409_916_329, 0.313_706_645_877_887_27),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    std::array::from_fn(|i| {
        let (node, weight) = half[i / 2 % 4];
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let middle = if i < 8 { 0.25 } else { 0.75 };
        (middle + 0.25 * sign * node, 0.25 * weight)
    })
}

/// Sensors at the nodes of each face of a box [0, size], looking inwards, and their weights.
fn faces(size: [f64; 3]) -> (String, Vec<(&'static str, f64)>) {
    let mut sensors = String::new();
    let mut weights = Vec::new();
    let names = [["x0", "x1"], ["y0", "y1"], ["floor", "ceiling"]];
    for (axis, names) in names.iter().enumerate() {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        for (side, name) in names.iter().enumerate() {
            let mut points = String::new();
            for (u, wu) in gauss() {
                for (v, wv) in gauss() {
                    let mut p = [0.0; 3];
                    p[axis] = size[axis] * side as f64;
                    (p[b], p[c]) = (size[b] * u, size[c] * v);
                    points += &format!("{p:?},");
                    weights.push((*name, wu * wv * size[b] * size[c]));
                }
            }
            let mut normal = [0.0; 3];
            normal[axis] = 1.0 - 2.0 * side as f64;
            sensors +=
                &format!("[[sensor]]\nname = '{name}'\npoints = [{points}]\nnormal = {normal:?}\n");
        }
    }
    (sensors, weights)
}

fn lit_box(size: [f64; 3], rho: f64, samples: u64) -> (Vec<Reading>, Vec<(&'static str, f64)>) {
    let (sensors, weights) = faces(size);
    let intensity = 10_000.0 / (4.0 * std::f64::consts::PI);
    let centre = size.map(|s| s / 2.0);
    let readings = measured(&format!(
        "[[shape]]
        kind = 'box'
        min = [0, 0, 0]
        max = {size:?}
        inward = true
        material = 'wall'
        [material.wall]
        rho = {rho}
        [[source]]
        kind = 'point'
        position = {centre:?}
        intensity = {intensity}
        {sensors}
        [run]
        estimator = 'gather'
        samples = {samples}"
    ));
    (readings, weights)
}

#[test]
fn case_5_4_flux_is_conserved() {
    let (readings, weights) = lit_box([4.0, 4.0, 3.0], 0.0, 64);
    let expected = case("5.4-electric");
    let flux = |face: &str| -> f64 {
        let all = readings
            .iter()
            .zip(&weights)
            .filter(|(_, (name, _))| *name == face);
        all.map(|(reading, (_, weight))| reading.stokes[0] * weight)
            .sum()
    };
    let mut total = 0.0;
    for face in ["floor", "ceiling", "x0", "x1", "y0", "y1"] {
        // Sixteen nodes a side integrate cos θ/r² over a face beyond the six digits of the table.
        assert_exact(
            face,
            flux(face),
            expected[face]["flux"].as_f64().unwrap(),
            DIGITS,
        );
        total += flux(face);
    }
    assert_exact("total", total, 10_000.0, DIGITS);
}

#[test]
fn case_5_6_light_scattered_by_a_lit_floor() {
    let scene = |half: f64, estimator: &str, samples: u64| {
        let (corner, side) = (2.0 - half, 2.0 * half);
        format!(
            "[[shape]]
            kind = 'rectangle'
            origin = [{corner}, {corner}, 0]
            u = [{side}, 0, 0]
            v = [0, {side}, 0]
            material = 'floor'
            [material.floor]
            rho = 0.3
            [[source]]
            kind = 'distant'
            direction = [0, 0, -1]
            irradiance = {}
            [run]
            estimator = '{estimator}'
            samples = {samples}",
            100.0 / 0.3
        )
    };
    // A small floor is found by walks from the source, an endless one by walks from the sensors.
    assert_points("5.6-0.5x0.5", &scene(0.25, "local", 65_536), 5e-3);
    assert_points("5.6-4x4", &scene(2.0, "local", 1_048_576), 5e-3);
    assert_points("5.6-4x4", &scene(2.0, "gather", 1_048_576), 5e-3);
    assert_points("5.6-500x500", &scene(250.0, "gather", 262_144), 5e-3);
}

#[test]
fn case_5_7_an_obstruction_before_a_lit_wall() {
    // The wall is lit evenly: what it scatters is what a surface of exitance ρE emits.
    let scene = "
        [[shape]]
        kind = 'box'
        min = [0, 2.5, 0]
        max = [4, 2.7, 1]
        material = 'black'
        [[shape]]
        kind = 'rectangle'
        origin = [0, 4, 0]
        u = [4, 0, 0]
        v = [0, 0, 3]
        material = 'wall'
        [material.black]
        rho = 0
        [material.wall]
        rho = 0
        exitance = 100
        [run]
        samples = 1048576\n";
    for estimator in ["local", "gather"] {
        assert_points("5.7", &format!("{scene}estimator = '{estimator}'"), 5e-3);
    }
}

#[test]
fn case_5_8_interreflection_in_a_cube() {
    let expected = case("5.8-cube");
    for (rho, row) in expected.as_object().unwrap() {
        let rho: f64 = rho.parse().unwrap();
        let (readings, weights) = lit_box([4.0; 3], rho, 512);
        let (mut sum, mut squares) = (0.0, 0.0);
        for (reading, (_, weight)) in readings.iter().zip(&weights) {
            sum += reading.stokes[0] * weight / 96.0;
            squares += (reading.standard_error[0] * weight / 96.0).powi(2);
        }
        let direct = row["E_direct_mean"].as_f64().unwrap();
        let indirect = row["E_indirect_mean"].as_f64().unwrap();
        if rho > 0.0 {
            let error = squares.sqrt().hypot(DIGITS * (direct + indirect));
            assert_estimate("indirect", (sum - direct, error), indirect, 1e-2);
        } else {
            assert_exact("direct", sum, direct, 1e-5);
        }
    }
}

#[test]
fn case_5_8_interreflection_in_a_sphere() {
    let expected = case("5.8-sphere");
    let intensity = 10_000.0 / (4.0 * std::f64::consts::PI);
    for rho in ["0", "0.5", "0.9"] {
        let row = &expected[rho];
        // The sensor and the facets of six subdivisions lie within 1e-4 of the sphere, which moves E by twice that share.
        let reading = measured(&format!(
            "[[shape]]
            kind = 'sphere'
            centre = [0, 0, 0]
            radius = 2
            inward = true
            subdivisions = 6
            material = 'wall'
            [material.wall]
            rho = {rho}
            [[source]]
            kind = 'point'
            position = [0, 0, 0]
            intensity = {intensity}
            [[sensor]]
            name = 'wall'
            points = [[1.19988, 0, -1.59984]]
            normal = [-0.6, 0, 0.8]
            [run]
            estimator = 'gather'
            samples = 262144"
        ))[0];
        let (value, error) = s0(&reading);
        let exact = row["E"].as_f64().unwrap();
        assert_estimate("sphere", (value, error.hypot(2e-4 * exact)), exact, 3e-3);
    }
}
