//! What decides walks that serve several variants of a scene at once: the reflectors that a surface has in any of them.
//!
//! The odds of each lobe are those of the variant that has most of it, as far as both find room, so no variant's light
//! weighs much more than 1 at an event. One variant alone has the odds of its own bounds.

use malus_optics::{Material as Optics, Reflection, Representation};

/// Cosines between which the greatest mirror-like reflectance is known.
const STEPS: usize = 128;

/// Probabilities with which a walk goes on, by bounds that hold for any state of light.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Odds {
    /// Into a random direction.
    pub diffuse: f64,
    /// Mirror-like.
    pub mirror: f64,
    /// Straight on.
    pub through: f64,
}

/// By how much a walk from a sensor is likelier to be mirrored where it first meets a surface.
const SPLIT: f64 = 4.0;

impl Odds {
    /// Probability of being mirrored; `first` where a walk from a sensor meets its first surface, where it is that whatever
    /// else happens.
    ///
    /// What a sensor sees in mirrors, walks from emitters cannot bring; a sensor that takes few walks of its own would
    /// depend on the luck of one.
    pub(crate) fn mirrored(self, first: bool) -> f64 {
        if first {
            (SPLIT * self.mirror).min(1.0)
        } else {
            self.mirror
        }
    }

    /// The same for a walk that passes mirrors and panes alone; `surely` where it is to be mirrored.
    pub(crate) fn of_mirrors(self, surely: bool) -> Self {
        if surely {
            return Self {
                diffuse: 0.0,
                mirror: 1.0,
                through: 0.0,
            };
        }
        Self {
            diffuse: 0.0,
            ..self
        }
    }
}

/// The reflectors of one surface.
#[derive(Debug, Clone)]
pub(crate) struct Cover {
    /// The different ones among them, that of the first variant first.
    optics: Vec<Optics>,
    /// Greatest probability of scattering, where it is the same at every angle.
    even: Option<f64>,
    /// Of more than one: the share of its greatest probability with which a walk scatters.
    room: f64,
    /// Of more than one: the greatest mirror-like reflectance at cosines k/STEPS.
    mirror: Vec<f64>,
    /// See [`image`](Self::image), at the same cosines; empty where nothing is mirrored.
    image: Vec<f64>,
    /// See [`launched`](Self::launched).
    launched: f64,
}

impl Cover {
    /// The reflectors that a surface has in several variants.
    pub(crate) fn new(optics: impl Iterator<Item = Optics>) -> Self {
        let mut distinct: Vec<Optics> = Vec::new();
        for optics in optics {
            if !distinct.contains(&optics) {
                distinct.push(optics);
            }
        }
        let even = distinct
            .iter()
            .all(|it| !it.polarises_scattering())
            .then(|| {
                let bound = |it: &Optics| it.diffuse_bound(1.0, 0.0);
                distinct.iter().map(bound).fold(0.0, f64::max)
            });
        let mut cover = Self {
            optics: distinct,
            even,
            room: 1.0,
            mirror: Vec::new(),
            image: Vec::new(),
            launched: 1.0,
        };
        if cover.optics.len() > 1 {
            cover.mirror = table(|cos, sin2| {
                let bound = |it: &Optics| it.mirror(cos, sin2).bound();
                cover.optics.iter().map(bound).fold(0.0, f64::max).min(1.0)
            });
            let both = mean(|cos| cover.scattered(cos, 1.0 - cos * cos) + cover.mirrored(cos));
            cover.room = 1.0 / both.max(1.0);
        }
        if cover.is_mirrorlike() {
            cover.image = match &cover.optics[..] {
                [alone] => table(|cos, sin2| alone.mirror(cos, sin2).mean()),
                _ => cover.mirror.clone(),
            };
        }
        let pane = cover.optics.iter().any(Optics::is_pane);
        if cover.even.is_some() && cover.scatters() && !pane {
            let scattered = cover.diffuse(1.0, 0.0);
            let left = 1.0 - cover.mirror_bound(0.0, 1.0).min(1.0 - scattered);
            cover.launched = left.sqrt() / scattered.sqrt();
        }
        cover
    }

    /// Whether a reflector is among them.
    pub(crate) fn holds(&self, optics: &Optics) -> bool {
        self.optics.contains(optics)
    }

    /// With one more reflector.
    pub(crate) fn with(&self, optics: Optics) -> Self {
        Self::new(self.optics.iter().copied().chain([optics]))
    }

