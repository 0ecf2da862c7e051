use super::*;
use crate::document::Node;

fn described(text: &str) -> Result<Described, String> {
    let node = Node::document(&"room.toml".into(), text).unwrap();
    Described::read(Field::new("[[sensor]]".into(), node), Path::new("."))
        .map_err(|error| error.to_string())
}

fn sensor(text: &str) -> Sensor {
    let mut warnings = Vec::new();
    let sensor = described(text).unwrap().placed(&[], &mut warnings).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    sensor
}

const GRID: &str = "name = \"floor\"\ngrid = { origin = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0], counts = [2, 3] }\n";

#[test]
fn a_grid_is_measured_at_the_centres_of_its_cells() {
    let sensor = sensor(GRID);
    assert_eq!(sensor.points.len(), 6);
    assert_eq!(sensor.points[1].position, DVec3::new(0.75, 1.0 / 6.0, 0.0));
    assert_eq!(sensor.points[0].normal, DVec3::Z);
    assert_eq!((sensor.frame, sensor.axis), (Frame::Incidence, DVec3::X));
}

#[test]
fn the_axis_of_a_grid_is_its_u() {
    let text = GRID
        .replace("[1, 0, 0]", "[0, 4, 0]")
        .replace("v = [0, 1, 0]", "v = [1, 0, 0]");
    assert_eq!(sensor(&text).axis, DVec3::Y);
    assert_eq!(
        sensor(&format!("{GRID}axis = [0, -2, 0]")).axis,
        DVec3::NEG_Y
    );
}

#[test]
fn a_line_includes_its_ends() {
    let line = sensor("name = \"l\"\nline = { from = [0, 0, 0], to = [0.3, 0, 0], count = 4 }");
    let xs: Vec<f64> = line.points.iter().map(|point| point.position.x).collect();
    assert_eq!((xs[0], xs[3]), (0.0, 0.3));
    assert!((xs[1] - 0.1).abs() < 1e-15 && line.layout == Layout::Line);
}

#[test]
fn points_take_the_given_normal_at_length_one() {
    let points = sensor("name = \"p\"\npoints = [[1, 2, 3], [4, 5, 6]]\nnormal = [-7, 0, 0]");
    assert_eq!(
        points.points[1],
        SensorPoint::new(DVec3::new(4.0, 5.0, 6.0), DVec3::NEG_X)
    );
    assert_eq!(points.axis, DVec3::Y);
}

#[test]
fn a_sensor_on_a_mesh_waits_for_its_objects() {
    let described = described("name = \"m\"\nmesh = \"Plane*\"\nspacing = 0.25").unwrap();
    assert_eq!(described.objects().unwrap().value, "Plane*");
}

#[test]
fn an_axis_along_the_normal_is_warned_of() {
    let mut warnings = Vec::new();
    let described = described(&format!("{GRID}axis = [0, 0, 1]")).unwrap();
    described.placed(&[], &mut warnings).unwrap();
    assert!(warnings[0].starts_with("room.toml:3:8: "), "{warnings:?}");
}

#[test]
fn what_is_wrong_is_told_where_it_stands() {
    for (text, place, expected) in [
        ("points = [[0, 0, 0]]", "1:1", "lacks the key \"name\""),
        ("name = \"a\"", "1:1", "points, line, file and mesh"),
        ("name = \"a/b\"\npoints = [[0, 0, 0]]", "1:8", "without '/'"),
        ("name = \"a\"\npoints = []", "2:10", "at least one point"),
        (
            "name = \"a\"\npoints = [[0, 0]]",
            "2:11",
            "a list of 3 numbers",
        ),
        (
            "name = \"a\"\npoints = [[0, 0, nan]]",
            "2:18",
            "a finite number",
        ),
        (
            "name = \"a\"\npoints = [[0, 0, 0]]\nnormal = [0, 0, 0]",
            "3:10",
            "not zero",
        ),
        (
            "name = \"a\"\npoints = [[0, 0, 0]]\nfile = \"x.pts\"",
            "3:8",
            "either points or file",
        ),
        (
            "name = \"a\"\npoints = [[0, 0, 0]]\nspacing = 1",
            "3:11",
            "spacing goes with mesh",
        ),
        (
            "name = \"a\"\npoints = [[0, 0, 0]]\nframe = \"fix\"",
            "3:9",
            "the nearest is \"fixed\"",
        ),
        (
            "name = \"a\"\npoints = [[0, 0, 0]]\nfrane = \"fixed\"",
            "3:1",
            "the nearest is \"frame\"",
        ),
        (
            "name = \"a\"\nline = { from = [0, 0, 0], to = [1, 0, 0], count = 1 }",
            "2:52",
            "from 2",
        ),
        (
            "name = \"a\"\nline = { from = [1, 0, 0], to = [1, 0, 0], count = 2 }",
            "2:33",
            "another point",
        ),
        ("name = \"a\"\nfile = \"absent.pts\"", "2:8", "no such file"),
        (
            "name = \"a\"\nmesh = \"P\"\nspacing = 0",
            "3:11",
            "a number > 0",
        ),
    ] {
        let error = described(text).unwrap_err();
        assert!(
            error.starts_with(&format!("room.toml:{place}: ")),
            "{text}: {error}"
        );
        assert!(error.contains(expected), "{text}: {error}");
    }
}

