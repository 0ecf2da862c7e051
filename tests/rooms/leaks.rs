//! Closed rooms do not leak: no ray from inside gets out, least of all where surfaces meet.

use crate::cli::Folder;
use glam::DVec3;
use malus_geometry::{Mesh, Surfaces, shape};
use malus_scene::Scene;

const AXES: [DVec3; 6] = [
    DVec3::X,
    DVec3::NEG_X,
    DVec3::Y,
    DVec3::NEG_Y,
    DVec3::Z,
    DVec3::NEG_Z,
];

/// Vertices and edge midpoints of all triangles: where a ray is most likely to slip through.
fn seams(surfaces: &Surfaces) -> Vec<DVec3> {
    let mesh = surfaces.mesh();
    let corners = |triangle: &[u32; 3]| triangle.map(|index| mesh.positions[index as usize]);
    let seams = mesh.triangles.iter().flat_map(|triangle| {
        let [a, b, c] = corners(triangle);
        [a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)]
    });
    let mut seams: Vec<DVec3> = seams.collect();
    seams.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
    seams.dedup();
    seams
}

/// Directions in which rays from `origin` are to be stopped: at every seam, and along the axes.
fn directions(origin: DVec3, seams: &[DVec3]) -> impl Iterator<Item = DVec3> {
    let aimed = seams
        .iter()
        .filter_map(move |seam| (seam - origin).try_normalize());
    aimed.chain(AXES)
}

/// Rays that get out, of all those from `origins`, and how many there were.
fn leaks(surfaces: &Surfaces, origins: &[DVec3]) -> (Vec<(DVec3, DVec3)>, usize) {
    let seams = seams(surfaces);
    let (mut leaks, mut rays) = (Vec::new(), 0);
    for &origin in origins {
        for direction in directions(origin, &seams) {
            rays += 1;
            if surfaces.escapes(origin, direction) || surfaces.nearest(origin, direction).is_none()
            {
                leaks.push((origin, direction));
            }
        }
    }
    (leaks, rays)
}

#[track_caller]
fn assert_closed(what: &str, surfaces: &Surfaces, origins: &[DVec3], at_least: usize) {
    let (leaks, rays) = leaks(surfaces, origins);
    assert!(rays >= at_least, "{what}: only {rays} rays");
    assert!(
        leaks.is_empty(),
        "{what}: {} of {rays} rays get out, the first {:?}",
        leaks.len(),
        leaks[0]
    );
}

/// Evenly spread points of the unit cube's inside, by steps of the plastic number.
fn inside(count: usize) -> impl Iterator<Item = DVec3> {
    const STEP: DVec3 = DVec3::new(0.819_172_513_396, 0.671_043_606_703, 0.549_700_477_901);
    (1..=count).map(|index| (STEP * index as f64).fract())
}

