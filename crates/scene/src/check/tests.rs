use super::*;
use crate::Override;

const ROOM: &str = "[[shape]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [4, 3, 2.5]\ninward = true\nmaterial = \"plaster\"\n\
    [[shape]]\nkind = \"rectangle\"\norigin = [1, 1, 2.5]\nu = [0, 1, 0]\nv = [1, 0, 0]\nmaterial = \"lamp\"\n\
    [material.plaster]\nrho = 0.5\n[material.\"l*\"]\nrho = 0.2\nexitance = 1000\n\
    [[source]]\nkind = \"point\"\nposition = [2, 1.5, 2]\nintensity = 10\n\
    [[sensor]]\nname = \"floor\"\n\
    grid = { origin = [0, 0, 0], u = [4, 0, 0], v = [0, 3, 0], counts = [4, 3] }\n";

fn report(key: &str, value: &str) -> Report {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.toml");
    std::fs::write(&path, ROOM).unwrap();
    let entry = Override {
        key: key.into(),
        value: value.into(),
    };
    Report::of(&Scene::load(&path, &[entry]).unwrap())
}

#[test]
fn materials_are_told_with_their_area_and_origins() {
    let report = report("run.seed", "1");
    let [plaster, lamp] = &report.materials[..] else {
        panic!("two materials")
    };
    assert_eq!((plaster.triangles, lamp.triangles), (12, 2));
    assert!((plaster.area_m2 - 59.0).abs() < 1e-9);
    assert!(
        (plaster.exposed_m2 - 58.0).abs() < 1e-9,
        "{}",
        plaster.exposed_m2
    );
    assert!(
        lamp.values[1].origin.starts_with("\"l*\" at ")
            && lamp.values[1].origin.contains("room.toml:16:7")
    );
    assert_eq!(lamp.values[2].origin, "default");
}

#[test]
fn emitters_are_told_with_their_flux() {
    let report = report("run.seed", "1");
    let [lamp, point] = &report.emitters[..] else {
        panic!("two emitters")
    };
    assert!((lamp.flux.unwrap() - 1000.0).abs() < 1e-9 && lamp.kind == "surface");
    assert!((point.flux.unwrap() - 40.0 * std::f64::consts::PI).abs() < 1e-9);
    assert_eq!(point.kind, "point");
}

#[test]
fn sensors_are_told_with_their_extent() {
    let report = report("run.seed", "1");
    let floor = &report.sensors[0];
    assert_eq!((floor.count, floor.enclosed, floor.layout), (12, 0, "grid"));
    assert_eq!(floor.bounds_m, [[0.5, 0.5, 0.0], [3.5, 2.5, 0.0]]);
    assert_eq!(report.bounds_m, Some([[0.0; 3], [4.0, 3.0, 2.5]]));
}

#[test]
fn nothing_escapes_from_a_closed_room_and_half_of_all_from_a_lid() {
    assert!(report("run.seed", "1").escaping.abs() < 1e-15);
    // Points outside, above the room.
    let outside = report("sensor.floor.grid.origin", "[0, 0, 10]");
    assert!((outside.escaping - 1.0).abs() < 1e-15);
}

#[test]
fn a_representation_asked_for_is_told_with_the_need() {
    let report = report("run.representation", "full");
    assert_eq!(report.representation, "full");
    assert!(
        report
            .representation_reason
            .contains("asked for; the scene needs \"intensity\"")
    );
}

#[test]
fn cameras_and_radiances_are_told_with_where_they_look() {
    let plain = report("run.seed", "1");
    assert_eq!(
        (plain.sensors[0].quantity, plain.sensors[0].direction),
        ("irradiance", None)
    );
    assert!(plain.cameras.is_empty());
    let sensor = "[{ name = 'up', points = [[1, 1, 1], [2, 2, 1]], quantity = 'radiance', direction = [0, 0, 2] }]";
    let up = &report("sensor", sensor).sensors[0];
    assert_eq!(
        (up.quantity, up.direction),
        ("radiance", Some([0.0, 0.0, 1.0]))
    );
    let camera = "[{ name = 'eye', position = [1, 1, 1], look_at = [1, 2, 1], width = 32 }]";
    let report = report("camera", camera);
    let eye = &report.cameras[0];
    assert_eq!(
        (eye.name.as_str(), eye.position_m, eye.forward),
        ("eye", [1.0; 3], [0.0, 1.0, 0.0])
    );
    assert_eq!((eye.width, eye.height, eye.samples), (32, 480, 64));
}

#[test]
fn the_kind_is_told_with_its_origin() {
    let report = report("material.plaster.kind", "coated");
    let kind = &report.materials[0].values[0];
    assert_eq!(
        (kind.key, kind.value.as_str(), kind.origin.as_str()),
        ("kind", "coated", "--set material.plaster.kind=coated")
    );
}
