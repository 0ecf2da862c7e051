//! Figure 3 of the paper, taken apart: what the change of model does, and what polarisation does.

use crate::rooms::readings;

/// The room is symmetric: half of the paper's nine points.
const HALF: &str = "{ from = [0.1, 0.5, 0], to = [0.5, 0.5, 0], count = 5 }";

pub fn print() {
    println!("\n## Figure 3 of the paper\n");
    println!(
        "Illuminance (unit/m² for M = 1) along the floor of the unit room, y = 0.5; the room is symmetric, so half of it is shown."
    );
    println!(
        "*Change of model* compares with the standard diffuse model (ρ = 0.5, no mirror-like part), as the paper's \"more than 20 %\" and \"30 %\" do."
    );
    println!(
        "*Polarisation* compares with a scalar model of the same Fresnel reflectance, from the same walks; both errors are paired.\n"
    );
    println!("| a | x | E | change of model, % | polarisation, % | S1/S0, % |");
    println!("|---|---|---|---|---|---|");
    for a in ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"] {
        let file = format!("scenes/figure-3/a-{a}.toml");
        for (i, reading) in readings(
            &file,
            &[("run.samples", "262144"), ("sensor.floor.line", HALF)],
        )
        .iter()
        .take(5)
        .enumerate()
        {
            let (scalar, diffuse) = (reading.scalar.unwrap(), reading.diffuse.unwrap());
            let s0 = reading.stokes[0];
            let percent = |value: f64, error: f64, of: f64| {
                if error > 0.0 {
                    format!("{:+.4} ± {:.4}", 100.0 * value / of, 100.0 * error / of)
                } else {
                    "0".into()
                }
            };
            println!(
                "| {a} | 0.{} | {s0:.7} ± {:.7} | {} | {} | {} |",
                i + 1,
                reading.standard_error[0],
                percent(
                    diffuse.difference,
                    diffuse.difference_standard_error,
                    diffuse.value
                ),
                percent(
                    scalar.difference,
                    scalar.difference_standard_error,
                    scalar.value
                ),
                percent(reading.stokes[1], reading.standard_error[1], s0),
            );
        }
    }
}
