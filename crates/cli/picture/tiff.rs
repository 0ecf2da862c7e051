//! TIFF files of 32-bit floats.

use super::description::{Description, SOFTWARE};
use ::tiff::TiffResult;
use ::tiff::encoder::colortype::Gray32Float;
use ::tiff::encoder::{TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard};
use ::tiff::tags::{ExtraSamples, Tag};
use anyhow::Result;
use std::io::{Seek, Write};
use std::ops::Range;

/// Bytes of pixels above which offsets need 64 bits (BigTIFF); some are left for what else is in a file.
const LARGEST: u64 = 0xF000_0000;

/// What a TIFF holds, besides its pixels.
#[derive(Clone, Copy, Debug)]
pub struct Form<'a> {
    /// Width and height.
    pub sides: [u32; 2],
    /// Samples per pixel, ≥ 1.
    pub channels: usize,
    /// What the file says of itself.
    pub description: &'a Description,
}

/// Writes a TIFF, uncompressed, in strips; `fill` appends the samples of the pixels that it is asked for, in the order of
/// the file: by rows from the top left, channel after channel within a pixel.
///
/// # Errors
/// The file cannot be written.
pub fn write(
    file: &mut (impl Write + Seek),
    form: Form<'_>,
    fill: impl FnMut(Range<usize>, &mut Vec<f32>),
) -> Result<()> {
    let [width, height] = form.sides.map(u64::from);
    let bytes = width * height * form.channels as u64 * 4;
    if bytes > LARGEST {
        encode::<_, TiffKindBig>(file, form, fill)?;
    } else {
        encode::<_, TiffKindStandard>(file, form, fill)?;
    }
    Ok(())
}

fn encode<W: Write + Seek, K: TiffKind>(
    file: &mut W,
    form: Form<'_>,
    mut fill: impl FnMut(Range<usize>, &mut Vec<f32>),
) -> TiffResult<()> {
    let [width, height] = form.sides;
    let mut encoder = TiffEncoder::<_, K>::new_generic(file)?;
    let mut image = encoder.new_image::<Gray32Float>(width, height)?;
    if form.channels > 1 {
        // The first sample is a grey, so that other programs show it; of the others TIFF knows nothing.
        image.extra_samples(&vec![ExtraSamples::Unspecified; form.channels - 1])?;
    }
    let tags = image.encoder();
    tags.write_tag(Tag::ImageDescription, form.description.text().as_str())?;
    tags.write_tag(Tag::Software, SOFTWARE)?;
    let mut strip = Vec::new();
    let mut pixel = 0;
    loop {
        let samples = usize::try_from(image.next_strip_sample_count())?;
        if samples == 0 {
            break;
        }
        let next = pixel + samples / form.channels;
        strip.clear();
        fill(pixel..next, &mut strip);
        image.write_strip(&strip)?;
        pixel = next;
    }
    image.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::tiff::decoder::{Decoder, DecodingResult};
    use std::io::Cursor;

    fn description() -> Description {
        Description {
            scene: "room".to_owned(),
            unit: "lm/(m²·sr)".to_owned(),
            channels: "S0".to_owned(),
            standard_error: 0.01,
            complete: true,
        }
    }

    /// More rows than one strip holds, and a last strip that is not full.
    #[test]
    fn strips_join_to_the_picture() {
        let description = description();
        for channels in [1, 4] {
            let form = Form {
                sides: [300, 1003],
                channels,
                description: &description,
            };
            let mut file = Cursor::new(Vec::new());
            write(&mut file, form, |pixels, strip| {
                let samples = pixels.start * channels..pixels.end * channels;
                strip.extend(samples.map(|sample| sample as f32));
            })
            .expect("written");
            let mut decoder = Decoder::new(Cursor::new(file.into_inner())).expect("a TIFF");
            assert!(decoder.strip_count().expect("strips") > 1);
            let text = decoder.get_tag_ascii_string(Tag::ImageDescription);
            assert_eq!(text.expect("a text"), description.text());
            let DecodingResult::F32(samples) = decoder.read_image().expect("pixels") else {
                panic!("no floats");
            };
            assert_eq!(samples.len(), 300 * 1003 * channels);
            let in_order =
                |(index, sample): (usize, &f32)| sample.to_bits() == (index as f32).to_bits();
            assert!(samples.iter().enumerate().all(in_order));
        }
    }

    #[test]
    fn large_files_have_long_offsets() {
        let description = description();
        let form = Form {
            sides: [2, 2],
            channels: 1,
            description: &description,
        };
        let mut file = Cursor::new(Vec::new());
        encode::<_, TiffKindBig>(&mut file, form, |_, strip| {
            strip.extend([0.0, 1.0, 2.0, 3.0])
        })
        .expect("written");
        assert_eq!(file.get_ref()[2], 43, "the mark of BigTIFF");
        let mut decoder = Decoder::new(Cursor::new(file.into_inner())).expect("a TIFF");
        let DecodingResult::F32(samples) = decoder.read_image().expect("pixels") else {
            panic!("no floats");
        };
        assert_eq!(samples, [0.0, 1.0, 2.0, 3.0]);
    }
}
