//! Pieces of an SVG document.

/// Smallest text, in pixels.
pub const SMALL: f64 = 11.0;

/// Where a text is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its start.
    Start,
    /// At its middle.
    Middle,
    /// At its end.
    End,
}

impl Anchor {
    fn keyword(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// A line of text with its baseline at (x, y).
pub fn text([x, y]: [f64; 2], size: f64, anchor: Anchor, content: &str) -> String {
    let anchor = anchor.keyword();
    let content = escaped(content);
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" text-anchor=\"{anchor}\">{content}</text>\n"
    )
}

/// Width of a text in pixels, rather too large than too small for a sans-serif face.
pub fn text_width(size: f64, content: &str) -> f64 {
    0.6 * size * content.chars().count() as f64
}

/// A straight line.
pub fn line([x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) -> String {
    format!("<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>\n")
}

/// Path data through the points.
pub fn path_data(points: &[[f64; 2]]) -> String {
    let mut data = String::new();
    for (index, [x, y]) in points.iter().enumerate() {
        data += &format!("{}{x:.1} {y:.1}", if index == 0 { "M" } else { "L" });
    }
    data
}

/// Text as XML content or attribute; characters that XML does not allow become U+FFFD.
pub fn escaped(content: &str) -> String {
    let mut text = String::with_capacity(content.len());
    for c in content.chars() {
        match c {
            '&' => text += "&amp;",
            '<' => text += "&lt;",
            '>' => text += "&gt;",
            '"' => text += "&quot;",
            '\'' => text += "&apos;",
            '\t' | '\n' | '\r' => text.push(' '),
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => text.push('\u{fffd}'),
            _ => text.push(c),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_a_name_stays_text() {
        assert_eq!(
            escaped("<a href=\"x\">R&D's\x07"),
            "&lt;a href=&quot;x&quot;&gt;R&amp;D&apos;s\u{fffd}"
        );
    }
}
