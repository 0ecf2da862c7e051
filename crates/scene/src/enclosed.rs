//! What lies inside closed solids, where no light comes.

use crate::{Camera, Material, Sensor, Source, SourceKind};
use glam::DVec3;
use malus_geometry::Surfaces;
use malus_geometry::solid::{Solid, Solids};

/// The closed solids of a scene, and what is needed to tell which of them are dark.
pub(crate) struct Darkness<'a> {
    surfaces: &'a Surfaces,
    materials: &'a [Material],
    solids: Solids<'a>,
    /// A point of each emitter.
    emitters: Vec<DVec3>,
}

impl<'a> Darkness<'a> {
    pub(crate) fn of(
        surfaces: &'a Surfaces,
        materials: &'a [Material],
        sources: &[Source],
    ) -> Self {
        Self {
            surfaces,
            materials,
            solids: Solids::of(surfaces.mesh()),
            emitters: emitters(surfaces, materials, sources),
        }
    }

    /// Marks the points strictly inside a closed solid that is dark and does not hold all points.
    ///
    /// A point on a surface counts as lying on its normal's side of it.
    pub(crate) fn mark(&self, sensors: &mut [Sensor]) {
        let offset = self.surfaces.offset();
        for solid in &self.solids {
            let (least, most) = solid.bounds();
            let within = |point: DVec3| point.cmpge(least).all() && point.cmple(most).all();
            let mut points: Vec<_> = sensors
                .iter_mut()
                .flat_map(|sensor| &mut sensor.points)
                .collect();
            let count = points.len();
            points.retain(|point| within(point.position));
            // Whether an emitter is inside is asked first: a room of a million triangles is then asked once, not for
            // each point.
            if points.is_empty() || !self.is_dark(solid) {
                continue;
            }
            points.retain(|point| solid.contains(point.position + offset * point.normal));
            if points.len() < count {
                points.iter_mut().for_each(|point| point.enclosed = true);
            }
        }
    }

    /// One sentence for each camera that stands inside a dark solid or outside of all geometry.
    ///
    /// A solid that holds a free sensor point, or whose normals point inward, is a room.
    pub(crate) fn warnings(
        &self,
        cameras: &[Camera],
        sensors: &[Sensor],
        objects: &[String],
    ) -> Vec<String> {
        let points = || sensors.iter().flat_map(|sensor| &sensor.points);
        let is_room = |solid: &Solid<'_>| {
            let mut free = points().filter(|point| !point.enclosed);
            solid.volume() < 0.0 || free.any(|point| solid.contains(point.position))
        };
        let bounds = crate::check::bounds(self.surfaces);
        let warn = |camera: &Camera| {
            let (name, position) = (&camera.name, camera.position);
            let mut around = self.solids.iter().filter(|solid| solid.contains(position));
            if let Some(solid) = around.find(|solid| self.is_dark(solid) && !is_room(solid)) {
                let object = &objects[solid.object() as usize];
                return Some(format!(
                    "camera {name:?} stands inside the closed object {object:?}, in which nothing emits light"
                ));
            }
            let (least, most) = bounds?;
            let outside = position.cmplt(least).any() || position.cmpgt(most).any();
            outside.then(|| {
                format!(
                    "camera {name:?} stands outside of all geometry: of a closed room it sees the walls from behind"
                )
            })
        };
        cameras.iter().filter_map(warn).collect()
    }

    /// Whether a solid has no emitter inside and no pane through which light enters.
    fn is_dark(&self, solid: &Solid<'_>) -> bool {
        let clear = |triangle: &u32| {
            let surface = self.surfaces.surface(*triangle);
            self.materials[surface as usize].optics.is_pane()
        };
        let mut emitters = self.emitters.iter();
        !emitters.any(|&point| solid.contains(point)) && !solid.triangles().iter().any(clear)
    }
}

/// A point of each emitter: point sources, and emitting triangles a little to the front.
fn emitters(surfaces: &Surfaces, materials: &[Material], sources: &[Source]) -> Vec<DVec3> {
    let points = sources.iter().filter_map(|source| match source.kind {
        SourceKind::Point { position, .. } => Some(position),
        SourceKind::Distant { .. } => None,
    });
    let mesh = surfaces.mesh();
    let emits = |triangle: &usize| {
        materials[mesh.surfaces[*triangle] as usize]
            .emission
            .is_some()
    };
    let fronts = (0..mesh.len()).filter(emits).map(|triangle| {
        let triangle = mesh.triangle(triangle);
        triangle.centroid() + surfaces.offset() * triangle.normal()
    });
    points.chain(fronts).collect()
}
