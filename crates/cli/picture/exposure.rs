//! From radiance to what a screen shows.

/// Share of the lit pixels that do not exceed what is bright.
pub const BRIGHT: f64 = 0.95;

/// Where, as a share of the screen's white, proportions end and the shoulder of highlights begins.
const KNEE: f64 = 0.6;

/// The middle grey of photographers, as a share of the screen's white.
const MIDDLE_GREY: f64 = 0.18;

/// How bright a radiance is shown.
///
/// Up to the knee the screen shows radiance in proportion: through a filter that halves it, it looks half as bright.
/// Above, highlights approach white and never reach it, so that a lamp still has a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Screen luminance, white = 1, to a unit of radiance.
    gain: f64,
}

impl Exposure {
    /// The exposure for a picture, and `ev` powers of two brighter: what is bright in it comes to the knee, or the median
    /// of what is lit to middle grey, whichever takes more light: a window may leave the room its greys, and burn out.
    ///
    /// All is black where both are 0.
    pub fn new(bright: f64, median: f64, ev: f64) -> Self {
        let gain = libm::exp2(ev) * (KNEE / bright).max(MIDDLE_GREY / median);
        Self {
            gain: if gain.is_finite() { gain } else { 0.0 },
        }
    }

    /// Radiance at the knee, the greatest that is shown in proportion; infinite where all is black.
    pub fn proportional(&self) -> f64 {
        KNEE / self.gain
    }

    /// The grey of a radiance, as 8-bit sRGB.
    pub fn grey(&self, radiance: f64) -> u8 {
        let light = (self.gain * radiance).max(0.0);
        let shown = if light <= KNEE {
            light
        } else {
            1.0 - (1.0 - KNEE) * libm::exp(-(light - KNEE) / (1.0 - KNEE))
        };
        srgb(shown)
    }
}

/// A share of the screen's luminance, 0 … 1, as 8-bit sRGB (IEC 61966-2-1); shares outside are clamped.
pub fn srgb(share: f64) -> u8 {
    let share = share.clamp(0.0, 1.0);
    let coded = if share <= 0.003_130_8 {
        12.92 * share
    } else {
        1.055 * libm::pow(share, 1.0 / 2.4) - 0.055
    };
    (255.0 * coded).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Luminance of an sRGB grey (IEC 61966-2-1), for codes above 10.
    fn luminance(grey: u8) -> f64 {
        ((f64::from(grey) / 255.0 + 0.055) / 1.055).powf(2.4)
    }

    #[test]
    fn half_the_radiance_is_half_the_luminance_up_to_the_knee() {
        let exposure = Exposure::new(250.0, 100.0, 0.0);
        let [whole, half] = [250.0, 125.0].map(|radiance| luminance(exposure.grey(radiance)));
        // One code of 255 at these greys is 1 % of the luminance.
        assert!((whole / KNEE - 1.0).abs() < 0.01 && (half / whole - 0.5).abs() < 0.01);
        assert!((exposure.proportional() - 250.0).abs() < 1e-12);
    }

    #[test]
    fn highlights_keep_their_order() {
        let exposure = Exposure::new(1.0, 1.0, 0.0);
        let greys: Vec<u8> = (0..=40)
            .map(|step| exposure.grey(0.1 * f64::from(step)))
            .collect();
        assert!(greys.is_sorted(), "{greys:?}");
        // Up to twice what is bright, a tenth more can be told.
        assert!(
            greys[..=20].windows(2).all(|pair| pair[0] < pair[1]),
            "{greys:?}"
        );
        let ends = [0.0, -3.0, 1e30].map(|radiance| exposure.grey(radiance));
        assert_eq!(ends, [0, 0, 255]);
    }

    #[test]
    fn a_step_of_exposure_is_a_factor_of_two() {
        assert_eq!(
            Exposure::new(1.0, 1.0, 1.0).grey(0.2),
            Exposure::new(1.0, 1.0, 0.0).grey(0.4)
        );
        assert_eq!(
            Exposure::new(1.0, 1.0, -2.0).grey(0.4),
            Exposure::new(1.0, 1.0, 0.0).grey(0.1)
        );
    }

    #[test]
    fn a_window_leaves_the_room_middle_grey() {
        let exposure = Exposure::new(100.0, 1.0, 0.0);
        assert!((luminance(exposure.grey(1.0)) / MIDDLE_GREY - 1.0).abs() < 0.01);
        assert_eq!(exposure.grey(100.0), 255);
    }

    #[test]
    fn a_dark_picture_is_black() {
        let exposure = Exposure::new(0.0, 0.0, 0.0);
        assert_eq!((exposure.grey(0.0), exposure.grey(1.0)), (0, 0));
    }

    #[test]
    fn the_ends_of_srgb_are_black_and_white() {
        assert_eq!([0.0, 1.0, -1.0, 2.0].map(srgb), [0, 255, 0, 255]);
        // 21.404 % is the luminance of the middle grey 127.5/255.
        assert_eq!(srgb(0.215_86), 128);
    }
}
