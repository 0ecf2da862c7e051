//! TIFF files made and read by hand, so that the program's own reading and writing are held against the format.

use crate::cli::Folder;
use std::collections::BTreeMap;

/// Kind of value, how many, and their bytes.
type Value = (u16, u32, Vec<u8>);

/// A TIFF of little-endian 32-bit words, of which every part can be spoilt.
#[derive(Clone)]
pub struct Layout {
    pub sides: [u32; 2],
    pub samples: u16,
    pub bits: u16,
    /// 1 and 2 whole numbers, 3 floats.
    pub format: u16,
    pub compression: u16,
    pub photometric: u16,
    pub planar: u16,
    pub description: String,
    pub pixels: Vec<u8>,
}

impl Layout {
    /// A picture as a run writes it.
    pub fn of(sides: [u32; 2], stokes: &[[f32; 4]]) -> Self {
        let samples = stokes.as_flattened().iter();
        Self {
            sides,
            samples: 4,
            bits: 32,
            format: 3,
            compression: 1,
            photometric: 1,
            planar: 1,
            description: "unit = lm/(m^2 sr)\ncomplete = yes".to_owned(),
            pixels: samples.flat_map(|sample| sample.to_le_bytes()).collect(),
        }
    }

    /// The file: header, directory, values that do not fit in it, pixels in one strip (TIFF 6.0, section 2).
    pub fn bytes(&self) -> Vec<u8> {
        let words = |value: u16, count: u16| {
            (
                3,
                u32::from(count),
                value.to_le_bytes().repeat(usize::from(count)),
            )
        };
        let long = |value: u32| (4, 1, value.to_le_bytes().to_vec());
        let text = [self.description.as_bytes(), b"\0"].concat();
        let mut tags: Vec<(u16, Value)> = vec![
            (256, long(self.sides[0])),
            (257, long(self.sides[1])),
            (258, words(self.bits, self.samples)),
            (259, words(self.compression, 1)),
            (262, words(self.photometric, 1)),
            (270, (2, text.len() as u32, text)),
            (273, long(0)),
            (277, words(self.samples, 1)),
            (278, long(self.sides[1])),
            (279, long(self.pixels.len() as u32)),
            (284, words(self.planar, 1)),
            (339, words(self.format, self.samples)),
        ];
        let mut place = 8 + 2 + 12 * tags.len() + 4;
        let long_values = tags.iter().map(|(_, (_, _, value))| value.len());
        let strip = place + long_values.filter(|length| *length > 4).sum::<usize>();
        tags[6].1 = long(strip as u32);
        let mut file = [&b"II*\0\x08\0\0\0"[..], &(tags.len() as u16).to_le_bytes()].concat();
        let mut outside = Vec::new();
        for (tag, (kind, count, mut value)) in tags {
            file.extend(tag.to_le_bytes());
            file.extend(u16::to_le_bytes(kind));
            file.extend(u32::to_le_bytes(count));
            if value.len() > 4 {
                file.extend((place as u32).to_le_bytes());
                place += value.len();
                outside.extend(value);
            } else {
                value.resize(4, 0);
                file.extend(value);
            }
        }
        [file, vec![0; 4], outside, self.pixels.clone()].concat()
    }
}

/// The floats of a TIFF of one channel.
pub fn read_floats(folder: &Folder, name: &str) -> Vec<f32> {
    let file = std::fs::read(folder.path(name)).unwrap();
    let number = |at: usize, bytes: usize| {
        let digits = file[at..at + bytes].iter().rev();
        digits.fold(0_usize, |number, digit| number << 8 | usize::from(*digit))
    };
    assert_eq!(&file[..4], b"II*\0", "{name}: not little-endian TIFF");
    let directory = number(4, 4);
    let entries = (0..number(directory, 2)).map(|entry| directory + 2 + 12 * entry);
    // Tag: kind of value, how many, and the value or where it is.
    let tags: BTreeMap<usize, [usize; 3]> = entries
        .map(|at| {
            (
                number(at, 2),
                [number(at + 2, 2), number(at + 4, 4), at + 8],
            )
        })
        .collect();
    let values = |tag: usize| -> Vec<usize> {
        let [kind, count, at] = tags[&tag];
        let bytes = match kind {
            3 => 2,
            4 => 4,
            _ => panic!("{name}: tag {tag} of kind {kind}"),
        };
        let at = if bytes * count > 4 { number(at, 4) } else { at };
        (0..count)
            .map(|index| number(at + bytes * index, bytes))
            .collect()
    };
    for (tag, value) in [(258, 32), (259, 1), (277, 1), (339, 3)] {
        assert_eq!(values(tag), [value], "{name}: tag {tag}");
    }
    let strips = values(273).into_iter().zip(values(279));
    let bytes = strips.flat_map(|(at, length)| &file[at..at + length]);
    let bytes: Vec<u8> = bytes.copied().collect();
    assert_eq!(bytes.len(), 4 * values(256)[0] * values(257)[0]);
    let floats = bytes.as_chunks().0.iter();
    floats.map(|bytes| f32::from_le_bytes(*bytes)).collect()
}

/// Pixels of a PNG by rows.
#[derive(Debug, PartialEq)]
pub struct Pixels {
    pub sides: [u32; 2],
    pub pixels: Vec<[u8; 3]>,
}

impl Pixels {
    /// Luminance of an sRGB grey, white = 1 (IEC 61966-2-1), for codes above 10.
    pub fn luminance([grey, ..]: [u8; 3]) -> f64 {
        ((f64::from(grey) / 255.0 + 0.055) / 1.055).powf(2.4)
    }
}

pub fn read_png(folder: &Folder, name: &str) -> Pixels {
    let file = std::fs::File::open(folder.path(name)).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(
        (info.color_type, info.bit_depth),
        (png::ColorType::Rgb, png::BitDepth::Eight)
    );
    Pixels {
        sides: [info.width, info.height],
        pixels: bytes.as_chunks().0.to_vec(),
    }
}
