//! What a camera sees.

/// A picture in polarised light: the radiance Stokes vector in every pixel, in unit/(m²·sr).
///
/// In each pixel **d** is the direction in which light travels, towards the viewer, and **x** the camera's right vector
/// made perpendicular to it, so **y** = **d** × **x** points up in the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels in a row, ≥ 1.
    pub width: u32,
    /// Rows, ≥ 1.
    pub height: u32,
    /// Stokes vectors by rows, the top left pixel first: width × height of them.
    pub stokes: Vec<[f32; 4]>,
    /// Root mean square over the pixels of the standard error of S0, as a share of the mean S0.
    pub standard_error: f64,
    /// Whether all samples were taken; `false` where the user ended the run before.
    pub complete: bool,
}
