//! What glTF files do to an importer, one test each.

mod geometry;
mod meaning;
mod refusals;

use crate::load::{Model, Part};
use glam::DVec3;

fn only_part(model: &Model) -> &Part {
    assert_eq!((model.objects.len(), model.objects[0].parts.len()), (1, 1));
    &model.objects[0].parts[0]
}

/// Sum of the directed areas of a part's triangles.
fn area(part: &Part) -> DVec3 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| part.positions[i as usize]);
        0.5 * (b - a).cross(c - a)
    };
    part.triangles.iter().map(area).sum()
}
