//! What a TIFF of a picture says of itself.

/// What a TIFF of a picture says of itself, as lines `key = value` of ASCII, the only text that TIFF allows.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Name of the scene.
    pub scene: String,
    /// Unit of every channel, such as `lm/(m²·sr)`.
    pub unit: String,
    /// What the channels hold.
    pub channels: String,
    /// Standard error of S0, as a share of its mean.
    pub standard_error: f64,
    /// Whether all samples were taken.
    pub complete: bool,
}

/// What names the program that writes a file, in its tag Software and in the description.
pub const SOFTWARE: &str = concat!("malus ", env!("CARGO_PKG_VERSION"));

impl Description {
    /// The text of the tag ImageDescription.
    pub fn text(&self) -> String {
        let complete = if self.complete { "yes" } else { "no" };
        format!(
            "{SOFTWARE}\nscene = {}\nunit = {}\nchannels = {}\nx axis = right\n\
             order = rows from the top, pixels from the left\nstandard error of S0 = {:e}\ncomplete = {complete}\n",
            ascii(&self.scene),
            ascii(&self.unit.replace('²', "^2").replace('·', " ")),
            ascii(&self.channels),
            self.standard_error,
        )
    }

    /// Reads a text back; what it does not say is empty, without error and complete.
    pub fn read(text: &str) -> Self {
        let value = |key: &str| {
            let mut lines = text.lines().filter_map(|line| line.split_once(" = "));
            lines.find(|(name, _)| *name == key).map(|(_, value)| value)
        };
        let named = |key: &str| value(key).unwrap_or_default().to_owned();
        let error = value("standard error of S0").and_then(|value| value.parse().ok());
        Self {
            scene: named("scene"),
            unit: named("unit").replace("m^2 sr", "m²·sr"),
            channels: named("channels"),
            standard_error: error.unwrap_or(0.0),
            complete: value("complete") != Some("no"),
        }
    }
}

/// The text with everything that is not printable ASCII written as `\u{…}`.
fn ascii(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            ' '..='~' => plain.push(c),
            _ => plain.extend(c.escape_unicode()),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_description_reads_back() {
        let description = Description {
            scene: "A = \"B\"".to_owned(),
            unit: "lm/(m²·sr)".to_owned(),
            channels: "S0 S1 S2 S3".to_owned(),
            standard_error: 0.0125,
            complete: false,
        };
        assert!(description.text().contains("\nunit = lm/(m^2 sr)\n"));
        assert_eq!(Description::read(&description.text()), description);
    }

    #[test]
    fn a_name_cannot_break_out_of_its_line() {
        let description = Description {
            scene: "Café\ncomplete = no\0".to_owned(),
            unit: String::new(),
            channels: String::new(),
            standard_error: 0.0,
            complete: true,
        };
        let text = description.text();
        assert!(text.is_ascii() && !text.contains('\0'));
        assert!(Description::read(&text).complete);
        assert!(
            text.contains("scene = Caf\\u{e9}\\u{a}complete = no\\u{0}\n"),
            "{text}"
        );
    }

    #[test]
    fn a_text_of_others_says_nothing() {
        let description = Description::read("made by hand");
        assert!(description.complete && description.unit.is_empty());
        assert!(description.standard_error.abs() <= 0.0);
    }
}
