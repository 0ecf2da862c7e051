//! The binary data of a glTF file.

use super::super::LoadError;
use super::uri::{self, Failure};
use ::gltf::Document;
use ::gltf::buffer::Source;
use std::borrow::Cow;
use std::path::Path;

/// All buffers of a file, each cut to the length it declares.
pub(super) struct Buffers<'a> {
    pub file: &'a Path,
    list: Vec<Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers; `binary` is the chunk of a GLB.
    pub(super) fn read(
        file: &'a Path,
        document: &Document,
        binary: Option<&'a [u8]>,
    ) -> Result<Self, LoadError> {
        let mut list = Vec::new();
        for buffer in document.buffers() {
            let place = format!("buffers[{}]", buffer.index());
            let mut bytes =
                match buffer.source() {
                    Source::Uri(uri) => uri::bytes(file, uri).map(Cow::Owned).map_err(
                        |failure| match failure {
                            Failure::File(needed, reason) => LoadError::Companion {
                                file: file.to_owned(),
                                place: place.clone(),
                                needed,
                                reason,
                                remedy: "keep it beside the .gltf, or export as glTF Binary (.glb)",
                            },
                            Failure::Uri(found) => LoadError::invalid(
                                file,
                                place.clone(),
                                found,
                                "a buffer is a file beside this one or base64 data",
                            ),
                        },
                    )?,
                    Source::Bin => Cow::Borrowed(binary.ok_or_else(|| {
                        LoadError::invalid(
                            file,
                            place.clone(),
                            "no uri and no binary chunk",
                            "a buffer has a uri, or is the binary chunk of a .glb",
                        )
                    })?),
                };
            if bytes.len() < buffer.length() {
                return Err(LoadError::Range {
                    file: file.to_owned(),
                    place,
                    needed: buffer.length() as u128,
                    available: bytes.len() as u128,
                });
            }
            match &mut bytes {
                Cow::Borrowed(bytes) => *bytes = &bytes[..buffer.length()],
                Cow::Owned(bytes) => bytes.truncate(buffer.length()),
            }
            list.push(bytes);
        }
        Ok(Self { file, list })
    }

    /// The bytes of one buffer view.
    pub(super) fn view(&self, view: &::gltf::buffer::View) -> Result<&[u8], LoadError> {
        let buffer: &[u8] = &self.list[view.buffer().index()];
        let end = view.offset() as u128 + view.length() as u128;
        buffer
            .get(view.offset()..)
            .and_then(|bytes| bytes.get(..view.length()))
            .ok_or_else(|| LoadError::Range {
                file: self.file.to_owned(),
                place: format!("bufferViews[{}]", view.index()),
                needed: end,
                available: buffer.len() as u128,
            })
    }
}
