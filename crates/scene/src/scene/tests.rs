use super::*;
use std::path::PathBuf;

mod cameras;
mod office;
mod panes;

/// A folder with a scene file `room.toml` and other files.
struct Room {
    folder: tempfile::TempDir,
}

const CUBE: &str = "[[shape]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [4, 3, 2.5]\ninward = true\nmaterial = \"plaster\"\n\
    [material.plaster]\nrho = 0.5\n";
const LAMP: &str = "[[source]]\nkind = \"point\"\nposition = [2, 1.5, 2]\nintensity = 10\n";
const FLOOR: &str = "[[sensor]]\nname = \"floor\"\n\
    grid = { origin = [0, 0, 0], u = [4, 0, 0], v = [0, 3, 0], counts = [4, 3] }\n";

/// A square of 2 m × 2 m in the plane z = 1 of an OBJ with Z up, facing up, of material `Wall_Paint`, and a sensor.
const OBJ: &str = "mtllib room.mtl\no Table\nv 0 0 1\nv 2 0 1\nv 2 2 1\nv 0 2 1\nusemtl Wall_Paint\nf 1 2 3 4\n\
    o SENSOR_Board\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\nf 5 6 7 8\n";
const MTL: &str = "newmtl Wall_Paint\nKd 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nillum 2\n";

impl Room {
    fn new(text: &str) -> Self {
        let room = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        room.write("room.toml", text);
        room
    }

    fn with_obj(text: &str) -> Self {
        let mesh = "[[mesh]]\nfile = \"room.obj\"\nup = \"z\"\n";
        let room = Self::new(&format!("{mesh}{text}"));
        room.write("room.obj", OBJ);
        room.write("room.mtl", MTL);
        room
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.folder.path().join(name), text).unwrap();
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("room.toml")
    }

    fn load(&self) -> Scene {
        self.with(&[]).unwrap()
    }

    fn with(&self, overrides: &[(&str, &str)]) -> Result<Scene, String> {
        let overrides: Vec<Override> = overrides
            .iter()
            .map(|(key, value)| Override {
                key: (*key).into(),
                value: (*value).into(),
            })
            .collect();
        Scene::load(&self.path(), &overrides).map_err(|error| error.to_string())
    }

    fn error(&self) -> String {
        self.with(&[]).err().expect("an error was expected")
    }
}

fn has(warnings: &[String], text: &str) -> bool {
    warnings.iter().any(|warning| warning.contains(text))
}

