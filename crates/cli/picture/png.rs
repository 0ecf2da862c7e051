//! PNG files, row by row.

use anyhow::Result;
use std::io::Write;

/// Writes a PNG of 8-bit sRGB pixels; `fill` is asked for the rows from the top, three bytes a pixel.
///
/// # Errors
/// The file cannot be written.
pub fn write(
    file: &mut impl Write,
    [width, height]: [usize; 2],
    mut fill: impl FnMut(usize, &mut [[u8; 3]]),
) -> Result<()> {
    let [columns, rows] = [u32::try_from(width)?, u32::try_from(height)?];
    let mut encoder = ::png::Encoder::new(file, columns, rows);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    let mut row = vec![[0; 3]; width];
    for index in 0..height {
        fill(index, &mut row);
        stream.write_all(row.as_flattened())?;
    }
    stream.finish()?;
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_read_back() {
        let mut file = Vec::new();
        write(&mut file, [3, 2], |y, row| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = [x as u8, y as u8, 200];
            }
        })
        .expect("written");
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(file))
            .read_info()
            .expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        let info = reader.next_frame(&mut pixels).expect("a picture");
        assert_eq!((info.width, info.height), (3, 2));
        let expected = [
            0, 0, 200, 1, 0, 200, 2, 0, 200, 0, 1, 200, 1, 1, 200, 2, 1, 200,
        ];
        assert_eq!(pixels, expected);
    }
}
