//! Pictures read back from the TIFF files that a run writes.

use super::description::Description;
use ::tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use ::tiff::tags::{
    CompressionMethod, PhotometricInterpretation, PlanarConfiguration, SampleFormat, Tag,
};
use ::tiff::{TiffError, TiffFormatError};
use anyhow::{Result, anyhow, bail, ensure};
use malus_estimator::Picture;
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek};
use std::path::Path;

/// What a file has to be.
const NEEDED: &str =
    "needed is an uncompressed TIFF of 4 samples per pixel, 32-bit floats, as malus run writes it";

/// A picture, and what its file says of it.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The picture.
    pub picture: Picture,
    /// What the file says.
    pub description: Description,
}

impl Recording {
    /// Reads a file.
    ///
    /// # Errors
    /// There is none, it is no TIFF, it is not whole, it holds other samples than S0 … S3, or one of them is no number.
    /// The error names the file.
    pub fn read(path: &Path) -> Result<Self> {
        let fail = |reason: String| anyhow!("{}: {reason}", path.display());
        if path.is_dir() {
            return Err(fail(format!("is a directory; {NEEDED}")));
        }
        let file = File::open(path).map_err(|error| {
            fail(match error.kind() {
                ErrorKind::NotFound => "there is no such file".to_owned(),
                _ => format!("cannot be read: {error}"),
            })
        })?;
        let length = file
            .metadata()
            .map_err(|error| fail(error.to_string()))?
            .len();
        read(BufReader::new(file), length).map_err(|error| fail(error.to_string()))
    }
}

/// Reads a picture from a file of `length` bytes.
fn read(file: impl Read + Seek, length: u64) -> Result<Recording> {
    let told = |error| told(error, length);
    // Strips are as long as their writer likes; below, `length` bounds them.
    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::MAX;
    limits.intermediate_buffer_size = usize::MAX;
    let mut decoder = Decoder::new(file).map_err(told)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(told)?;
    form(&mut decoder)?;
    let pixels = u64::from(width) * u64::from(height);
    let needed = pixels.saturating_mul(16);
    ensure!(
        needed < length,
        "is not whole: found {length} bytes, {width} × {height} pixels take more than {needed}"
    );
    let text = decoder.find_tag(Tag::ImageDescription).map_err(told)?;
    let text = text.and_then(|value| value.into_string().ok());
    let description = Description::read(&text.unwrap_or_default());
    let mut stokes: Vec<[f32; 4]> = Vec::with_capacity(usize::try_from(pixels)?);
    for index in 0..decoder.strip_count().map_err(told)? {
        let DecodingResult::F32(samples) = decoder.read_chunk(index).map_err(told)? else {
            bail!("found samples that are no 32-bit floats; {NEEDED}");
        };
        stokes.extend_from_slice(samples.as_chunks().0);
    }
    ensure!(
        stokes.len() as u64 == pixels,
        "is damaged: found {} pixels in its strips, expected {width} × {height}",
        stokes.len()
    );
    finite(&stokes, width)?;
    let picture = Picture {
        width,
        height,
        stokes,
        standard_error: description.standard_error,
        complete: description.complete,
    };
    Ok(Recording {
        picture,
        description,
    })
}

/// What an error of the decoder says to a user.
fn told(error: TiffError, length: u64) -> anyhow::Error {
    match error {
        TiffError::FormatError(
            TiffFormatError::TiffSignatureNotFound | TiffFormatError::TiffSignatureInvalid,
        ) => anyhow!("is no TIFF file; {NEEDED}"),
        TiffError::FormatError(TiffFormatError::InvalidDimensions(width, height)) => {
            anyhow!("found a picture of {width} × {height} pixels, at least 1 × 1 is needed")
        }
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            anyhow!("is not whole: found {length} bytes, and the file goes on after them")
        }
        error => anyhow!("cannot be read as a picture: {error}; {NEEDED}"),
    }
}

