use super::*;

fn table(text: &str) -> Reader {
    let node = Node::document(&"room.toml".into(), text).unwrap();
    Reader::new("[material.wall]".into(), node).unwrap()
}

fn field(text: &str) -> Field {
    table(text).take("x").unwrap()
}

fn message<T>(result: Result<T, Error>) -> String {
    match result {
        Ok(_) => panic!("an error was expected"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn an_unknown_key_names_the_nearest_and_its_place() {
    let mut reader = table("rho = 0.5\nexitence = 3");
    assert!(reader.take("rho").is_some());
    assert!(reader.take("exitance").is_none());
    let message = message(reader.finish());
    assert!(message.starts_with("room.toml:2:1: "), "{message}");
    assert!(message.contains("[material.wall]"), "{message}");
    assert!(message.contains("the nearest is \"exitance\""), "{message}");
}

#[test]
fn every_unknown_key_is_told_at_once() {
    let mut reader = table("one = 1\ntwo = 2");
    assert!(reader.take("rho").is_none());
    let message = message(reader.finish());
    assert!(
        message.contains("\"one\"") && message.contains("\"two\""),
        "{message}"
    );
}

#[test]
fn a_wrong_type_tells_what_was_found_and_what_is_allowed() {
    let message = message(field("x = \"half\"").number(Allowed::Share));
    assert!(message.starts_with("room.toml:1:5: "), "{message}");
    assert!(
        message.contains("from 0 to 1") && message.contains("\"half\""),
        "{message}"
    );
}

#[test]
fn a_number_out_of_range_is_refused() {
    assert!(message(field("x = 1.5").number(Allowed::Share)).contains("found 1.5"));
    assert!(message(field("x = nan").number(Allowed::Finite)).contains("found NaN"));
    assert!(message(field("x = inf").number(Allowed::Finite)).contains("found inf"));
    assert!(
        field("x = inf")
            .number(Allowed::Index)
            .unwrap()
            .is_infinite()
    );
}

#[test]
fn a_vector_of_the_wrong_length_is_refused() {
    let message = message(field("x = [1, 2]").vector());
    assert!(
        message.contains("a list of 3 numbers") && message.contains("a list of 2"),
        "{message}"
    );
}

#[test]
fn a_bad_number_in_a_vector_is_located() {
    let message = message(field("x = [1, nan, 3]").vector());
    assert!(message.starts_with("room.toml:1:9: "), "{message}");
    assert!(message.contains("x[1]"), "{message}");
}

#[test]
fn a_direction_has_length_one_and_is_not_zero() {
    assert_eq!(field("x = [0, 0, -3]").direction().unwrap(), DVec3::NEG_Z);
    assert_eq!(field("x = [1e-200, 0, 0]").direction().unwrap(), DVec3::X);
    assert!(message(field("x = [0, 0, 0]").direction()).contains("not zero"));
}

#[test]
fn a_whole_number_may_be_written_with_an_exponent() {
    assert_eq!(field("x = 1e6").whole(1, u64::MAX).unwrap(), 1_000_000);
    assert_eq!(
        field("x = 18446744073709551615")
            .whole(0, u64::MAX)
            .unwrap(),
        u64::MAX
    );
    assert!(message(field("x = 1.5").whole(1, u64::MAX)).contains("whole number ≥ 1"));
    assert!(message(field("x = -1").whole(0, 9)).contains("from 0 to 9"));
}

#[test]
fn a_word_that_is_none_of_the_choices_tells_the_nearest() {
    let message = message(field("x = \"sclar\"").choice(&[("scalar", 1), ("diffuse", 2)]));
    assert!(message.contains("\"scalar\" or \"diffuse\""), "{message}");
    assert!(message.contains("the nearest is \"scalar\""), "{message}");
}

#[test]
fn a_missing_key_is_told_with_its_table() {
    let message = message(table("").require("kind", "a word").map(|_| ()));
    assert!(
        message.contains("lacks the key \"kind\": a word"),
        "{message}"
    );
}
