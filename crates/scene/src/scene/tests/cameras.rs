//! Cameras in scenes.

use super::*;

const EYE: &str = "[[camera]]\nname = \"eye\"\nposition = [0.5, 0.5, 1.6]\nlook_at = [3, 2, 1]\n";

#[test]
fn a_camera_is_enough_for_a_scene() {
    let scene = Room::new(&format!("{CUBE}{LAMP}{EYE}")).load();
    assert_eq!((scene.sensors.len(), scene.cameras.len()), (0, 1));
    assert_eq!(scene.cameras[0].name, "eye");
    assert_eq!(scene.warnings, Vec::<String>::new());
    let error = Room::new(&format!("{CUBE}{LAMP}")).error();
    assert!(
        error.contains("there is no sensor and no camera"),
        "{error}"
    );
}

#[test]
fn a_white_room_is_refused_and_an_open_one_is_not_by_what_a_camera_sees() {
    let room = Room::new(&format!("{CUBE}{LAMP}{EYE}"));
    let white = ("material.plaster.rho", "1");
    assert!(
        room.with(&[white])
            .err()
            .unwrap()
            .contains("nothing absorbs")
    );
    let outside = ("camera.eye.position", "[9, 9, 9]");
    assert!(room.with(&[white, outside]).is_ok());
}

#[test]
fn overrides_reach_cameras_by_name() {
    let room = Room::new(&format!("{CUBE}{LAMP}{EYE}"));
    let scene = room
        .with(&[("camera.eye.width", "32"), ("camera.0.fov_deg", "90")])
        .unwrap();
    let camera = &scene.cameras[0];
    assert!(camera.width == 32 && (camera.fov_deg - 90.0).abs() < 1e-15);
    let error = room.with(&[("camera.eye.with", "32")]).err().unwrap();
    assert!(
        error.starts_with("--set camera.eye.with=32: ")
            && error.contains("the nearest is \"width\""),
        "{error}"
    );
}

#[test]
fn names_of_cameras_differ_from_those_of_sensors() {
    for (text, name) in [
        (format!("{FLOOR}{}", EYE.replace("eye", "Floor")), "Floor"),
        (format!("{EYE}{}", EYE.replace("eye", "Eye")), "Eye"),
    ] {
        let error = Room::new(&format!("{CUBE}{LAMP}{text}")).error();
        assert!(
            error.contains(&format!("the camera name {name:?} is used twice")),
            "{error}"
        );
    }
    let clash = EYE.replace("eye", "sensor_board");
    let error = Room::with_obj(&format!("{LAMP}{clash}")).error();
    assert!(
        error.contains("is a sensor already; give another name") && !error.contains("mesh ="),
        "{error}"
    );
}

#[test]
fn a_camera_in_a_cabinet_or_outside_is_warned_of() {
    let cabinet =
        "[[shape]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 2]\nmaterial = \"plaster\"\n";
    let room = Room::new(&format!("{CUBE}{cabinet}{LAMP}{FLOOR}{EYE}"));
    assert!(has(
        &room.load().warnings,
        "camera \"eye\" stands inside the closed object \"shape.1\""
    ));
    let at = |position: &str| {
        let scene = room.with(&[("camera.eye.position", position)]).unwrap();
        scene.warnings
    };
    assert!(has(
        &at("[2, -3, 1]"),
        "camera \"eye\" stands outside of all geometry"
    ));
    assert!(!has(&at("[2, 2, 1]"), "camera"));
    let lit = room
        .with(&[("source.0.position", "[0.5, 0.5, 0.5]")])
        .unwrap();
    assert!(!has(&lit.warnings, "camera"));
}
