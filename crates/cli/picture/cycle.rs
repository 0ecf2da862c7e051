//! Colours of directions: a scale that ends where it begins, and fades where there is nothing to tell.

use super::exposure::srgb;

/// Lightness of full colour in OKLab.
const LIGHTNESS: f64 = 0.75;

/// Chroma of full colour in OKLab. sRGB has all hues at this lightness up to 0.1275.
const CHROMA: f64 = 0.125;

/// What is left of the lightness where nothing is polarised.
const FADED: f64 = 0.3;

/// Colour of light of which the share `strength` (0 … 1 of the scale) is polarised along an axis, as 8-bit sRGB.
///
/// `cos2` and `sin2` belong to twice the angle of the axis. It is the hue, so the colour is the same after half a turn; at
/// one strength all hues have one lightness and one chroma in OKLab (B. Ottosson, *A perceptual color space for image
/// processing*, 2020), so that no angle stands out. Reddish is 0°, ochre 45°, green 90°, blue 135°. With the strength, lightness
/// falls to a dark grey and chroma to none: the hue of noise is not seen.
pub fn colour(cos2: f64, sin2: f64, strength: f64) -> [u8; 3] {
    let strength = strength.clamp(0.0, 1.0);
    let lightness = LIGHTNESS * (FADED + (1.0 - FADED) * strength);
    let chroma = CHROMA * strength;
    linear_srgb([lightness, chroma * cos2, chroma * sin2]).map(srgb)
}

/// Linear sRGB of an OKLab colour, by the matrices that its author gives.
fn linear_srgb([lightness, a, b]: [f64; 3]) -> [f64; 3] {
    let cube = |x: f64| x * x * x;
    let l = cube(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m = cube(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s = cube(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colours at `strength` around the cycle, a degree of angle apart.
    fn around(strength: f64) -> Vec<[u8; 3]> {
        let of = |degrees: i32| {
            let twice = f64::from(2 * degrees).to_radians();
            colour(twice.cos(), twice.sin(), strength)
        };
        (0..180).map(of).collect()
    }

    #[test]
    fn the_scale_ends_where_it_begins() {
        let turned = 360.0_f64.to_radians();
        assert_eq!(
            colour(turned.cos(), turned.sin(), 1.0),
            colour(1.0, 0.0, 1.0)
        );
    }

    #[test]
    fn every_colour_is_one_that_srgb_has() {
        for step in 0..=20 {
            let strength = f64::from(step) / 20.0;
            let lightness = LIGHTNESS * (FADED + (1.0 - FADED) * strength);
            let chroma = CHROMA * strength;
            for degrees in 0..360 {
                let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
                let light = linear_srgb([lightness, chroma * cos, chroma * sin]);
                let inside = |share: &f64| (-1e-9..=1.0 + 1e-9).contains(share);
                assert!(light.iter().all(inside), "{strength} {degrees}°: {light:?}");
            }
        }
    }

    #[test]
    fn white_and_grey_have_no_hue() {
        for lightness in [0.2, 0.5, 1.0] {
            let [r, g, b] = linear_srgb([lightness, 0.0, 0.0]);
            let expected = lightness * lightness * lightness;
            assert!(
                [r, g, b]
                    .iter()
                    .all(|share| (share - expected).abs() < 1e-6)
            );
        }
    }

    /// Steps of the cycle in sRGB neither vanish nor jump, and quarter turns are far apart.
    #[test]
    fn angles_can_be_told_apart_all_the_way_round() {
        let scale = around(1.0);
        let apart = |one: [u8; 3], other: [u8; 3]| {
            let square = |i: usize| (f64::from(one[i]) - f64::from(other[i])).powi(2);
            (square(0) + square(1) + square(2)).sqrt()
        };
        for i in 0..180 {
            let step = apart(scale[i], scale[(i + 1) % 180]);
            assert!((0.9..12.0).contains(&step), "{i}°: {step}");
            assert!(apart(scale[i], scale[(i + 45) % 180]) > 70.0, "{i}°");
        }
    }

    #[test]
    fn what_is_not_polarised_is_one_grey() {
        let greys = around(0.0);
        assert!(greys.iter().all(|grey| *grey == greys[0]));
        let [r, g, b] = greys[0];
        assert!(r == g && g == b && r < 60, "{greys:?}");
    }
}
