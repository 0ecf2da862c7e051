//! Triangles of a glTF primitive.

use ::gltf::mesh::Mode;

/// The triangles of a primitive; none for points and lines.
///
/// glTF 2.0, section 3.7.2.1: a strip's triangle i is (i, i + 1 + i mod 2, i + 2 − i mod 2), a fan's
/// (i + 1, i + 2, 0). What a strip repeats to turn a corner is dropped.
pub(super) fn triangles(mode: Mode, indices: &[u32]) -> Option<Vec<[u32; 3]>> {
    match mode {
        Mode::Triangles => Some(indices.as_chunks::<3>().0.to_vec()),
        Mode::TriangleStrip => Some(
            indices
                .windows(3)
                .enumerate()
                .map(|(i, w)| {
                    if i % 2 == 0 {
                        [w[0], w[1], w[2]]
                    } else {
                        [w[0], w[2], w[1]]
                    }
                })
                .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
                .collect(),
        ),
        Mode::TriangleFan => {
            let (hub, rim) = indices.split_at(indices.len().min(1));
            Some(rim.windows(2).map(|w| [w[0], w[1], hub[0]]).collect())
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_are_wound_as_the_standard_says() {
        assert_eq!(
            triangles(Mode::TriangleStrip, &[0, 1, 2, 3, 4]),
            Some(vec![[0, 1, 2], [1, 3, 2], [2, 3, 4]])
        );
        assert_eq!(
            triangles(Mode::TriangleFan, &[0, 1, 2, 3]),
            Some(vec![[1, 2, 0], [2, 3, 0]])
        );
    }

    #[test]
    fn the_stitches_of_a_strip_are_no_triangles() {
        assert_eq!(
            triangles(Mode::TriangleStrip, &[0, 1, 2, 2, 3, 3, 4, 5]),
            Some(vec![[0, 1, 2], [3, 5, 4]])
        );
    }

    #[test]
    fn points_and_lines_are_no_triangles() {
        for mode in [Mode::Points, Mode::Lines, Mode::LineLoop, Mode::LineStrip] {
            assert_eq!(triangles(mode, &[0, 1, 2]), None);
        }
    }
}
