//! Plans of grids.

use super::furnished;

#[test]
fn a_grid_has_a_plan_of_well_formed_xml() {
    let folder = furnished(&[]);
    let plan = folder.text("out/Desk & shelf.svg");
    let root = assert_well_formed(&plan);
    assert_eq!(root, "svg");
    assert!(
        plan.contains("xmlns=\"http://www.w3.org/2000/svg\""),
        "no name space: browsers draw nothing"
    );
    assert!(
        plan.contains("Desk &amp; shelf"),
        "the sensor's name is not in the plan"
    );
    assert!(
        !plan.contains("NaN") && !plan.contains("inf"),
        "a coordinate that is none"
    );
    // A row of points has no plan.
    assert!(!folder.path("out/row.svg").exists());

    let folder = furnished(&["--no-pictures"]);
    assert!(!folder.path("out/Desk & shelf.svg").exists());
}

/// Asserts that tags close in order and that no character stands where XML does not have it; returns the root's name.
#[track_caller]
fn assert_well_formed(xml: &str) -> &str {
    let (mut open, mut root) = (Vec::new(), None);
    let mut rest = xml;
    while let Some(start) = rest.find('<') {
        let (text, tag) = rest.split_at(start);
        assert_text(text, !open.is_empty());
        let end = tag.find('>').expect("a tag that does not end");
        let inside = &tag[1..end];
        rest = &tag[end + 1..];
        if inside.starts_with('?') || inside.starts_with('!') {
            continue;
        }
        if let Some(name) = inside.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "closed out of turn");
            continue;
        }
        let name = inside.split([' ', '\n', '/']).next().unwrap();
        assert!(root.is_none() || !open.is_empty(), "a second root, {name}");
        root.get_or_insert(name);
        let attributes = inside[name.len()..].trim_end_matches('/');
        let parts: Vec<&str> = attributes.split('"').collect();
        assert!(parts.len() % 2 == 1, "an open quote in <{inside}>");
        for pair in parts.chunks_exact(2) {
            assert!(
                pair[0].trim().ends_with('=') && !pair[1].contains('<'),
                "<{inside}>"
            );
            assert_text(pair[1], true);
        }
        if !inside.ends_with('/') {
            open.push(name);
        }
    }
    assert_text(rest, false);
    assert!(open.is_empty(), "never closed: {open:?}");
    root.expect("a root")
}

/// Asserts that every `&` begins an entity, and that there is text only where it may be.
#[track_caller]
fn assert_text(text: &str, allowed: bool) {
    assert!(
        allowed || text.trim().is_empty(),
        "text outside the root: {text}"
    );
    for after in text.split('&').skip(1) {
        let entity = after.split(';').next().unwrap();
        let known = ["amp", "lt", "gt", "quot", "apos"].contains(&entity);
        assert!(known || entity.starts_with('#'), "a bare & in {text}");
    }
}
