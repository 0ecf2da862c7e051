//! Where the bytes of a glTF file's buffers and images are.

use std::io;
use std::path::{Path, PathBuf};

/// Why the bytes of a URI are not there.
pub(super) enum Failure {
    /// A file that cannot be read.
    File(PathBuf, io::Error),
    /// A URI that is no relative file and no data.
    Uri(String),
}

/// The bytes of a relative URI beside `file`, or of a `data:` URI in base64.
pub(super) fn bytes(file: &Path, uri: &str) -> Result<Vec<u8>, Failure> {
    if let Some(data) = uri.strip_prefix("data:") {
        return data
            .split_once(";base64,")
            .and_then(|(_, text)| base64(text))
            .ok_or_else(|| Failure::Uri("a data URI that is no base64".to_owned()));
    }
    if uri.contains("://") {
        return Err(Failure::Uri(format!("the URI {uri:?}")));
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let path = folder.join(percent_decoded(uri));
    std::fs::read(&path).or_else(|reason| {
        // Some exporters write the name as it stands, percent signs and all.
        std::fs::read(folder.join(uri)).map_err(|_| Failure::File(path, reason))
    })
}

/// The text with every %XX replaced by its byte (RFC 3986, 2.1); as it is where that is no UTF-8.
fn percent_decoded(uri: &str) -> String {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let escaped = after
            .get(..2)
            .filter(|digits| byte == b'%' && digits.iter().all(u8::is_ascii_hexdigit))
            .and_then(|digits| std::str::from_utf8(digits).ok())
            .and_then(|digits| u8::from_str_radix(digits, 16).ok());
        decoded.push(escaped.unwrap_or(byte));
        rest = if escaped.is_some() {
            &after[2..]
        } else {
            after
        };
    }
    String::from_utf8(decoded).unwrap_or_else(|_| uri.to_owned())
}

/// Decodes base64 (RFC 4648, both alphabets, padding optional).
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_ascii().trim_end_matches('=');
    if text.len() % 4 == 1 {
        return None;
    }
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut bits, mut count) = (0u32, 0);
    for symbol in text.bytes() {
        let value = match symbol {
            b'A'..=b'Z' => symbol - b'A',
            b'a'..=b'z' => symbol - b'a' + 26,
            b'0'..=b'9' => symbol - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_decoded_as_in_the_test_vectors_of_rfc_4648() {
        for (text, plain) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
            ("Zm9vYg", "foob"),
        ] {
            assert_eq!(base64(text).as_deref(), Some(plain.as_bytes()), "{text}");
        }
        assert_eq!(base64("_-+/"), Some(vec![0xff, 0xef, 0xbf]));
        assert_eq!(base64("Z"), None);
        assert_eq!(base64("Zm 9v"), None);
    }

    #[test]
    fn escapes_are_decoded_and_stray_percent_signs_left() {
        assert_eq!(percent_decoded("a%20b%C3%BC.bin"), "a bü.bin");
        assert_eq!(percent_decoded("100%.bin%2"), "100%.bin%2");
        assert_eq!(percent_decoded("%ff"), "%ff");
    }
}