    /// Greatest probability of scattering in any variant.
    #[inline]
    fn scattered(&self, cos: f64, sin2: f64) -> f64 {
        if let Some(even) = self.even {
            return even;
        }
        let bound = |it: &Optics| it.diffuse_bound(cos, sin2);
        self.optics.iter().map(bound).fold(0.0, f64::max)
    }

    /// Probability with which a walk that meets the surface at this angle scatters.
    #[inline]
    pub(crate) fn diffuse(&self, cos: f64, sin2: f64) -> f64 {
        match &self.optics[..] {
            [alone] => alone.diffuse_bound(cos, sin2),
            _ => self.room * self.scattered(cos, sin2),
        }
    }

    /// By how much likelier a walk from an emitter scatters than one from a sensor, where walks from sensors are joined to
    /// it: so likely as the geometric mean of what is scattered and of all that mirrors leave.
    #[inline]
    pub(crate) fn launched(&self) -> f64 {
        self.launched
    }

    /// Greatest mirror-like reflectance at an angle, for any state of light.
    #[inline]
    pub(crate) fn mirror_bound(&self, cos: f64, sin2: f64) -> f64 {
        match &self.optics[..] {
            [alone] => alone.mirror(cos, sin2).bound(),
            _ => self.mirrored(cos),
        }
    }

    /// What is expected of an image, to choose one by: about the mirror-like reflectance at an angle for unpolarised light;
    /// in several variants, the greatest for any.
    #[inline]
    pub(crate) fn image(&self, cos: f64) -> f64 {
        read(&self.image, cos)
    }

    #[inline]
    fn mirrored(&self, cos: f64) -> f64 {
        read(&self.mirror, cos)
    }

    /// How a walk that meets the surface at this angle goes on; `mirror` and `through` are those of the first variant.
    #[inline]
    pub(crate) fn odds(
        &self,
        (cos, sin2): (f64, f64),
        mirror: &Reflection,
        through: &Reflection,
    ) -> Odds {
        let diffuse = self.diffuse(cos, sin2);
        let (mirror, through) = match &self.optics[..] {
            [_] => (mirror.bound().min(1.0), through.bound()),
            all => {
                let through = all.iter().map(|it| it.through(cos, sin2).bound());
                (
                    self.mirrored(cos).min(1.0 - diffuse),
                    through.fold(0.0, f64::max),
                )
            }
        };
        // What is caught between two panes comes back to both at one angle for ever, so there the mirror's share is
        // kept; a stack of panes is passed once.
        Odds {
            diffuse,
            mirror,
            through: through.min(1.0 - mirror),
        }
    }

    /// Whether a surface scatters in any variant.
    #[inline]
    pub(crate) fn scatters(&self) -> bool {
        self.optics.iter().any(|it| it.scattering() > 0.0)
    }

    /// Whether some part of the reflection is mirror-like in any variant.
    pub(crate) fn is_mirrorlike(&self) -> bool {
        self.optics
            .iter()
            .any(|it| it.representation() > Representation::Intensity)
    }

    /// Whether the probability of scattering depends on the angle.
    #[inline]
    pub(crate) fn polarises_scattering(&self) -> bool {
        self.optics.iter().any(Optics::polarises_scattering)
    }

    /// Whether the walks serve every variant well: the mean square of a weight at one event, over diffuse light, is below
    /// 1, so that it cannot grow from event to event, and at most twice what a variant's own walks have.
    pub(crate) fn serves_all(&self) -> bool {
        // One alone has its own odds.
        self.optics.len() == 1
            || self.optics.iter().all(|own| {
                let bounds = |cos: f64| {
                    let sin2 = 1.0 - cos * cos;
                    [
                        own.diffuse_bound(cos, sin2),
                        own.mirror(cos, sin2).bound().min(1.0),
                    ]
                };
                let alone = mean(|cos| bounds(cos).iter().sum());
                let square = mean(|cos| {
                    let sin2 = 1.0 - cos * cos;
                    let odds = self.odds((cos, sin2), &Reflection::NONE, &Reflection::NONE);
                    let weighted = bounds(cos).into_iter().zip([odds.diffuse, odds.mirror]);
                    weighted
                        .filter(|it| it.0 > 0.0)
                        .map(|(own, odds)| own * own / odds)
                        .sum()
                });
                square <= (2.0 * alone).min(1.0)
            })
    }
}

/// Values at the cosines k/STEPS.
fn table(value: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let at = |step: usize| {
        let cos = step as f64 / STEPS as f64;
        value(cos, 1.0 - cos * cos)
    };
    (0..=STEPS).map(at).collect()
}

