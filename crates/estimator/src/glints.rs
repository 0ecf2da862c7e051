//! Lamps seen in mirrors that are too small or too curved to be looked into.
//!
//! A walk from a sensor meets such a mirror by chance, and a lamp in it by chance again. So each walk has a companion that is
//! aimed at one of these mirrors and follows the reflection as far as mirrors and panes lead. It competes with the walk itself
//! by the balance heuristic, for what the sensor sees in them and no diffuse surface has had part in.

use crate::cover::Cover;
use crate::mirrors::{Mirrors, reflectance};
use crate::receiver::Receiver;
use glam::DVec3;
use malus_geometry::Surfaces;
use std::f64::consts::PI;

/// Groups that the small mirrors are parted into, at most; neighbours in a file are neighbours in space as a rule.
const MOST: usize = 256;

/// The small mirrors of a scene.
#[derive(Default)]
pub(crate) struct Glints {
    groups: Vec<Group>,
    /// Their triangles, in the order of the groups, and the area of the group up to and with each.
    triangles: Vec<(u32, f64)>,
    /// One more than the group of each triangle of the scene, 0 for none; empty where there is no group.
    of: Vec<u16>,
}

/// Some small mirrors.
struct Group {
    first: usize,
    end: usize,
    centre: DVec3,
    radius: f64,
    /// Area times reflectance, in m².
    strength: f64,
}

/// How a sensor aims at them.
pub(crate) struct Aim<'a> {
    glints: &'a Glints,
    surfaces: &'a Surfaces,
    origin: DVec3,
    /// Probability of the groups up to and with each.
    cumulated: Vec<f64>,
}

impl Glints {
    /// The mirrors of a scene that none looks into.
    pub(crate) fn new(surfaces: &Surfaces, covers: &[Cover], mirrors: &Mirrors) -> Self {
        let reflectances: Vec<f64> = covers.iter().map(reflectance).collect();
        let strength = |triangle: u32| {
            let area = surfaces.triangle(triangle).area();
            area * reflectances[surfaces.surface(triangle) as usize]
        };
        let small: Vec<u32> = (0..surfaces.len() as u32)
            .filter(|&t| mirrors.of(t).is_none() && strength(t) > 0.0)
            .collect();
        if small.is_empty() {
            return Self::default();
        }
        let mut glints = Self {
            of: vec![0; surfaces.len()],
            ..Self::default()
        };
        for (number, part) in (1..).zip(small.chunks(small.len().div_ceil(MOST))) {
            let first = glints.triangles.len();
            let mut area = 0.0;
            for &triangle in part {
                area += surfaces.triangle(triangle).area();
                glints.triangles.push((triangle, area));
                glints.of[triangle as usize] = number;
            }
            let corners = || part.iter().flat_map(|&t| surfaces.triangle(t).vertices);
            let least = corners().fold(DVec3::INFINITY, DVec3::min);
            let most = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
            glints.groups.push(Group {
                first,
                end: glints.triangles.len(),
                centre: 0.5 * (least + most),
                radius: 0.5 * least.distance(most),
                strength: part.iter().map(|&t| strength(t)).sum(),
            });
        }
        glints
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }
}

impl Group {
    /// What it may reflect to a point, relative to others.
    fn weight(&self, from: DVec3) -> f64 {
        self.strength / (from.distance_squared(self.centre) + self.radius * self.radius)
    }
}

impl<'a> Aim<'a> {
    /// How a sensor aims; `None` where there is nothing to aim at.
    pub(crate) fn new(
        glints: &'a Glints,
        surfaces: &'a Surfaces,
        receiver: &Receiver,
    ) -> Option<Self> {
        if glints.is_empty() || !receiver.is_irradiance() {
            return None;
        }
        let mut sum = 0.0;
        let mut cumulated: Vec<f64> = glints
            .groups
            .iter()
            .map(|group| {
                sum += group.weight(receiver.origin);
                sum
            })
            .collect();
        for value in &mut cumulated {
            *value /= sum;
        }
        Some(Self {
            glints,
            surfaces,
            origin: receiver.origin,
            cumulated,
        })
    }

    /// A small mirror and the unit vector to a point of it.
    pub(crate) fn drawn(&self, [which, within, u, v]: [f64; 4]) -> (u32, DVec3) {
        let last = self.cumulated.len() - 1;
        let group = self.cumulated.partition_point(|&c| c <= which).min(last);
        let Group { first, end, .. } = self.glints.groups[group];
        let triangles = &self.glints.triangles[first..end];
        let area = triangles[triangles.len() - 1].1 * within;
        let place = triangles.partition_point(|t| t.1 <= area);
        let triangle = triangles[place.min(triangles.len() - 1)].0;
        let point = self.surfaces.triangle(triangle).point_at([u, v]);
        (triangle, (point - self.origin).normalize_or_zero())
    }

    /// Density per solid angle with which a point of this triangle is drawn that lies at a distance in m and is seen under
    /// the cosine `cos`; 0 for what is no small mirror.
    pub(crate) fn density(&self, triangle: u32, distance: f64, cos: f64) -> f64 {
        let number = self.glints.of[triangle as usize];
        let Some(group) = usize::from(number).checked_sub(1) else {
            return 0.0;
        };
        self.density_in(group) * distance * distance / cos
    }

    /// Density per area of the choice of a point in a group.
    fn density_in(&self, group: usize) -> f64 {
        let before = group.checked_sub(1).map_or(0.0, |g| self.cumulated[g]);
        let area = self.glints.triangles[self.glints.groups[group].end - 1].1;
        (self.cumulated[group] - before) / area
    }

    /// Greatest share of an emitter's exitance that a walk or its companion may bring which meets it in a small mirror.
    pub(crate) fn greatest(&self) -> f64 {
        let share = |(index, group): (usize, &Group)| {
            let near = (self.origin.distance(group.centre) - group.radius).max(0.0);
            1.0 / (1.0 + PI * self.density_in(index) * near * near)
        };
        let shares = self.glints.groups.iter().enumerate().map(share);
        shares.fold(0.0, f64::max)
    }
}