/// Checks that the file holds S0 … S3 and nothing else.
fn form<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<()> {
    let mut number = |tag, default: u64| -> Result<u64> {
        let found = decoder.find_tag_unsigned_vec::<u64>(tag);
        let found =
            found.map_err(|error| anyhow!("cannot be read as a picture: {error}; {NEEDED}"))?;
        Ok(found
            .and_then(|values| values.first().copied())
            .unwrap_or(default))
    };
    let samples = number(Tag::SamplesPerPixel, 1)?;
    let bits = number(Tag::BitsPerSample, 1)?;
    let format = number(Tag::SampleFormat, 1)?;
    let photometric = number(Tag::PhotometricInterpretation, 1)?;
    let compression = number(Tag::Compression, 1)?;
    let planar = number(Tag::PlanarConfiguration, 1)?;
    let kind = match format {
        1 => "whole numbers",
        2 => "whole numbers with a sign",
        3 => "floats",
        _ => "numbers of an unknown kind",
    };
    ensure!(
        (samples, bits, format) == (4, 32, u64::from(SampleFormat::IEEEFP.to_u16())),
        "found {samples} {} per pixel, {bits}-bit {kind}; {NEEDED}",
        if samples == 1 { "sample" } else { "samples" }
    );
    ensure!(
        photometric == u64::from(PhotometricInterpretation::BlackIsZero.to_u16()),
        "found samples that stand for colours, expected Stokes vectors; {NEEDED}"
    );
    ensure!(
        compression == u64::from(CompressionMethod::None.to_u16()),
        "found compression {compression} of TIFF; {NEEDED}"
    );
    ensure!(
        planar == u64::from(PlanarConfiguration::Chunky.to_u16())
            && decoder.get_chunk_type() == ChunkType::Strip,
        "found separate planes or tiles, expected strips of whole pixels; {NEEDED}"
    );
    Ok(())
}

/// Checks that every sample is a finite number.
fn finite(stokes: &[[f32; 4]], width: u32) -> Result<()> {
    let Some(index) = stokes
        .iter()
        .position(|pixel| !pixel.iter().all(|s| s.is_finite()))
    else {
        return Ok(());
    };
    let channel = stokes[index]
        .iter()
        .position(|s| !s.is_finite())
        .unwrap_or(0);
    let (row, column) = (index / width as usize, index % width as usize);
    bail!(
        "found {} for S{channel} in row {row}, column {column} (counted from 0 at the top left), \
         every sample must be a finite number",
        stokes[index][channel]
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::tests::{picture, stokes_file};
    use std::io::Cursor;

    fn read_bytes(bytes: &[u8]) -> Result<Recording> {
        read(Cursor::new(bytes), bytes.len() as u64)
    }

    #[test]
    fn every_bit_comes_back() {
        let mut picture = picture(37, 29);
        picture.stokes[5] = [f32::MIN_POSITIVE / 8.0, -0.0, f32::MAX, -1.0 / 3.0];
        let recording = read_bytes(&stokes_file(&picture)).expect("whole");
        let bits = |picture: &Picture| -> Vec<u32> {
            let samples = picture.stokes.as_flattened().iter();
            samples.map(|sample| sample.to_bits()).collect()
        };
        assert_eq!(bits(&recording.picture), bits(&picture));
        assert_eq!(recording.picture, picture);
        assert_eq!(recording.description.unit, "lm/(m²·sr)");
    }

    #[test]
    fn what_is_no_number_is_found_at_its_place() {
        for (value, found) in [(f32::NAN, "NaN"), (f32::NEG_INFINITY, "-inf")] {
            let mut picture = picture(5, 4);
            picture.stokes[13][2] = value;
            let error = read_bytes(&stokes_file(&picture)).expect_err("no number");
            let expected = format!("found {found} for S2 in row 2, column 3");
            assert!(error.to_string().contains(&expected), "{error}");
        }
    }

    /// Whatever is cut off or changed, reading ends with an error or a picture, and in finite memory.
    #[test]
    fn damage_is_an_error_and_never_a_panic() {
        let whole = stokes_file(&picture(3, 2));
        for length in 0..whole.len() {
            let error = read_bytes(&whole[..length]).expect_err("cut off");
            let told = error.to_string();
            assert!(
                told.contains("not whole") || told.contains("no TIFF"),
                "{length}: {told}"
            );
        }
        for place in 0..whole.len() {
            for value in [0, 1, 0x7f, 0xff] {
                let mut bytes = whole.clone();
                bytes[place] = value;
                if let Ok(recording) = read_bytes(&bytes) {
                    let Picture {
                        width,
                        height,
                        stokes,
                        ..
                    } = recording.picture;
                    assert_eq!(stokes.len() as u64, u64::from(width) * u64::from(height));
                }
            }
        }
    }
}
