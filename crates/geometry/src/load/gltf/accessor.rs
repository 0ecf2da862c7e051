//! Positions and indices out of the binary data.

use super::super::LoadError;
use super::buffer::Buffers;
use ::gltf::Accessor;
use ::gltf::accessor::sparse::IndexType;
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::buffer::View;
use glam::DVec3;
use std::path::Path;

/// Most elements that an accessor without data of its own may imply: such a one is all zeros but for its sparse
/// values, and its count is bounded by nothing in the file.
const MOST_IMPLIED: usize = 1 << 22;

/// Reads accessors, checking every range.
pub(super) struct Accessors<'a> {
    pub file: &'a Path,
    pub buffers: &'a Buffers<'a>,
}

impl Accessors<'_> {
    /// Positions in the file's own coordinates.
    ///
    /// # Errors
    /// If they are not three floats each, lie outside their buffer or are not finite. `mesh` names the place.
    pub(super) fn positions(
        &self,
        accessor: &Accessor,
        mesh: &str,
    ) -> Result<Vec<DVec3>, LoadError> {
        if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
            return Err(self.unexpected(
                accessor,
                mesh,
                "positions are three floats (VEC3, FLOAT)",
            ));
        }
        let positions = self.read(accessor, DVec3::ZERO, |bytes: &[u8; 12]| {
            let [x, y, z] = [0, 4, 8].map(|i| {
                f64::from(f32::from_le_bytes([
                    bytes[i],
                    bytes[i + 1],
                    bytes[i + 2],
                    bytes[i + 3],
                ]))
            });
            DVec3::new(x, y, z)
        })?;
        match positions.iter().position(|p| !p.is_finite()) {
            Some(vertex) => Err(LoadError::NotFinite {
                file: self.file.to_owned(),
                place: mesh.to_owned(),
                vertex,
                found: positions[vertex].to_array(),
            }),
            None => Ok(positions),
        }
    }

    /// Vertex indices.
    pub(super) fn indices(&self, accessor: &Accessor, mesh: &str) -> Result<Vec<u32>, LoadError> {
        match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => {
                self.read(accessor, 0, |b: &[u8; 1]| u32::from(b[0]))
            }
            (DataType::U16, Dimensions::Scalar) => {
                self.read(accessor, 0, |b: &[u8; 2]| u32::from(u16::from_le_bytes(*b)))
            }
            (DataType::U32, Dimensions::Scalar) => {
                self.read(accessor, 0, |b: &[u8; 4]| u32::from_le_bytes(*b))
            }
            _ => Err(self.unexpected(accessor, mesh, "indices are unsigned integers (SCALAR)")),
        }
    }

    fn unexpected(&self, accessor: &Accessor, mesh: &str, allowed: &str) -> LoadError {
        LoadError::invalid(
            self.file,
            format!("{mesh}, accessors[{}]", accessor.index()),
            format!("{:?} of {:?}", accessor.dimensions(), accessor.data_type()),
            allowed,
        )
    }

    /// All elements of an accessor, sparse ones put in their places.
    fn read<T: Clone, const SIZE: usize>(
        &self,
        accessor: &Accessor,
        zero: T,
        decode: impl Fn(&[u8; SIZE]) -> T,
    ) -> Result<Vec<T>, LoadError> {
        let place = format!("accessors[{}]", accessor.index());
        let count = accessor.count();
        let mut elements: Vec<T> = match accessor.view() {
            Some(view) => self
                .elements(&view, accessor.offset(), count, &place)?
                .map(&decode)
                .collect(),
            None if count <= MOST_IMPLIED => vec![zero; count],
            None => {
                return Err(LoadError::invalid(
                    self.file,
                    place,
                    format!("{count} elements without a bufferView"),
                    format!("at most {MOST_IMPLIED}"),
                ));
            }
        };
        let Some(sparse) = accessor.sparse() else {
            return Ok(elements);
        };
        let place = format!("{place}.sparse");
        let (indices, values) = (sparse.indices(), sparse.values());
        let (view, offset) = (indices.view(), indices.offset());
        let indices: Vec<usize> = match indices.index_type() {
            IndexType::U8 => self
                .elements(&view, offset, sparse.count(), &place)?
                .map(|b: &[u8; 1]| usize::from(b[0]))
                .collect(),
            IndexType::U16 => self
                .elements(&view, offset, sparse.count(), &place)?
                .map(|b: &[u8; 2]| usize::from(u16::from_le_bytes(*b)))
                .collect(),
            IndexType::U32 => self
                .elements(&view, offset, sparse.count(), &place)?
                .map(|b: &[u8; 4]| u32::from_le_bytes(*b) as usize)
                .collect(),
        };
        let values = self.elements(&values.view(), values.offset(), sparse.count(), &place)?;
        for (index, value) in indices.into_iter().zip(values) {
            *elements.get_mut(index).ok_or_else(|| LoadError::Index {
                file: self.file.to_owned(),
                place: place.clone(),
                index: index as i64,
                count,
            })? = decode(value);
        }
        Ok(elements)
    }

    /// The raw elements of a view.
    fn elements<'s, const SIZE: usize>(
        &'s self,
        view: &View,
        offset: usize,
        count: usize,
        place: &str,
    ) -> Result<impl Iterator<Item = &'s [u8; SIZE]> + use<'s, SIZE>, LoadError> {
        let bytes = self.buffers.view(view)?;
        let stride = view.stride().unwrap_or(SIZE);
        if stride < SIZE {
            return Err(LoadError::invalid(
                self.file,
                format!("bufferViews[{}]", view.index()),
                format!("a byteStride of {stride}"),
                format!("{place} has elements of {SIZE} bytes"),
            ));
        }
        // All three are below 2^64: the sum cannot overflow.
        let needed = match count {
            0 => 0,
            _ => offset as u128 + (count - 1) as u128 * stride as u128 + SIZE as u128,
        };
        if needed > bytes.len() as u128 {
            return Err(LoadError::Range {
                file: self.file.to_owned(),
                place: format!("{place}, bufferViews[{}]", view.index()),
                needed,
                available: bytes.len() as u128,
            });
        }
        let bytes = bytes.get(offset..).unwrap_or_default();
        Ok(bytes
            .chunks(stride)
            .filter_map(|chunk| chunk.first_chunk())
            .take(count))
    }
}
