//! A closed room of any shape that emits M₀ everywhere with Lambert reflectance ρ: E = M₀/(1 − ρ) at every point.

use crate::experiment::{assert_estimate, measured, s0};
use glam::DVec3;
use malus_estimator::Reading;

const POINTS: &str = "
    [[sensor]]
    name = 'inside'
    points = [[0.5, 0.5, 0.5], [0.01, 0.5, 0.5], [0.001, 0.001, 0.001], [0.99, 0.3, 0.6]]
    normal = [0.6, 0.0, 0.8]
";

fn room(rho: f64, shape: &str, estimator: &str, samples: u64) -> String {
    format!(
        "{shape}
        [material.wall]
        rho = {rho}
        exitance = 2
        {POINTS}
        [run]
        estimator = '{estimator}'
        samples = {samples}"
    )
}

const BOX: &str = "
    [[shape]]
    kind = 'box'
    min = [0, 0, 0]
    max = [1, 1, 1]
    inward = true
    material = 'wall'
";

/// A box with a smaller box standing in it: edges, corners, shadows.
const CONCAVE: &str = "
    [[shape]]
    kind = 'box'
    min = [0, 0, 0]
    max = [1, 1, 1]
    inward = true
    material = 'wall'
    [[shape]]
    kind = 'box'
    min = [0.2, 0.6, 0]
    max = [0.4, 0.8, 0.7]
    material = 'wall'
";

#[test]
fn a_furnace_is_even_everywhere() {
    for (name, shape) in [("box", BOX), ("concave", CONCAVE)] {
        for rho in [0.0, 0.5, 0.9] {
            for reading in measured(&room(rho, shape, "gather", 65_536)) {
                assert_estimate(name, s0(&reading), 2.0 / (1.0 - rho), 6e-3);
            }
        }
    }
}

#[test]
fn a_furnace_is_even_for_walks_from_the_walls_too() {
    // Local estimates are for sensors away from walls: their variance grows without bound there.
    let toml = room(0.5, BOX, "local", 262_144).replace(
        "[0.01, 0.5, 0.5], [0.001, 0.001, 0.001], [0.99, 0.3, 0.6]",
        "[0.3, 0.5, 0.6]",
    );
    for reading in measured(&toml) {
        assert_estimate("local", s0(&reading), 4.0, 5e-3);
    }
}

/// Sensors flush on `count` facets of the unit sphere, facing inwards.
fn facets(subdivisions: u32, count: usize) -> String {
    let (positions, triangles) =
        malus_geometry::shape::sphere(DVec3::ZERO, 1.0, true, subdivisions);
    let stride = triangles.len() / count;
    (0..count)
        .map(|i| {
            let [a, b, c] = triangles[i * stride + 7].map(|v| positions[v as usize]);
            let (p, n) = ((a + b + c) / 3.0, (b - a).cross(c - a));
            format!(
                "[[sensor]]
                name = 'facet {i}'
                points = [[{}, {}, {}]]
                normal = [{}, {}, {}]\n",
                p.x, p.y, p.z, n.x, n.y, n.z
            )
        })
        .collect()
}

/// E/M = A/(1 − (1 − f)ρA), A = ∫ 2μ g dμ, in a sphere that emits M from its whole wall: 1.3570079 with polarisation,
/// 1.3523804 without, for n = 1.5, f = 0.6, ρ = 0.5. The facets of 5 subdivisions make A low by 1.4e-4 at f = 1, by
/// less here: below a third of the standard error allowed.
#[test]
fn a_glossy_sphere_has_its_exact_answer_with_and_without_polarisation() {
    let count = 24;
    let toml = format!(
        "[[shape]]
        kind = 'sphere'
        centre = [0, 0, 0]
        radius = 1
        inward = true
        subdivisions = 5
        material = 'wall'
        [material.wall]
        rho = 0.5
        a = 0.6
        n = 1.5
        exitance = 1
        {}
        [run]
        estimator = 'gather'
        compare = ['scalar', 'diffuse']
        samples = 65536",
        facets(5, count)
    );
    let readings = measured(&toml);
    // Sensors are walked from independently, so their errors add in squares.
    let mean = |of: &dyn Fn(&Reading) -> (f64, f64)| {
        let (sum, squares) = readings
            .iter()
            .map(of)
            .fold((0.0, 0.0), |(sum, squares), (value, error)| {
                (sum + value, squares + error * error)
            });
        (sum / count as f64, squares.sqrt() / count as f64)
    };
    assert_estimate("polarised", mean(&s0), 1.357_007_9, 6e-4);
    let scalar = mean(&|r| r.scalar.map(|s| (s.value, s.standard_error)).unwrap());
    assert_estimate("scalar", scalar, 1.352_380_4, 6e-4);
    let difference = mean(&|r| {
        r.scalar
            .map(|s| (s.difference, s.difference_standard_error))
            .unwrap()
    });
    assert_estimate("difference", difference, 1.357_007_9 - 1.352_380_4, 0.02);
    // Without its mirror-like part the sphere is an ordinary furnace.
    let diffuse = mean(&|r| r.diffuse.map(|d| (d.value, d.standard_error)).unwrap());
    assert_estimate("diffuse", diffuse, 2.0, 6e-4);
}