#[test]
fn a_grid_needs_an_area_and_two_counts() {
    for (from, to, expected) in [
        ("v = [0, 1, 0]", "v = [2, 0, 0]", "spans an area"),
        ("u = [1, 0, 0]", "u = [0, 0, 0]", "spans an area"),
        ("[2, 3]", "[2]", "2 whole numbers"),
        ("[2, 3]", "[2, 0]", "from 1 to 10000"),
        ("[2, 3]", "[10000, 10000]", "ten million"),
        (
            "counts",
            "count",
            "has no key \"count\"; the nearest is \"counts\"",
        ),
        ("counts", "cells", "lacks the key \"counts\""),
    ] {
        let error = described(&GRID.replace(from, to)).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn a_radiance_looks_along_its_direction() {
    let text = format!("{GRID}quantity = \"radiance\"\n");
    let sensor = sensor(&format!("{text}direction = [0, 0, -3]"));
    assert_eq!(sensor.quantity, Quantity::Radiance);
    assert_eq!((sensor.frame, sensor.axis), (Frame::Fixed, DVec3::X));
    assert!(
        sensor
            .points
            .iter()
            .all(|point| point.normal == DVec3::NEG_Z)
    );
}

#[test]
fn the_axis_of_a_radiance_is_its_own_or_the_first_across_the_view() {
    let point = "name = \"p\"\npoints = [[1, 2, 3]]\nquantity = \"radiance\"\n";
    assert_eq!(
        sensor(&format!("{point}direction = [0, 1, 0]")).axis,
        DVec3::X
    );
    assert_eq!(
        sensor(&format!("{point}direction = [1, 0, 0]")).axis,
        DVec3::Y
    );
    let along = format!("{GRID}quantity = \"radiance\"\ndirection = [1, 0, 0]");
    assert_eq!(sensor(&along).axis, DVec3::Y);
    let own = sensor(&format!("{point}direction = [1, 0, 0]\naxis = [0, 0, 1]"));
    assert_eq!(own.axis, DVec3::Z);
    let mut warnings = Vec::new();
    let text = format!("{point}direction = [1, 0, 0]\naxis = [2, 0, 0]");
    described(&text)
        .unwrap()
        .placed(&[], &mut warnings)
        .unwrap();
    assert!(
        warnings[0].starts_with("room.toml:5:8: ") && warnings[0].contains("it looks in"),
        "{warnings:?}"
    );
}

#[test]
fn a_file_of_points_says_itself_where_each_looks() {
    let folder = tempfile::tempdir().unwrap();
    let read = |points: &str, line: &str| {
        std::fs::write(folder.path().join("eye.pts"), points).unwrap();
        let text = format!("name = \"e\"\nfile = \"eye.pts\"\nquantity = \"radiance\"\n{line}");
        let node = Node::document(&"room.toml".into(), &text).unwrap();
        let described = Described::read(Field::new("[[sensor]]".into(), node), folder.path());
        let sensor = described.and_then(|it| it.placed(&[], &mut Vec::new()));
        sensor.map_err(|error| error.to_string())
    };
    let normals =
        |sensor: Sensor| -> Vec<DVec3> { sensor.points.iter().map(|point| point.normal).collect() };
    assert_eq!(normals(read("1 1 1 0 2 0\n", "").unwrap()), [DVec3::Y]);
    let two = read("1 1 1 0 2 0\n1 1 1\n", "direction = [1, 0, 0]").unwrap();
    assert_eq!(normals(two), [DVec3::Y, DVec3::X]);
    let error = read("1 1 1 0 2 0\n1 1 1\n", "").unwrap_err();
    assert!(
        error.contains("eye.pts:2:1: ") && error.contains("gives no direction for all"),
        "{error}"
    );
}

#[test]
fn the_direction_goes_before_the_normals_of_faces() {
    let board = Object {
        name: "Board".into(),
        properties: Default::default(),
        parts: vec![malus_geometry::load::Part {
            material: None,
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            faces: vec![0],
        }],
        frame: glam::DAffine3::IDENTITY,
    };
    let text = "name = \"b\"\nmesh = \"Board\"\nquantity = \"radiance\"\ndirection = [0, 0, -1]";
    let sensor = described(text).unwrap().placed(&[&board], &mut Vec::new());
    assert_eq!(sensor.unwrap().points[0].normal, DVec3::NEG_Z);
}

#[test]
fn what_does_not_go_with_a_quantity_is_an_error_that_says_so() {
    let radiance = "quantity = \"radiance\"\n";
    let looks = "quantity = \"radiance\"\ndirection = [0, 0, 1]\n";
    for (text, place, expected) in [
        (
            radiance.to_owned(),
            "1:1",
            "lacks the key \"direction\": [x, y, z], where the sensor looks",
        ),
        (
            format!("{radiance}directoin = [0, 0, 1]"),
            "4:1",
            "the nearest is \"direction\"",
        ),
        (
            format!("{radiance}direction = [0, 0, 0]"),
            "4:13",
            "not zero",
        ),
        (
            format!("{looks}normal = [0, 0, 1]"),
            "5:10",
            "direction is where the sensor looks",
        ),
        (
            format!("{looks}frame = \"fixed\""),
            "5:9",
            "frame goes with quantity = \"irradiance\"",
        ),
        (
            "direction = [0, 0, 1]".into(),
            "3:13",
            "direction goes with quantity = \"radiance\"",
        ),
        (
            "quantity = \"radience\"".into(),
            "3:12",
            "the nearest is \"radiance\"",
        ),
    ] {
        let error = described(&format!("{GRID}{text}")).unwrap_err();
        assert!(
            error.starts_with(&format!("room.toml:{place}: ")),
            "{text}: {error}"
        );
        assert!(error.contains(expected), "{text}: {error}");
    }
}
