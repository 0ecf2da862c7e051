//! `sensors.csv` and `grids.csv`: results as scripts read them.

use crate::digest::Digest;
use crate::number::exact;
use anyhow::{Context, Result};
use malus_estimator::{Group, Paired, Reading};
use malus_scene::{Scene, Sensor};

/// Columns of `sensors.csv`.
const SENSORS: &str = "sensor,index,x_m,y_m,z_m,nx,ny,nz,s0,s1,s2,s3,se0,se1,se2,se3,dolp,se_dolp,\
    s0_scalar,se_s0_scalar,ds0,se_ds0,s0_diffuse,dd0,se_dd0,status";

/// Columns of `grids.csv`.
const GRIDS: &str = "sensor,count,enclosed,mean,se_mean,min,max,u0,dolp_mean";

/// `sensors.csv`: one row a sensor point, in the order of the scene; what was not computed is an empty field.
///
/// # Errors
/// A result that is no finite number.
pub fn sensors(scene: &Scene, groups: &[Group]) -> Result<Vec<u8>> {
    let mut table = table(SENSORS)?;
    for (sensor, group) in scene.sensors.iter().zip(groups) {
        for (index, reading) in group.readings.iter().enumerate() {
            let row = sensor_row(sensor, index, reading)
                .with_context(|| format!("sensor {:?}, point {index}", sensor.name))?;
            table.write_record(row)?;
        }
    }
    Ok(table.into_inner()?)
}

/// `grids.csv`: one row a sensor group.
///
/// # Errors
/// A result that is no finite number.
pub fn grids(scene: &Scene, digests: &[Digest]) -> Result<Vec<u8>> {
    let mut table = table(GRIDS)?;
    for (sensor, digest) in scene.sensors.iter().zip(digests) {
        let mut row = vec![
            sensor.name.clone(),
            digest.count.to_string(),
            digest.enclosed.to_string(),
        ];
        let free = digest.free.as_ref().map(|free| {
            [
                free.mean,
                free.mean_standard_error,
                free.min,
                free.max,
                free.u0,
                free.dolp_mean,
            ]
        });
        push(&mut row, free).with_context(|| format!("sensor {:?}", sensor.name))?;
        table.write_record(row)?;
    }
    Ok(table.into_inner()?)
}

fn table(header: &str) -> Result<csv::Writer<Vec<u8>>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(header.split(','))?;
    Ok(table)
}

fn sensor_row(sensor: &Sensor, index: usize, reading: &Reading) -> Result<Vec<String>> {
    let point = sensor
        .points
        .get(index)
        .context("there are more readings than points")?;
    let mut row = vec![sensor.name.clone(), index.to_string()];
    push(&mut row, Some(point.position.to_array()))?;
    push(&mut row, Some(point.normal.to_array()))?;
    let free = (!reading.enclosed).then_some(reading);
    push(&mut row, free.map(|reading| reading.stokes))?;
    push(&mut row, free.map(|reading| reading.standard_error))?;
    push(
        &mut row,
        free.map(|reading| [reading.dolp, reading.dolp_standard_error]),
    )?;
    let scalar = |pair: Paired| {
        [
            pair.value,
            pair.standard_error,
            pair.difference,
            pair.difference_standard_error,
        ]
    };
    push(
        &mut row,
        free.and_then(|reading| reading.scalar).map(scalar),
    )?;
    let diffuse = |pair: Paired| [pair.value, pair.difference, pair.difference_standard_error];
    push(
        &mut row,
        free.and_then(|reading| reading.diffuse).map(diffuse),
    )?;
    let status = if reading.enclosed { "enclosed" } else { "ok" };
    row.push(status.to_owned());
    Ok(row)
}

/// Adds the numbers, or as many empty fields.
fn push<const N: usize>(row: &mut Vec<String>, numbers: Option<[f64; N]>) -> Result<()> {
    match numbers {
        Some(numbers) => {
            for number in numbers {
                row.push(exact(number)?);
            }
        }
        None => row.extend(std::iter::repeat_n(String::new(), N)),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::digest::tests::{enclosed, reading};
    use malus_scene::{Frame, Layout, Quantity, SensorPoint};

    fn sensor() -> Sensor {
        let point = SensorPoint {
            position: [0.1, 1.0 / 3.0, 0.0].into(),
            normal: [0.0, 0.0, 1.0].into(),
            enclosed: false,
        };
        Sensor {
            name: "desk, left".into(),
            quantity: Quantity::Irradiance,
            frame: Frame::Incidence,
            axis: [1.0, 0.0, 0.0].into(),
            points: vec![point],
            layout: Layout::Points,
        }
    }

    #[test]
    fn the_headers_are_the_documented_ones() {
        assert_eq!(
            SENSORS,
            "sensor,index,x_m,y_m,z_m,nx,ny,nz,s0,s1,s2,s3,se0,se1,se2,se3,dolp,se_dolp,s0_scalar,se_s0_scalar,ds0,se_ds0,s0_diffuse,dd0,se_dd0,status"
        );
        assert_eq!(
            GRIDS,
            "sensor,count,enclosed,mean,se_mean,min,max,u0,dolp_mean"
        );
    }

    #[test]
    fn a_row_has_a_field_for_every_column_and_reads_back_to_the_bit() {
        let mut reading = reading(1.0 / 7.0);
        reading.diffuse = Some(Paired {
            value: 0.5,
            standard_error: 0.25,
            difference: -0.3,
            difference_standard_error: 1e-9,
        });
        let row = sensor_row(&sensor(), 0, &reading).expect("finite");
        let columns: Vec<&str> = SENSORS.split(',').collect();
        assert_eq!(row.len(), columns.len());
        let field = |name: &str| {
            let place = columns.iter().position(|column| *column == name);
            row[place.expect("a column")].as_str()
        };
        let number = |name: &str| field(name).parse::<f64>().expect("a number");
        assert_eq!(number("s0").to_bits(), (1.0f64 / 7.0).to_bits());
        assert_eq!(number("y_m").to_bits(), (1.0f64 / 3.0).to_bits());
        assert_eq!(field("s3"), "0");
        assert_eq!(field("s0_scalar"), "");
        assert_eq!(field("s0_diffuse"), "0.5");
        assert_eq!(field("dd0"), "-0.3");
        assert_eq!(field("se_dd0"), "1e-9");
        assert_eq!(field("status"), "ok");
    }

    #[test]
    fn an_enclosed_point_keeps_its_place_and_holds_no_numbers() {
        let row = sensor_row(&sensor(), 0, &enclosed()).expect("finite");
        assert_eq!(row.len(), SENSORS.split(',').count());
        assert!(row[8..25].iter().all(String::is_empty), "{row:?}");
        assert_eq!(row[25], "enclosed");
    }

    #[test]
    fn a_result_that_is_no_number_is_refused() {
        let mut reading = reading(1.0);
        reading.stokes[1] = f64::NAN;
        assert!(sensor_row(&sensor(), 0, &reading).is_err());
    }
}
