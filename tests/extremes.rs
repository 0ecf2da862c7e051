//! The ends of every range: each case is right to a stated bound, or refused by a message that says why.

// Rooms of millimetres and of kilometres, at the origin and far from it.
mod scales;
// Walls that lose next to nothing, and walks of thousands of events.
mod bounces;
// Sensors on edges, in corners, on vertices, and next to nothing above a surface.
mod places;
// Sensors near walls against those in the open.
mod walls;
// Slivers, T-junctions, coincident faces, sheets that nearly touch.
mod meshes;
// Indices, extinctions and fractions from nothing to infinity.
mod glossy;
// Coats and panes that are hardly there, and ones that are nothing else.
mod coats;
// Lamps without size, strong and weak ones, light that grazes.
mod lamps;
// Sums of thousands of millions of walks.
mod sums;

use malus_estimator::Reading;

/// A box with its inside in sight.
fn cube(material: &str, min: [f64; 3], max: [f64; 3]) -> String {
    format!(
        "[[shape]]
        kind = 'box'
        min = {min:?}
        max = {max:?}
        inward = true
        material = '{material}'\n"
    )
}

/// A rectangle with the normal u × v.
fn sheet(material: &str, origin: [f64; 3], u: [f64; 3], v: [f64; 3]) -> String {
    format!(
        "[[shape]]
        kind = 'rectangle'
        origin = {origin:?}
        u = {u:?}
        v = {v:?}
        material = '{material}'\n"
    )
}

/// Sensor points with one normal.
fn sensors(points: &[[f64; 3]], normal: [f64; 3]) -> String {
    format!(
        "[[sensor]]
        name = 'points'
        points = {points:?}
        normal = {normal:?}\n"
    )
}

/// The paper's room, moved and scaled, with sensors given in its own unit.
fn unit_room(material: &str, scale: f64, origin: f64, points: &[[f64; 3]], run: &str) -> String {
    let at = |point: [f64; 3]| point.map(|x| origin + scale * x);
    let points: Vec<_> = points.iter().map(|&point| at(point)).collect();
    format!(
        "{}
        [[shape]]
        kind = 'disc'
        centre = {:?}
        normal = [0, 0, -1]
        radius = {:?}
        material = 'lamp'
        [material.plaster]
        {material}
        [material.lamp]
        rho = 0
        exitance = 1
        {}
        [run]
        {run}",
        cube("plaster", at([0.0; 3]), at([1.0; 3])),
        at([0.5, 0.5, 1.0]),
        0.05 * scale,
        sensors(&points, [0.0, 0.0, 1.0])
    )
}

/// Asserts that nothing is infinite or no number, that errors are there, and that light is polarised by all of it at most.
#[track_caller]
fn assert_physical(what: &str, reading: &Reading) {
    let values = reading.stokes.iter().chain(&reading.standard_error);
    assert!(values.clone().all(|v| v.is_finite()), "{what}: {reading:?}");
    assert!(reading.stokes[0] >= 0.0, "{what}: {reading:?}");
    assert!(
        reading.dolp <= 1.0 + 4.5 * reading.dolp_standard_error + 1e-12,
        "{what}: {reading:?}"
    );
    if let Some(scalar) = reading.scalar {
        assert!(
            scalar.value.is_finite() && scalar.difference.is_finite(),
            "{what}"
        );
    }
}