/// The value between those of a table, 0 of none.
#[inline]
fn read(table: &[f64], cos: f64) -> f64 {
    let at = cos.clamp(0.0, 1.0) * STEPS as f64;
    let step = (at as usize).min(STEPS - 1);
    match table.get(step..step + 2) {
        Some(&[one, next]) => one + (at - step as f64) * (next - one),
        _ => 0.0,
    }
}

/// Mean over diffuse light, ∫ … 2μ dμ, by the midpoint rule in μ².
fn mean(value: impl Fn(f64) -> f64) -> f64 {
    let steps = (0..STEPS).map(|step| value(((step as f64 + 0.5) / STEPS as f64).sqrt()));
    steps.sum::<f64>() / STEPS as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use malus_optics::Index;

    fn mixture(rho: f64, fraction: f64, n: f64) -> Optics {
        Optics::Mixture {
            rho,
            fraction,
            index: Index::new(n, 0.0),
        }
    }

    fn odds(cover: &Cover, cos: f64) -> Odds {
        let sin2 = 1.0 - cos * cos;
        let first = cover.optics[0];
        cover.odds(
            (cos, sin2),
            &first.mirror(cos, sin2),
            &first.through(cos, sin2),
        )
    }

    /// Of all surfaces a walk from an emitter may meet, down to the darkest that has a number.
    #[test]
    fn walks_from_emitters_scatter_more_often_and_never_more_than_mirrors_leave_them() {
        for rho in [5e-324, 1e-310, 1e-100, 0.01, 0.5, 0.99, 1.0] {
            for (fraction, n) in [(0.0, 1.5), (0.6, 1.5), (0.9, 3.0), (0.5, f64::INFINITY)] {
                let cover = Cover::new([mixture(rho, fraction, n)].into_iter());
                for cos in [0.0, 1e-9, 0.1, 0.5, 1.0] {
                    let odds = odds(&cover, cos);
                    let launched = odds.diffuse * cover.launched();
                    let what = format!("rho {rho:e}, a {fraction}, n {n}, cos {cos}: {launched:e}");
                    assert!(launched >= odds.diffuse * (1.0 - 1e-15), "{what}");
                    assert!(launched + odds.mirror <= 1.0 + 1e-15, "{what}");
                    // The geometric mean of (1 − a)ρ and 1 − a.
                    let mean = (1.0 - fraction) * rho.sqrt();
                    assert!(
                        (launched / mean - 1.0).abs() < 1e-12 || rho < 1e-300,
                        "{what}"
                    );
                }
            }
        }
    }

    #[test]
    fn one_reflector_has_the_odds_of_its_own_bounds() {
        let own = mixture(0.5, 0.6, 1.5);
        let cover = Cover::new([own, own].into_iter());
        for cos in [0.1, 0.5, 0.9] {
            let odds = odds(&cover, cos);
            assert_eq!(odds.diffuse.to_bits(), own.scattering().to_bits());
            let bound = own.mirror(cos, 1.0 - cos * cos).bound();
            assert_eq!(odds.mirror.to_bits(), bound.to_bits());
        }
    }

    #[test]
    fn no_lobe_of_any_variant_weighs_more_than_one_where_there_is_room() {
        let all = [
            mixture(0.5, 0.6, 1.5),
            mixture(0.3, 0.2, 2.0),
            mixture(0.7, 0.1, 1.3),
        ];
        let cover = Cover::new(all.into_iter());
        assert!(cover.serves_all());
        for step in 1..=50 {
            let cos = f64::from(step) / 50.0;
            let odds = odds(&cover, cos);
            assert!(odds.diffuse + odds.mirror <= 1.0);
            for own in all {
                assert!(own.scattering() <= odds.diffuse);
                // The bound is known at 129 cosines; at a grazing angle there is no room left for all of it.
                let mirrored = own.mirror(cos, 1.0 - cos * cos).bound();
                let full = odds.diffuse + odds.mirror > 1.0 - 1e-12;
                assert!(
                    mirrored <= 1.001 * odds.mirror || full && cos < 0.2,
                    "{cos}"
                );
            }
        }
    }

    #[test]
    fn a_mirror_and_a_white_wall_are_too_far_apart() {
        let wall = mixture(0.9, 0.0, 1.5);
        let ideal = mixture(0.0, 1.0, f64::INFINITY);
        assert!(!Cover::new([wall, ideal].into_iter()).serves_all());
        assert!(Cover::new([wall, mixture(0.8, 0.5, 1.5)].into_iter()).serves_all());
        assert!(Cover::new([ideal].into_iter()).serves_all());
    }
}