#[test]
fn a_room_of_shapes_is_put_together() {
    let scene = Room::new(&format!("{CUBE}{LAMP}{FLOOR}")).load();
    assert_eq!((scene.name.as_str(), scene.surfaces.len()), ("room", 12));
    assert_eq!(scene.objects, ["shape.0"]);
    assert_eq!(
        (scene.materials.len(), scene.materials[0].name.as_str()),
        (1, "plaster")
    );
    assert_eq!(scene.sensors[0].points.len(), 12);
    assert!(scene.sensors[0].points.iter().all(|point| !point.enclosed));
    assert_eq!(scene.need.representation, Representation::Intensity);
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn without_geometry_there_is_still_a_scene() {
    let scene = Room::new(&format!("{LAMP}{FLOOR}")).load();
    assert!(scene.surfaces.is_empty() && scene.materials.is_empty());
}

#[test]
fn overrides_go_before_the_file() {
    let room = Room::new(&format!("{CUBE}{LAMP}{FLOOR}"));
    let scene = room
        .with(&[
            ("material.plaster.a", "0.6"),
            ("run.seed", "7"),
            ("scene.unit", "W"),
        ])
        .unwrap();
    assert_eq!(scene.need.representation, Representation::Linear);
    assert!(
        scene.need.reason.contains("\"plaster\""),
        "{}",
        scene.need.reason
    );
    assert_eq!((scene.settings.seed, scene.unit), (7, Unit::Watt));
    let a = &scene.materials[0].values[2];
    assert_eq!(a.origin.to_string(), "--set material.plaster.a=0.6");
    let error = room.with(&[("material.plaster.roh", "0.6")]).err().unwrap();
    assert!(
        error.starts_with("--set material.plaster.roh=0.6: "),
        "{error}"
    );
    assert!(error.contains("the nearest is \"rho\""), "{error}");
    let error = room.with(&[("sensor.flor.frame", "fixed")]).err().unwrap();
    assert!(error.contains("the nearest is \"floor\""), "{error}");
}

#[test]
fn a_scene_without_light_or_sensors_tells_what_to_add() {
    let error = Room::new(&format!("{CUBE}{FLOOR}")).error();
    assert!(
        error.contains("area lights") && error.contains("[[source]]"),
        "{error}"
    );
    let dark = LAMP.replace("intensity = 10", "intensity = 0");
    assert!(
        Room::new(&format!("{CUBE}{dark}{FLOOR}"))
            .error()
            .contains("nothing emits")
    );
    let error = Room::new(&format!("{CUBE}{LAMP}")).error();
    assert!(
        error.contains("[[sensor]]") && error.contains("grid = { origin"),
        "{error}"
    );
}

#[test]
fn the_snippets_in_errors_can_be_pasted() {
    let error = Room::new(&format!("{CUBE}{LAMP}")).error();
    let snippet: String = error
        .lines()
        .filter(|line| line.starts_with("    "))
        .map(|line| format!("{line}\n"))
        .collect();
    assert_eq!(
        Room::new(&format!("{CUBE}{LAMP}{snippet}"))
            .load()
            .sensors
            .len(),
        1
    );
}

#[test]
fn a_shape_of_an_undefined_material_names_the_nearest() {
    let text = CUBE.replace("material = \"plaster\"", "material = \"plastr\"");
    let error = Room::new(&format!("{text}{LAMP}{FLOOR}")).error();
    assert!(
        error.contains(
            "room.toml:6:12: no material is called \"plastr\"; the nearest is \"plaster\""
        ),
        "{error}"
    );
}

#[test]
fn a_mesh_that_is_not_there_is_told_at_its_file() {
    let error = Room::new(&format!("[[mesh]]\nfile = \"absent.glb\"\n{LAMP}{FLOOR}")).error();
    assert!(
        error.contains("room.toml:2:8: ") && error.contains("absent.glb"),
        "{error}"
    );
}

#[test]
fn an_obj_gives_its_materials_and_its_sensor_is_no_geometry() {
    let scene = Room::with_obj(LAMP).load();
    assert_eq!(scene.surfaces.len(), 2);
    let values: Vec<(&str, &str)> = scene.materials[0]
        .values
        .iter()
        .map(|it| (it.key, it.value.as_str()))
        .collect();
    assert_eq!(
        values[..5],
        [
            ("kind", "mixture"),
            ("rho", "0.5"),
            ("a", "0"),
            ("n", "1.45"),
            ("k", "0")
        ]
    );
    assert_eq!(
        (scene.sensors.len(), scene.sensors[0].name.as_str()),
        (1, "SENSOR_Board")
    );
    assert_eq!(
        scene.sensors[0].points[0].position,
        DVec3::new(0.5, 0.5, 2.0)
    );
}

#[test]
fn a_sensor_of_the_scene_file_takes_the_marked_object_s_place() {
    let text = "[[sensor]]\nname = \"board\"\nmesh = \"SENSOR_*\"\nspacing = 0.5\n";
    let scene = Room::with_obj(&format!("{LAMP}{text}")).load();
    assert_eq!((scene.sensors.len(), scene.sensors[0].points.len()), (1, 4));
    assert!(!has(&scene.warnings, "no geometry"));
}

#[test]
fn an_unmarked_object_under_a_sensor_is_no_geometry_and_warned_of() {
    let text = "[[sensor]]\nname = \"t\"\nmesh = \"Table\"\n";
    let scene = Room::with_obj(&format!("{LAMP}{text}")).load();
    assert!(
        scene.surfaces.is_empty() && has(&scene.warnings, "\"Table\" (room.obj) is no geometry")
    );
}

#[test]
fn a_sensor_on_an_object_that_is_not_there_names_the_nearest() {
    let text = "[[sensor]]\nname = \"t\"\nmesh = \"Tabel\"\n";
    let error = Room::with_obj(&format!("{LAMP}{text}")).error();
    assert!(
        error.contains(
            "room.toml:10:8: no mesh object is called \"Tabel\"; the nearest is \"Table\""
        ),
        "{error}"
    );
}

#[test]
fn sensor_names_differ_even_without_case() {
    let twice = FLOOR.replace("floor", "Floor");
    let error = Room::new(&format!("{CUBE}{LAMP}{FLOOR}{twice}")).error();
    assert!(error.contains("\"Floor\" is used twice"), "{error}");
    let clash = FLOOR.replace("floor", "SENSOR_Board");
    let error = Room::with_obj(&format!("{LAMP}{clash}")).error();
    assert!(error.contains("is a sensor already"), "{error}");
}

#[test]
fn a_space_that_obj_turned_into_an_underscore_is_suggested() {
    let error = Room::with_obj(&format!("{LAMP}[material.\"Wall Paint\"]\nrho = 0.1\n")).error();
    assert!(
        error.contains("\"Wall_Paint\" (OBJ turns a space into _)"),
        "{error}"
    );
}

#[test]
fn a_material_without_reflectance_names_object_and_material() {
    let room = Room::with_obj(LAMP);
    room.write("room.mtl", "newmtl Wall_Paint\nillum 2\n");
    let error = room.error();
    assert!(
        error.contains("object \"Table\" (room.obj), material \"Wall_Paint\""),
        "{error}"
    );
    assert!(
        error.contains("[material.\"Wall_Paint\"]\n    rho = 0.5"),
        "{error}"
    );
    let scene = room
        .with(&[("material.\"Wall_Paint\".rho", "0.2")])
        .unwrap();
    assert_eq!(scene.materials[0].values[1].value, "0.2");
}

#[test]
fn faces_without_a_material_can_be_described_in_the_scene_file() {
    let room = Room::with_obj(LAMP);
    room.write("room.obj", "o Table\nv 0 0 1\nv 2 0 1\nv 2 2 1\nf 1 2 3\n");
    let error = room
        .with(&[("sensor", "[{ name = 'a', points = [[0, 0, 2]] }]")])
        .err()
        .unwrap();
    assert!(
        error.contains("object \"Table\" (room.obj) has faces without a material"),
        "{error}"
    );
    let sensor = ("sensor", "[{ name = 'a', points = [[0, 0, 2]] }]");
    assert!(room.with(&[sensor, ("material.\"*\".rho", "0.2")]).is_ok());
    assert!(
        room.with(&[sensor, ("material.\"(none)\".rho", "0.2")])
            .is_ok()
    );
}

#[test]
fn a_lamp_flush_in_a_ceiling_hides_it_and_the_pair_is_named() {
    let lamp = "[[shape]]\nkind = \"rectangle\"\norigin = [1, 1, 2.5]\nu = [0, 1, 0]\nv = [1, 0, 0]\nmaterial = \"lamp\"\n\
        [material.lamp]\nrho = 0\nexitance = 1000\nemission_stokes = [1, 0.5, 0, 0]\n";
    let scene = Room::new(&format!("{CUBE}{lamp}{FLOOR}")).load();
    assert!(
        has(
            &scene.coincidences,
            "\"shape.1\" (lamp) hides 1.000000 m² of \"shape.0\" (plaster)"
        ),
        "{:?}",
        scene.warnings
    );
    let emission = scene.materials[1].emission.as_ref().unwrap();
    assert!((emission.exitance - 1000.0).abs() < 1e-12 && emission.axis == DVec3::X);
    assert_eq!(scene.need.representation, Representation::Linear);
}

#[test]
fn points_in_a_dark_solid_are_enclosed_and_those_on_its_top_are_not() {
    let cabinet = "[[shape]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"plaster\"\n\
        [[sensor]]\nname = \"top\"\npoints = [[0.5, 0.5, 1]]\n";
    let room = Room::new(&format!("{CUBE}{cabinet}{LAMP}{FLOOR}"));
    let enclosed = |scene: &Scene, sensor: usize| -> Vec<bool> {
        scene.sensors[sensor]
            .points
            .iter()
            .map(|point| point.enclosed)
            .collect()
    };
    let scene = room.load();
    assert_eq!(enclosed(&scene, 0), [false]);
    assert_eq!(
        enclosed(&scene, 1)
            .iter()
            .filter(|enclosed| **enclosed)
            .count(),
        1
    );
    assert!(scene.sensors[1].points[0].enclosed);
    let lit = room
        .with(&[("source.0.position", "[0.5, 0.5, 0.5]")])
        .unwrap();
    assert!(!enclosed(&lit, 1).contains(&true));
}

#[test]
fn a_solid_that_glows_inward_encloses_nothing() {
    let text = "[[shape]]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"glow\"\ninward = true\n\
        [material.glow]\nrho = 0.5\nexitance = 1\n\
        [[sensor]]\nname = \"two\"\npoints = [[0.5, 0.5, 0.5], [2, 0.5, 0.5]]\n";
    let room = Room::new(text);
    let points = |scene: Scene| {
        scene.sensors[0]
            .points
            .iter()
            .map(|it| it.enclosed)
            .collect::<Vec<_>>()
    };
    assert_eq!(points(room.load()), [false, false]);
    let outward = room.with(&[("shape.0.inward", "false")]).unwrap();
    assert_eq!(points(outward), [true, false]);
}

#[test]
fn a_room_in_millimetres_is_suspected() {
    let text = CUBE.replace("[4, 3, 2.5]", "[4000, 3000, 2500]");
    assert!(has(
        &Room::new(&format!("{text}{LAMP}{FLOOR}")).load().warnings,
        "is no room"
    ));
    let unit = CUBE.replace("[4, 3, 2.5]", "[1, 1, 1]");
    assert!(!has(
        &Room::new(&format!("{unit}{LAMP}{FLOOR}")).load().warnings,
        "is no room"
    ));
}

#[test]
fn a_representation_that_leaves_something_out_is_warned_of() {
    let room = Room::new(&format!("{CUBE}{LAMP}{FLOOR}"));
    let stokes = ("source.0.stokes", "[1, 0, 0, 1]");
    let scene = room
        .with(&[stokes, ("run.representation", "linear")])
        .unwrap();
    assert_eq!(scene.representation(), Representation::Linear);
    assert!(
        has(
            &scene.warnings,
            "the scene needs \"full\", because source \"source.0\""
        ),
        "{:?}",
        scene.warnings
    );
    let scalar = room.with(&[stokes, ("run.model", "scalar")]).unwrap();
    assert_eq!(scalar.need.representation, Representation::Intensity);
}

#[test]
fn a_metal_needs_all_components_and_an_ideal_mirror_does_not() {
    let room = Room::new(&format!("{CUBE}{LAMP}{FLOOR}"));
    // Not all of it mirror: a closed room without loss is refused.
    let glossy = ("material.plaster.a", "0.9");
    let need = |n: &str, k: &str| {
        let values = [glossy, ("material.plaster.n", n), ("material.plaster.k", k)];
        room.with(&values).unwrap().need.representation
    };
    assert_eq!(need("2.76", "3.79"), Representation::Full);
    assert_eq!(need("inf", "0"), Representation::Linear);
}

#[test]
fn a_closed_room_that_loses_nothing_is_refused_and_an_open_one_is_not() {
    let room = Room::new(&format!("{CUBE}{LAMP}{FLOOR}"));
    let white = ("material.plaster.rho", "1");
    let error = room.with(&[white]).err().unwrap();
    assert!(
        error.contains("nothing absorbs light") && error.contains("plaster"),
        "{error}"
    );
    assert!(
        room.with(&[
            white,
            ("shape.0.inward", "false"),
            ("sensor.0.normal", "[0, 0, -1]")
        ])
        .is_ok()
    );
}

#[test]
fn white_materials_are_named() {
    let told = |material: &str| {
        let text = format!("{}{LAMP}{FLOOR}", CUBE.replace("rho = 0.5", material));
        let sheet = "[[shape]]\nkind = \"rectangle\"\norigin = [1, 1, 1]\nu = [1, 0, 0]\nv = [0, 1, 0]\nmaterial = \"sheet\"\n\
            [material.sheet]\nrho = 0.5\n";
        let warnings = Room::new(&format!("{text}{sheet}")).load().warnings;
        warnings
            .iter()
            .any(|it| it.contains("keep no light (rho = 1): plaster"))
    };
    assert!(told("rho = 1"));
    assert!(told("rho = 1\nkind = \"coated\""));
    for lossy in ["rho = 0.999", "rho = 1\na = 0.5", "a = 1\nn = inf\nrho = 1"] {
        assert!(!told(lossy), "{lossy}");
    }
}
