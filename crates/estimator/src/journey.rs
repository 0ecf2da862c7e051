//! A walk from an emitter taken to its end, vertex by vertex.

use crate::path::{Event, Path, Vertex};
use crate::trace::Walk;

/// How a walk from an emitter ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// At a surface.
    Absorbed,
    /// It met no further surface.
    Escaped,
    /// At the bound on its length.
    Truncated,
}

/// Takes a walk to its end; `pass` is told every vertex in turn. `path` is room to work in.
pub(crate) fn journey<'a>(
    walk: &mut Walk<'a>,
    path: &mut Path<'a>,
    mut pass: impl FnMut(&Vertex),
) -> End {
    let mut absorbed = false;
    loop {
        path.clear();
        let more = walk.advance(path);
        for vertex in &path.vertices {
            pass(vertex);
            absorbed = vertex.event == Event::Absorbed;
        }
        if !more {
            return match (walk.truncated, absorbed) {
                (true, _) => End::Truncated,
                (_, true) => End::Absorbed,
                _ => End::Escaped,
            };
        }
    }
}
