//! Lamps without size, strong and weak ones, and light that grazes.

use super::{cube, sensors, sheet, unit_room};
use crate::experiment::{assert_estimate, assert_exact, evaluate, measured, readings, s0, scene};
use std::f64::consts::PI;

/// E = M A/(π r²) below a lamp of 10⁻⁶ m, hung free or flush with the ceiling.
#[test]
fn a_lamp_of_a_micrometre_is_a_point() {
    for height in [0.9, 1.0] {
        let toml = format!(
            "{}{}
            [material.black]
            rho = 0
            [material.lamp]
            rho = 0
            exitance = 1e12
            {}
            [run]
            samples = 4096",
            cube("black", [0.0; 3], [1.0; 3]),
            sheet(
                "lamp",
                [0.5, 0.5, height],
                [0.0, 1e-6, 0.0],
                [1e-6, 0.0, 0.0]
            ),
            sensors(&[[0.5, 0.5, 0.0]], [0.0, 0.0, 1.0])
        );
        let (value, error) = s0(&measured(&toml)[0]);
        // As seen from 1 m the lamp's own extent is 10⁻¹² of the value.
        let exact = 1.0 / (PI * height * height);
        assert!(error < 1e-6 * exact, "{error}");
        assert_exact("point", value, exact, 5e-6);
    }
}

/// Light is linear in what is emitted: the same walks give the same result, scaled.
#[test]
fn exitances_of_any_size_scale_the_result() {
    for a in [0.0, 0.6] {
        let lit = |exitance: f64| {
            let material = format!("rho = 0.5\na = {a}");
            let points = [[0.3, 0.4, 0.0], [0.001, 0.001, 0.0]];
            let toml = unit_room(&material, 1.0, 0.0, &points, "samples = 4096");
            measured(&toml.replace("exitance = 1", &format!("exitance = {exitance:?}")))
        };
        let one = lit(1.0);
        for exitance in [1e-12, 1e12] {
            for (reading, one) in lit(exitance).iter().zip(&one) {
                assert_exact("S0", reading.stokes[0], exitance * one.stokes[0], 1e-9);
                assert_exact(
                    "error",
                    reading.standard_error[0],
                    exitance * one.standard_error[0],
                    1e-6,
                );
            }
        }
    }
}

/// Ten to the minus nine radians above the floor: E = E₀ sin α.
#[test]
fn light_that_grazes_the_floor_is_as_weak_as_its_sine() {
    for polarising in ["", "a = 1\nn = 1.5"] {
        let toml = format!(
            "{}
            [material.floor]
            rho = 0.5
            {polarising}
            [[source]]
            kind = 'distant'
            direction = [1, 0, -1e-9]
            irradiance = 1000
            {}
            [run]
            samples = 64",
            sheet("floor", [-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]),
            sensors(&[[0.0, 0.0, 0.0], [0.9, 0.3, 0.0]], [0.0, 0.0, 1.0])
        );
        for reading in measured(&toml) {
            assert_exact("grazing", reading.stokes[0], 1e-6, 1e-12);
        }
    }
}

/// The same light on a wall at the end of the floor comes back to it: every value stays finite.
#[test]
fn grazing_light_between_glossy_walls_is_finite() {
    let toml = format!(
        "{}{}
        [material.floor]
        rho = 0.5
        a = 0.5
        [[source]]
        kind = 'distant'
        direction = [1, 0, -1e-9]
        irradiance = 1000
        {}
        [run]
        samples = 4096",
        sheet("floor", [-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]),
        sheet("floor", [1.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 2.0, 0.0]),
        sensors(&[[0.0, 0.0, 0.0], [0.999, 0.3, 0.0]], [0.0, 0.0, 1.0])
    );
    let readings = measured(&toml);
    for reading in &readings {
        super::assert_physical("grazing", reading);
    }
    // Right beside the wall, which takes 1000 and scatters (1 − a)ρ = ¼ of it, half a hemisphere is filled with 250.
    let (value, error) = s0(&readings[1]);
    assert_estimate("beside the wall", (value, error.hypot(1.0)), 125.0, 0.05);
}

/// A point source in the plane of a ceiling, or by single precision just above it, lights what is below, straight and by a
/// mirror on the floor, whichever way the ceiling's normal points: E = I h/r³ of each.
#[test]
fn a_source_flush_with_the_ceiling_lights_the_room() {
    for height in [1.0, 2.7, 0.9, 3.1f64] {
        for above in [0.0, 1e-7 * height, -1e-7 * height] {
            for ceiling in [
                sheet(
                    "black",
                    [-9.0, -9.0, height],
                    [18.0, 0.0, 0.0],
                    [0.0, 18.0, 0.0],
                ),
                sheet(
                    "black",
                    [-9.0, -9.0, height],
                    [0.0, 18.0, 0.0],
                    [18.0, 0.0, 0.0],
                ),
            ] {
                let readings = measured(&format!(
                    "{ceiling}{}{}{}
                    [material.black]
                    rho = 0
                    [material.mirror]
                    rho = 0
                    a = 1
                    n = inf
                    [[source]]
                    kind = 'point'
                    position = [0.2, 0.1, {:?}]
                    intensity = 3
                    [run]
                    samples = 64",
                    sheet(
                        "mirror",
                        [-9.0, -9.0, 0.0],
                        [18.0, 0.0, 0.0],
                        [0.0, 18.0, 0.0]
                    ),
                    sensors(&[[0.6, 0.4, 0.25]], [0.0, 0.0, 1.0]),
                    sensors(&[[0.6, 0.4, 0.25]], [0.0, 0.0, -1.0])
                        .replace("name = '", "name = 'down-"),
                    height + above,
                ));
                for (reading, rise) in readings.iter().zip([height - 0.25, height + 0.25]) {
                    let square = 0.25 + rise * rise;
                    let exact = 3.0 * rise / (square * square.sqrt());
                    let what = format!("{height} {above:e} {rise}");
                    assert_exact(&what, reading.stokes[0], exact, 1e-5);
                }
            }
        }
    }
}

