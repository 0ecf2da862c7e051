//! Uniform numbers, directions and rooms for the tests.

use crate::{Mesh, Surfaces, shape};
use glam::DVec3;

/// SplitMix64 (Steele, Lea and Flood 2014) from a fixed seed.
pub(crate) struct Uniform(pub u64);

impl Uniform {
    /// The next number in [0, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// One of `count` numbers from 0.
    pub fn index(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// A point in the cube from −½ to ½.
    pub fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) - 0.5
    }

    /// A direction, even over the sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let point = 2.0 * self.point();
            if (0.01..=1.0).contains(&point.length_squared()) {
                return point.normalize();
            }
        }
    }

    /// A direction after a diffuse reflection at a surface with this normal.
    pub fn cosine(&mut self, normal: DVec3) -> DVec3 {
        (normal + self.direction()).normalize_or(normal)
    }
}

/// Surfaces of objects in this order, object and surface both numbered from 0.
pub(crate) fn surfaces(parts: &[shape::Faces]) -> Surfaces {
    let mut mesh = Mesh::default();
    for (index, (positions, triangles)) in (0..).zip(parts) {
        mesh.append(positions, triangles, index, index);
    }
    Surfaces::new(mesh).unwrap()
}

/// A parallelogram cut into counts[0] × counts[1] cells.
pub(crate) fn grid(origin: DVec3, u: DVec3, v: DVec3, counts: [u32; 2]) -> shape::Faces {
    let [across, up] = counts;
    let mut positions = Vec::new();
    for j in 0..=up {
        for i in 0..=across {
            let at = |k: u32, n: u32| f64::from(k) / f64::from(n);
            positions.push(origin + at(i, across) * u + at(j, up) * v);
        }
    }
    let mut triangles = Vec::new();
    for j in 0..up {
        for i in 0..across {
            let a = j * (across + 1) + i;
            let b = a + across + 1;
            triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
        }
    }
    (positions, triangles)
}

/// The six sides of a parallelepiped, normals inward, each cut into its own number of cells: floor, ceiling, then walls.
pub(crate) fn room(min: DVec3, edges: [DVec3; 3], counts: [[u32; 2]; 6]) -> Vec<shape::Faces> {
    let [x, y, z] = edges;
    vec![
        grid(min, x, y, counts[0]),
        grid(min + z, y, x, counts[1]),
        grid(min, y, z, counts[2]),
        grid(min + x, z, y, counts[3]),
        grid(min, z, x, counts[4]),
        grid(min + y, x, z, counts[5]),
    ]
}

/// A cube around a point, each side cut into n × n cells.
pub(crate) fn cube(centre: DVec3, side: f64, n: u32) -> Surfaces {
    let edges = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * side);
    surfaces(&room(centre - 0.5 * side, edges, [[n, n]; 6]))
}

/// Triangles anywhere in the cube from −1 to 1 and a little beyond, each of up to twice the size.
pub(crate) fn soup(seed: u64, count: u32, size: f64) -> Mesh {
    let mut uniform = Uniform(seed);
    let mut mesh = Mesh::default();
    for index in 0..count {
        let place = uniform.point();
        let positions = [(); 3].map(|()| place + size * uniform.point());
        mesh.append(&positions, &[[0, 1, 2]], index, 0);
    }
    mesh
}
