//! A colour scale that is perceptually even and still even when printed in grey.

/// Control points of viridis, 8-bit sRGB: every 15th of the 256 colours published by its authors
/// (S. van der Walt and N. Smith, 2015, CC0; matplotlib's `_cm_listed.py`).
///
/// Straight lines between these leave the full table by at most 5 of 255 in one channel, below what is seen side
/// by side, and keep what matters: luminance rises all the way.
const VIRIDIS: [[u8; 3]; 18] = [
    [68, 1, 84],
    [72, 23, 105],
    [71, 42, 122],
    [67, 61, 132],
    [61, 78, 138],
    [53, 94, 141],
    [46, 109, 142],
    [41, 123, 142],
    [35, 137, 142],
    [31, 151, 139],
    [33, 165, 133],
    [46, 179, 124],
    [70, 192, 111],
    [101, 203, 94],
    [137, 213, 72],
    [176, 221, 47],
    [216, 226, 25],
    [253, 231, 37],
];

/// Colour of a share 0 … 1 of the scale, as 8-bit sRGB; shares outside are clamped.
pub fn viridis(share: f64) -> [u8; 3] {
    let last = VIRIDIS.len() - 1;
    let place = share.clamp(0.0, 1.0) * last as f64;
    let below = (place as usize).min(last - 1);
    let part = place - below as f64;
    let [low, high] = [VIRIDIS[below], VIRIDIS[below + 1]];
    std::array::from_fn(|channel| {
        let (a, b) = (f64::from(low[channel]), f64::from(high[channel]));
        (a + part * (b - a)).round() as u8
    })
}

/// The colour as SVG writes it: `#rrggbb`.
pub fn hexadecimal([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of an sRGB colour (IEC 61966-2-1).
    fn luminance(colour: [u8; 3]) -> f64 {
        let linear = |channel: u8| {
            let c = f64::from(channel) / 255.0;
            if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        let [red, green, blue] = colour.map(linear);
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    }

    #[test]
    fn luminance_rises_along_the_whole_scale() {
        let scale: Vec<f64> = (0..=64)
            .map(|i| luminance(viridis(f64::from(i) / 64.0)))
            .collect();
        assert!(scale.windows(2).all(|pair| pair[0] < pair[1]), "{scale:?}");
    }

    #[test]
    fn the_ends_are_those_published() {
        assert_eq!(hexadecimal(viridis(0.0)), "#440154");
        assert_eq!(hexadecimal(viridis(1.0)), "#fde725");
        assert_eq!(viridis(-3.0), viridis(0.0));
        assert_eq!(viridis(7.0), viridis(1.0));
    }
}
