//! Student's t: how many standard errors a confidence interval reaches.

/// Beyond this many degrees of freedom the quantile is taken from the normal expansion, good to 10⁻⁹ there.
const MANY: u32 = 1000;

/// The 97.5 % quantile of Student's t with `dof` degrees of freedom ≥ 1: half the width of a two-sided 95 % interval,
/// in standard errors.
#[must_use]
pub fn half_width_95(dof: u32) -> f64 {
    if dof > MANY {
        return expanded(f64::from(dof));
    }
    half_width(0.95, dof)
}

/// Half the width of a two-sided interval of that confidence, in standard errors.
#[must_use]
pub fn half_width(confidence: f64, dof: u32) -> f64 {
    // In the angle θ with t = √dof · tan θ the distribution is a finite sum, monotone on (0, π/2).
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if inside(middle, dof) < confidence {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::from(dof.max(1)).sqrt() * libm::tan(0.5 * (low + high))
}

/// Probability with which chance alone makes |t| as large or larger; below 10⁻¹⁵ it is not told from 0.
#[must_use]
pub fn two_sided(t: f64, dof: u32) -> f64 {
    let angle = libm::atan(t.abs() / f64::from(dof.max(1)).sqrt());
    (1.0 - inside(angle, dof)).max(0.0)
}

/// Probability of |t| < √dof · tan θ (Abramowitz & Stegun, 26.7.3 and 26.7.4).
fn inside(angle: f64, dof: u32) -> f64 {
    let (sine, cosine) = libm::sincos(angle);
    let odd = dof % 2 == 1;
    // odd:  (2/π) [θ + sin θ (cos θ + 2/3 cos³ θ + … )],  even: sin θ (1 + 1/2 cos² θ + 1·3/(2·4) cos⁴ θ + …)
    let mut term = if odd { cosine } else { 1.0 };
    let mut sum = 0.0;
    let mut power = u32::from(odd);
    while power + 2 <= dof {
        sum += term;
        power += 2;
        term *= cosine * cosine * f64::from(power - 1) / f64::from(power);
    }
    if odd {
        (angle + sine * sum) * std::f64::consts::FRAC_2_PI
    } else {
        sine * sum
    }
}

/// Expansion about the normal quantile z in 1/dof (Abramowitz & Stegun, 26.7.5).
fn expanded(dof: f64) -> f64 {
    let z: f64 = 1.959_963_984_540_054;
    let first = (z.powi(3) + z) / 4.0;
    let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
    z + first / dof + second / (dof * dof)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the usual tables, and more digits from the incomplete beta function.
    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (dof, expected) in [
            (1, 12.706_204_74),
            (2, 4.302_652_73),
            (10, 2.228_138_85),
            (31, 2.039_513_45),
            (63, 1.998_340_54),
            (u32::MAX, 1.959_963_98),
        ] {
            let got = half_width_95(dof);
            assert!((got - expected).abs() < 2e-8, "{dof}: {got}");
        }
    }

    #[test]
    fn a_probability_is_that_of_its_quantile() {
        for (confidence, dof) in [(0.95, 31), (0.95, 63), (0.999, 63), (0.99, 10)] {
            let p = two_sided(half_width(confidence, dof), dof);
            assert!((p - (1.0 - confidence)).abs() < 1e-9, "{p}");
        }
        assert!((two_sided(0.0, 63) - 1.0).abs() < 1e-15 && two_sided(1e9, 63) < 1e-15);
    }

    #[test]
    fn the_sum_and_the_expansion_meet() {
        let exact = half_width_95(MANY);
        assert!((exact - expanded(f64::from(MANY))).abs() < 1e-8, "{exact}");
    }
}