/// A spot in the plane of a ceiling lights the room as one does a micrometre below it, by the same walks.
#[test]
fn a_spot_flush_with_the_ceiling_loses_nothing() {
    for height in [1.3, 2.7, 1.2, 3.4f64] {
        let below = |distance: f64| {
            let readings = measured(&format!(
                "{}{}
                [material.wall]
                rho = 0.6
                [[source]]
                kind = 'spot'
                position = [0.8, 0.9, {:?}]
                direction = [0, 0, -1]
                cone_deg = 120
                intensity = 1
                [run]
                samples = 4096",
                cube("wall", [0.1, 0.2, 0.3], [1.7, 1.9, height]),
                sensors(&[[0.3, 0.5, 0.5]], [0.0, 0.0, -1.0]),
                height - distance,
            ));
            readings[0].stokes[0]
        };
        assert_exact(&format!("{height}"), below(0.0), below(1e-6), 1e-4);
    }
}

/// A source in the edge between a floor and a roof, down to 10°, lights what is between them: E = I cos θ/r².
#[test]
fn a_source_in_the_eaves_lights_the_attic() {
    for degrees in [80.0, 60.0, 45.0, 20.0, 10.0f64] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (half_sin, half_cos) = (0.5 * degrees).to_radians().sin_cos();
        let reading = measured(&format!(
            "{}{}{}
            [material.black]
            rho = 0
            [[source]]
            kind = 'point'
            position = [0.3, 0.2, 0.1]
            intensity = 2
            [run]
            samples = 64",
            sheet("black", [0.3, -4.0, 0.1], [5.0, 0.0, 0.0], [0.0, 8.0, 0.0]),
            sheet(
                "black",
                [0.3, -4.0, 0.1],
                [5.0 * cos, 0.0, 5.0 * sin],
                [0.0, 8.0, 0.0]
            ),
            // Halfway between the two, facing the edge.
            sensors(
                &[[0.3 + 2.0 * half_cos, 0.2, 0.1 + 2.0 * half_sin]],
                [-half_cos, 0.0, -half_sin]
            ),
        ))[0];
        // It is moved into the edge by 1e-7 m over the sine of half the angle.
        assert_exact(
            &format!("{degrees}°"),
            reading.stokes[0],
            0.5,
            5e-7 / half_sin,
        );
    }
}

/// A lamp on the floor of a box whose normals point outwards, and sensors on that floor: the room is lit, not what is below.
#[test]
fn a_source_flush_with_the_floor_lights_what_faces_up() {
    let lit = |height: f64, inward: bool| {
        measured(&format!(
            "{}{}
            [material.wall]
            rho = 0.5
            [[source]]
            kind = 'point'
            position = [2, 1, {height:?}]
            intensity = 1
            [run]
            samples = 4096",
            cube("wall", [0.0; 3], [4.0, 4.0, 3.0])
                .replace("inward = true", &format!("inward = {inward}")),
            sensors(
                &[[1.0, 1.0, 0.0], [3.0, 2.0, 0.0], [2.0, 3.5, 0.0]],
                [0.0, 0.0, 1.0]
            ),
        ))
    };
    for inward in [true, false] {
        for (flush, above) in lit(0.0, inward).iter().zip(lit(1e-4, inward)) {
            let error = flush.standard_error[0].hypot(above.standard_error[0]);
            let z = (flush.stokes[0] - above.stokes[0]) / error;
            assert!(
                z.abs() < 4.5,
                "inward = {inward}: {flush:?} {above:?}: z = {z:.2}"
            );
            assert!(error < 0.1 * above.stokes[0], "{error}");
        }
    }
}

/// Irradiance has no bound in a point source itself: it is left out, also where both lie in the floor.
#[test]
fn a_sensor_in_a_source_is_told_and_left_out() {
    for place in [[0.5, 0.5, 0.5], [0.5, 0.5, 0.0], [0.0, 0.0, 0.0]] {
        let results = evaluate(&scene(&format!(
            "{}{}
            [material.black]
            rho = 0
            [[source]]
            kind = 'point'
            position = {place:?}
            intensity = 1
            [run]
            samples = 64",
            cube("black", [0.0; 3], [1.0; 3]),
            sensors(&[place], [0.0, 0.0, 1.0]),
        )));
        assert!(readings(&results)[0].stokes[0].abs() <= 0.0, "{place:?}");
        let told = results
            .warnings
            .iter()
            .any(|w| w.contains("1 sensor points lie in a point source"));
        assert!(told, "{:?}", results.warnings);
    }
}
