//! The two parts of a glTF file: JSON and binary data.

use super::super::LoadError;
use std::path::Path;

/// The JSON text and, from a GLB with one, the binary chunk. What the file is shows in its first bytes,
/// whatever its extension.
pub(super) fn split<'a>(
    file: &Path,
    bytes: &'a [u8],
) -> Result<(&'a [u8], Option<&'a [u8]>), LoadError> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if text.trim_ascii_start().first() == Some(&b'{') {
            return Ok((text, None));
        }
        let start = &bytes[..bytes.len().min(8)];
        return Err(LoadError::invalid(
            file,
            "start of the file",
            format!("\"{}\"", start.escape_ascii()),
            "a .glb begins with \"glTF\", a .gltf with \"{\"",
        ));
    };
    let truncated = |needed: usize| LoadError::Range {
        file: file.to_owned(),
        place: "GLB container, cut short or damaged".to_owned(),
        needed: needed as u128,
        available: bytes.len() as u128,
    };
    let (version, rest) = word(rest).ok_or_else(|| truncated(12))?;
    let (length, mut rest) = word(rest).ok_or_else(|| truncated(12))?;
    if version != 2 {
        return Err(LoadError::invalid(
            file,
            "GLB header",
            format!("version {version}"),
            "only glTF 2.0 is read",
        ));
    }
    if length as usize > bytes.len() {
        return Err(truncated(length as usize));
    }
    let (mut json, mut binary) = (None, None);
    while let Some((size, kind)) = word(rest).and_then(|(size, r)| Some((size, word(r)?))) {
        let (kind, data) = kind;
        let size = size as usize;
        let Some(chunk) = data.get(..size) else {
            return Err(truncated((bytes.len() - data.len()).saturating_add(size)));
        };
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if binary.is_none() => binary = Some(chunk),
            // Chunks of other kinds are to be passed over (glTF 2.0, 4.4.3).
            _ => {}
        }
        rest = &data[size..];
    }
    let json = json.ok_or_else(|| {
        LoadError::invalid(
            file,
            "GLB container",
            "no JSON chunk",
            "the first chunk must be JSON",
        )
    })?;
    Ok((json, binary))
}

fn word(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (word, rest) = bytes.split_first_chunk::<4>()?;
    Some((u32::from_le_bytes(*word), rest))
}
