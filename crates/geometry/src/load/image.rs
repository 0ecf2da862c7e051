//! Means of textures.

use ::image::{GenericImageView, load_from_memory};

/// Mean over all pixels of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mean {
    /// Red, green and blue as linear light, for images that hold sRGB colours; 0 to 1.
    pub color: [f64; 3],
    /// The stored components, for images that hold other quantities, and alpha; 0 to 1.
    pub stored: [f64; 4],
}

impl Mean {
    /// The mean of an encoded PNG or JPEG image; deeper channels are taken at 8 bits.
    ///
    /// # Errors
    /// Why the image cannot be read.
    pub(super) fn of(encoded: &[u8]) -> Result<Self, String> {
        let image = load_from_memory(encoded).map_err(|error| error.to_string())?;
        // Exact integer counts of each level: no rounding builds up over millions of pixels.
        let mut counts = [[0u64; 256]; 4];
        for (_, _, pixel) in image.pixels() {
            for (levels, component) in counts.iter_mut().zip(pixel.0) {
                levels[usize::from(component)] += 1;
            }
        }
        let pixels = f64::from(image.width()) * f64::from(image.height());
        if pixels == 0.0 {
            return Err("it has no pixels".to_owned());
        }
        let mean = |levels: &[u64; 256], value: fn(f64) -> f64| {
            let sum: f64 = levels
                .iter()
                .enumerate()
                .map(|(level, &count)| count as f64 * value(level as f64 / 255.0))
                .sum();
            sum / pixels
        };
        Ok(Self {
            color: [0, 1, 2].map(|c| mean(&counts[c], linear)),
            stored: [0, 1, 2, 3].map(|c| mean(&counts[c], |value| value)),
        })
    }
}

/// Linear light of an sRGB component, both 0 to 1 (IEC 61966-2-1).
fn linear(component: f64) -> f64 {
    if component <= 0.04045 {
        component / 12.92
    } else {
        libm::pow((component + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
    use std::io::Cursor;

    fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn the_mean_of_a_chessboard_is_half_the_light_and_not_the_light_of_half() {
        let board = RgbaImage::from_fn(8, 8, |x, y| match (x + y) % 2 {
            0 => Rgba([0, 255, 128, 0]),
            _ => Rgba([255, 255, 128, 255]),
        });
        let mean = Mean::of(&encoded(&board.into(), ImageFormat::Png)).unwrap();
        assert_eq!(mean.stored, [0.5, 1.0, 128.0 / 255.0, 0.5]);
        assert_eq!(mean.color[..2], [0.5, 1.0]);
        // sRGB level 128 is a linear 0.21586 (IEC 61966-2-1).
        assert!((mean.color[2] - 0.215_860_5).abs() < 1e-7);
    }

    #[test]
    fn jpeg_and_grey_images_are_read() {
        let grey = DynamicImage::ImageLuma8(::image::GrayImage::from_pixel(16, 16, [255].into()));
        for format in [ImageFormat::Png, ImageFormat::Jpeg] {
            let mean = Mean::of(&encoded(&grey, format)).unwrap();
            assert_eq!((mean.color, mean.stored), ([1.0; 3], [1.0; 4]));
        }
    }

    #[test]
    fn what_is_no_image_is_an_error() {
        let png = encoded(&RgbaImage::new(4, 4).into(), ImageFormat::Png);
        for bytes in [&b""[..], b"RIFF....WEBP", &png[..png.len() / 2]] {
            assert!(Mean::of(bytes).is_err());
        }
    }
}
