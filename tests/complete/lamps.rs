//! Lamps of many kinds, among which a point looks rather at those that would send it much: against `local`, which looks at none.

use crate::experiment::measured;

/// A hall with a partition: panels of different strength, one that shines upwards, a polarised one, a lamp of two sides, a
/// point source and a spot.
const HALL: &str = "
    [[shape]]
    kind = 'box'
    min = [0, 0, 0]
    max = [6, 4, 3]
    inward = true
    material = 'wall'
    [[shape]]
    kind = 'rectangle'
    origin = [3, 0, 0]
    u = [0, 2.5, 0]
    v = [0, 0, 2]
    material = 'wall'
    [[shape]]
    kind = 'rectangle'
    origin = [0.5, 0.5, 2.9]
    u = [0, 0.6, 0]
    v = [0.6, 0, 0]
    material = 'panel'
    [[shape]]
    kind = 'rectangle'
    origin = [4.5, 3, 2.9]
    u = [0, 0.6, 0]
    v = [0.6, 0, 0]
    material = 'bright'
    [[shape]]
    kind = 'rectangle'
    origin = [2, 3.2, 2]
    u = [0.5, 0, 0]
    v = [0, 0.5, 0]
    material = 'panel'
    [[shape]]
    kind = 'rectangle'
    origin = [5.9, 0.5, 1]
    u = [0, 0, 0.5]
    v = [0, 0.5, 0]
    material = 'polarised'
    [[shape]]
    kind = 'box'
    min = [1.5, 1, 1]
    max = [1.6, 1.5, 1.3]
    material = 'panel'
    [[source]]
    kind = 'point'
    position = [4, 1, 1.5]
    intensity = 0.4
    [[source]]
    kind = 'spot'
    position = [5, 2.5, 2.8]
    direction = [-1, -0.5, -1]
    intensity = 2
    cone_deg = 50
    blend = 0.3
    [material.wall]
    rho = 0.6
    [material.panel]
    rho = 0.5
    exitance = 2
    [material.bright]
    rho = 0
    exitance = 9
    [material.polarised]
    rho = 0.5
    exitance = 3
    emission_stokes = [1, 0.5, 0, 0]
    emission_axis = [0, 0, 1]
    [[sensor]]
    name = 'table'
    points = [[0.5, 0.5, 0.8], [2.4, 1, 0.8], [3.6, 1, 0.8], [5.5, 3.5, 0.8], [3, 3.5, 0.001]]
    normal = [0, 0, 1]";

#[test]
fn what_is_looked_at_is_neither_lost_nor_counted_twice() {
    let by = |estimator: &str, samples: u64| {
        let run = format!("[run]\nestimator = '{estimator}'\nsamples = {samples}\nseed = 5");
        measured(&format!("{HALL}\n{run}"))
    };
    let local = by("local", 1 << 18);
    for (estimator, samples, ceiling) in [("auto", 16_384, 3e-3), ("gather", 32_768, 5e-3)] {
        for (i, (one, other)) in by(estimator, samples).iter().zip(&local).enumerate() {
            let (value, exact) = (one.stokes[0], other.stokes[0]);
            let (error, of_exact) = (one.standard_error[0], other.standard_error[0]);
            let z = (value - exact) / error.hypot(of_exact);
            assert!(
                z.abs() < 4.5,
                "{estimator}, sensor {i}: {value} ± {error}, by local {exact} ± {of_exact}: z = {z:.2}"
            );
            assert!(
                error < ceiling * exact && of_exact < 5e-3 * exact,
                "{estimator}, sensor {i}: ± {:.1e}, ± {:.1e}",
                error / exact,
                of_exact / exact
            );
        }
    }
}
