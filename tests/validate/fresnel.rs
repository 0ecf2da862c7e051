//! Exact answers of Fresnel reflection.

use crate::Row;
use malus_optics::Index;

fn exact(what: &str, source: &'static str, expected: f64, got: f64, test: &'static str) -> Row {
    Row {
        what: what.into(),
        source,
        expected,
        got,
        error: 0.0,
        test,
    }
}

pub fn rows() -> Vec<Row> {
    let glass = Index::new(1.5, 0.0);
    let half = glass.reflection(0.5f64.sqrt(), 0.5);
    let brewster = glass.reflection((1.0 / 3.25f64).sqrt(), 2.25 / 3.25);
    let gold = Index::new(0.183, 3.43).reflection(0.5f64.sqrt(), 0.5);
    let cos = 51.782f64.to_radians().cos();
    let rhomb = Index::new(1.0 / 1.49661, 0.0).reflection(cos, 1.0 - cos * cos);
    // Midpoint rule in μ² on the hemispherical reflectance ∫ R d(μ²).
    let cells = 1_000_000;
    let hemisphere = (0..cells)
        .map(|i| {
            let mu2 = (f64::from(i) + 0.5) / f64::from(cells);
            glass.reflection(mu2.sqrt(), 1.0 - mu2).mean() / f64::from(cells)
        })
        .sum();
    let power = |base: f64, exponent: i32| (0..exponent).fold(1.0, |product, _| product * base);
    let mut rows = vec![
        exact(
            "n = 1.5, 45°: Rs",
            "Fresnel",
            0.092_013_36,
            half.rs(),
            "optics::fresnel",
        ),
        exact(
            "n = 1.5, 45°: Rp = Rs²",
            "Fresnel",
            0.008_466_46,
            half.rp(),
            "optics::fresnel",
        ),
        exact(
            "n = 1.5, 45°: r_s r_p",
            "Fresnel",
            -0.027_911_06,
            half.c(),
            "optics::fresnel",
        ),
        exact(
            "n = 1.5, 45°: degree of polarisation",
            "Fresnel",
            0.831_479_42,
            half.half_difference() / half.mean(),
            "optics::fresnel",
        ),
        exact(
            "n = 1.5, Brewster: Rs = 25/169",
            "Brewster",
            25.0 / 169.0,
            brewster.rs(),
            "optics::fresnel",
        ),
        exact(
            "hemispherical reflectance of n = 1.5",
            "Fresnel",
            0.091_777_959_3,
            hemisphere,
            "optics::fresnel",
        ),
        exact(
            "gold, 45°: M00",
            "Fresnel, complex n",
            0.942_478_48,
            gold.mean(),
            "optics::fresnel",
        ),
        exact(
            "gold, 45°: M01",
            "Fresnel, complex n",
            0.018_670_71,
            gold.half_difference(),
            "optics::fresnel",
        ),
        exact(
            "gold, 45°: C",
            "Fresnel, complex n",
            -0.868_822_41,
            gold.c(),
            "optics::fresnel",
        ),
        exact(
            "gold, 45°: W",
            "Fresnel, complex n",
            0.364_780_36,
            gold.w(),
            "optics::fresnel",
        ),
        exact(
            "half a rhomb, 51.782°: C",
            "total reflection",
            0.5f64.sqrt(),
            rhomb.c(),
            "optics::fresnel",
        ),
        exact(
            "half a rhomb, 51.782°: W",
            "total reflection",
            0.5f64.sqrt(),
            rhomb.w(),
            "optics::fresnel",
        ),
    ];
    for reflections in [2, 5] {
        let (s, p) = (power(half.rs(), reflections), power(half.rp(), reflections));
        let mut light =
            malus_optics::Stokes::<4, malus_optics::Incidence>::unpolarised(1.0).components();
        for _ in 0..reflections {
            light = (half * malus_optics::Stokes::<4, malus_optics::Incidence>::new(light))
                .components();
        }
        rows.push(exact(
            &format!("{reflections} reflections in one plane at 45°: I"),
            "(Rs^N + Rp^N)/2",
            (s + p) / 2.0,
            light[0],
            "optics::chain",
        ));
    }
    rows
}