/// Points whose coordinates are those of the mesh's own vertices: rays along the axes then run along seams.
fn lattice(surfaces: &Surfaces, min: DVec3, max: DVec3) -> Vec<DVec3> {
    let along = |axis: usize| {
        let mesh = surfaces.mesh();
        let mut values: Vec<f64> = mesh
            .positions
            .iter()
            .map(|position| position[axis])
            .collect();
        values.retain(|value| *value > min[axis] && *value < max[axis]);
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let [x, y, z] = [along(0), along(1), along(2)];
    let mut points = Vec::new();
    for &x in &x {
        for &y in &y {
            points.extend(z.iter().map(|&z| DVec3::new(x, y, z)));
        }
    }
    points
}

fn office() -> std::sync::Arc<Surfaces> {
    let scene = super::office("office.glb");
    let folder = Folder::new(scene.as_bytes(), &[]);
    Scene::load(&folder.path("room.toml"), &[])
        .unwrap()
        .surfaces
}

/// The room is 6 × 4 × 2.8 m; a pane closes the window's reveal and the door's leaf stands in its opening.
#[test]
fn the_office_lets_no_ray_out_at_vertices_and_edges() {
    let surfaces = office();
    let origins: Vec<DVec3> = inside(28)
        .map(|point| point * DVec3::new(6.0, 4.0, 2.8))
        .collect();
    assert_closed("office", &surfaces, &origins, 100_000);
}

#[test]
fn the_office_lets_no_ray_out_along_the_axes() {
    let surfaces = office();
    // Where coordinates repeat, rays along the axes meet edges and vertices of furniture and shell exactly.
    let margin = DVec3::splat(1e-3);
    let origins = lattice(&surfaces, margin, DVec3::new(6.0, 4.0, 2.8) - margin);
    let picked = origins.iter().step_by(origins.len().div_ceil(20_000));
    let mut rays = 0;
    for &origin in picked {
        for direction in AXES {
            rays += 1;
            let hit = surfaces.nearest(origin, direction);
            assert!(
                hit.is_some() && !surfaces.escapes(origin, direction),
                "{origin} along {direction}"
            );
        }
    }
    assert!(rays >= 50_000, "only {rays} rays");
}

/// Boxes from a millimetre to ten kilometres, at the origin and away from it, their sides cut into a lattice.
#[test]
fn boxes_of_any_size_let_no_ray_out() {
    for side in [1e-3, 1.0, 1e4] {
        for corner in [
            DVec3::ZERO,
            DVec3::new(-0.37, 0.61, 1.9) * side,
            DVec3::new(3.0, -5.0, 2.0) * side,
        ] {
            let mut mesh = Mesh::default();
            let (positions, triangles) = lattice_box(corner, side);
            mesh.append(&positions, &triangles, 0, 0);
            let surfaces = Surfaces::new(mesh).unwrap();
            // A half-grid puts rays along the axes exactly on edges and vertices.
            let halves = [0.125, 0.25, 0.5, 0.75];
            let grid = halves.iter().flat_map(|&x| {
                halves
                    .iter()
                    .flat_map(move |&y| halves.map(|z| DVec3::new(x, y, z)))
            });
            let origins: Vec<DVec3> = grid
                .chain(inside(16))
                .map(|point| corner + side * point)
                .collect();
            assert_closed(
                &format!("box of {side} m at {corner}"),
                &surfaces,
                &origins,
                10_000,
            );
        }
    }
}

/// A cube whose sides are 4 × 4 squares of two triangles.
fn lattice_box(corner: DVec3, side: f64) -> shape::Faces {
    const CUTS: usize = 4;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for end in [0.0, 1.0] {
            for row in 0..CUTS * CUTS {
                let at = [row / CUTS, row % CUTS].map(|cut| cut as f64 / CUTS as f64);
                let step = 1.0 / CUTS as f64;
                let square = [[0.0, 0.0], [step, 0.0], [step, step], [0.0, step]];
                let first = u32::try_from(positions.len()).unwrap();
                positions.extend(square.map(|[u, v]| {
                    let mut point = DVec3::ZERO;
                    point[axis] = end;
                    point[(axis + 1) % 3] = at[0] + u;
                    point[(axis + 2) % 3] = at[1] + v;
                    corner + side * point
                }));
                triangles.extend(
                    [[0, 1, 2], [0, 2, 3]]
                        .map(|corners: [u32; 3]| corners.map(|index| first + index)),
                );
            }
        }
    }
    (positions, triangles)
}

/// Two-triangle walls that meet in T-junctions, as wall and window do: the vertices of one lie on the edge of the other.
#[test]
fn walls_that_meet_in_t_junctions_let_no_ray_out() {
    let mut mesh = Mesh::default();
    let (positions, triangles) = shape::cuboid(DVec3::ZERO, DVec3::new(6.0, 4.0, 2.8), true);
    // All sides but y = 0, which is cut into columns at 1.2 and 4.8 m.
    let side = |triangle: &&[u32; 3]| {
        !triangle
            .iter()
            .all(|index| positions[*index as usize].y <= 0.0)
    };
    let others: Vec<[u32; 3]> = triangles.iter().filter(side).copied().collect();
    mesh.append(&positions, &others, 0, 0);
    for [from, to] in [[0.0, 1.2], [1.2, 4.8], [4.8, 6.0]] {
        for [low, high] in [[0.0, 0.9], [0.9, 2.2], [2.2, 2.8]] {
            let (u, v) = (DVec3::Z * (high - low), DVec3::X * (to - from));
            let (positions, triangles) = shape::rectangle(DVec3::new(from, 0.0, low), u, v);
            mesh.append(&positions, &triangles, 0, 1);
        }
    }
    let surfaces = Surfaces::new(mesh).unwrap();
    let origins: Vec<DVec3> = inside(200)
        .map(|point| point * DVec3::new(6.0, 4.0, 2.8))
        .collect();
    assert_closed("T-junctions", &surfaces, &origins, 5_000);
}
