use super::*;
use crate::document::Node;

fn library(text: &str) -> Result<Library, String> {
    let node = Node::document(&"room.toml".into(), text).unwrap();
    let field = Reader::new("the scene file".into(), node)
        .unwrap()
        .take("material");
    Library::read(field).map_err(|error| error.to_string())
}

fn rho(library: &Library, name: &str) -> Option<f64> {
    library
        .value(name, |written| written.rho.as_ref())
        .map(|(rho, _)| rho)
}

#[test]
fn an_exact_name_goes_before_globs_and_the_longest_glob_before_others() {
    let text = "[material.\"*\"]\nrho = 0.1\n[material.\"Wall*\"]\nrho = 0.2\n[material.Wall_West]\nrho = 0.3";
    let library = library(text).unwrap();
    assert_eq!(rho(&library, "Wall_West"), Some(0.3));
    assert_eq!(rho(&library, "Wall_East"), Some(0.2));
    assert_eq!(rho(&library, "Floor"), Some(0.1));
    assert_eq!(rho(&library, "wall_East"), Some(0.1));
}

#[test]
fn of_two_globs_of_one_length_the_later_counts() {
    let library = library("[material.\"Wa*\"]\nrho = 0.2\n[material.\"*ll\"]\nrho = 0.3").unwrap();
    assert_eq!(rho(&library, "Wall"), Some(0.3));
    let text = "[material.\"*ll\"]\nrho = 0.3\n[material.\"Wa*\"]\nrho = 0.2";
    assert_eq!(
        rho(&super::tests::library(text).unwrap(), "Wall"),
        Some(0.2)
    );
}

#[test]
fn each_value_is_looked_up_by_itself() {
    let library = library("[material.\"W*\"]\nrho = 0.2\n[material.Wall]\na = 1.0").unwrap();
    assert_eq!(rho(&library, "Wall"), Some(0.2));
    let (a, origin) = library.value("Wall", |written| written.a.as_ref()).unwrap();
    assert!((a - 1.0).abs() < 1e-15);
    assert_eq!(origin, Origin::Exact("room.toml:4:5".into()));
}

#[test]
fn a_name_with_glob_characters_can_be_meant_literally() {
    let library =
        library("[material.\"Wall [old\"]\nrho = 0.4\n[material.\"Wall*\"]\nrho = 0.2").unwrap();
    assert_eq!(rho(&library, "Wall [old"), Some(0.4));
    assert_eq!(rho(&library, "Wall*"), Some(0.2));
}

#[test]
fn a_name_that_matches_nothing_is_an_error_with_the_nearest() {
    let library = library("[material.\"Wal*\"]\n[material.Flor]\n[material.\"Door*\"]").unwrap();
    let mut warnings = Vec::new();
    let names = ["Wall", "Floor"];
    let error = library
        .check_used(&names, true, &mut warnings)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("room.toml:2:11: no material is called \"Flor\"; the nearest is \"Floor\""),
        "{error}"
    );
    assert!(
        error.contains("\"Door*\"") && !error.contains("\"Wal*\""),
        "{error}"
    );
}

#[test]
fn an_unused_name_among_shapes_is_a_warning() {
    let library = library("[material.steel]\nrho = 0").unwrap();
    let mut warnings = Vec::new();
    library
        .check_used(&["plaster"], false, &mut warnings)
        .unwrap();
    assert!(
        warnings[0].contains("\"steel\" is used by nothing"),
        "{warnings:?}"
    );
}

#[test]
fn a_space_that_obj_made_an_underscore_is_suggested() {
    let library = library("[material.\"Wall Paint\"]\nrho = 0").unwrap();
    let names = ["WallPaint", "Wall_Paint"];
    let error = library
        .check_used(&names, true, &mut Vec::new())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("\"Wall_Paint\" (OBJ turns a space into _)"),
        "{error}"
    );
}

#[test]
fn bad_values_are_located() {
    let message = |text: &str| library(text).err().unwrap();
    let error = message("[material.x]\nkind = \"coat\"");
    assert!(
        error.contains("room.toml:2:8") && error.contains("the nearest is \"coated\""),
        "{error}"
    );
    let error = message("[material.x]\ntau = 1.5");
    assert!(
        error.starts_with("room.toml:2:7: [material.x] tau must be a number from 0 to 1"),
        "{error}"
    );
    let error = message("[material.x]\nrho = 1.5");
    assert!(
        error
            .starts_with("room.toml:2:7: [material.x] rho must be a number from 0 to 1, found 1.5"),
        "{error}"
    );
    let error = message("[material.\"x y\"]\nn = 0");
    assert!(
        error.contains("[material.\"x y\"] n must be a number > 0, or inf"),
        "{error}"
    );
    let error = message("[material.x]\nroh = 0.5");
    assert!(error.contains("the nearest is \"rho\""), "{error}");
}
