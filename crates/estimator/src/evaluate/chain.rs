//! The mirrors and panes between a walk and its sensor.

use super::{Light, at_sensor, scattered, taken_in};
use crate::medium::Step;
use crate::path::Vertex;
use crate::receiver::Receiver;
use glam::DVec3;
use malus_optics::{
    Analyser, Basis, Emergence, Incidence, Material as Optics, Mueller, Rotator, Sensor, Stokes,
};

/// The mirrors and panes that a walk has met since its last diffuse event, as light meets them on its way to the sensor.
#[derive(Debug, Clone, Copy)]
pub(super) enum Chain<const N: usize> {
    /// No diffuse event yet: the whole matrix up to the sensor is needed.
    ToSensor(Option<(Mueller<N, Incidence, Sensor>, Basis<Incidence>)>),
    /// Behind a diffuse event, which sends `leaving` to the sensor: one row is enough.
    ToDiffuser {
        leaving: Stokes<N, Sensor>,
        row: Option<(Analyser<N, Incidence>, Basis<Incidence>)>,
    },
}

impl<const N: usize> Chain<N> {
    /// Light that comes along a direction, once it has reached the sensor.
    pub(super) fn pass(
        &self,
        receiver: &Receiver,
        direction: DVec3,
        light: Light<N>,
    ) -> Stokes<N, Sensor> {
        match (self, light) {
            (Self::ToSensor(None), _) => at_sensor(receiver, direction, light),
            (Self::ToSensor(Some((matrix, basis))), Some((light, carried))) => {
                *matrix * (Rotator::new(&carried, basis) * light)
            }
            (Self::ToSensor(Some((matrix, _))), None) => *matrix * Stokes::unpolarised(1.0),
            (Self::ToDiffuser { leaving, row: None }, light) => {
                *leaving * light.map_or(1.0, |(light, _)| light.i())
            }
            (
                Self::ToDiffuser {
                    leaving,
                    row: Some((row, basis)),
                },
                Some((light, carried)),
            ) => *leaving * (*row * (Rotator::new(&carried, basis) * light)),
            (
                Self::ToDiffuser {
                    leaving,
                    row: Some((row, _)),
                },
                None,
            ) => *leaving * (*row * Stokes::unpolarised(1.0)),
        }
    }

    /// The chain with one more mirror or pane before it.
    pub(super) fn extended(&self, receiver: &Receiver, step: &Step) -> Self {
        let normal = step.normal;
        let onward = if step.through {
            step.arriving
        } else {
            (step.arriving - normal * (2.0 * step.arriving.dot(normal))).normalize()
        };
        let (incidence, reflected) = Basis::mirror(-onward, normal);
        let carried = if step.through {
            Basis::<Emergence>::new(-onward, incidence.axis()).carried()
        } else {
            reflected.carried()
        };
        match self {
            Self::ToSensor(matrix) => {
                let onward: Mueller<N, Emergence, Sensor> = match matrix {
                    None => {
                        let sensor = receiver.basis(carried.direction());
                        Mueller::from(Rotator::new(&carried, &sensor)).emergent()
                    }
                    Some((matrix, basis)) => (*matrix * Rotator::new(&carried, basis)).emergent(),
                };
                Self::ToSensor(Some((onward * step.matrix, incidence)))
            }
            Self::ToDiffuser { leaving, row } => {
                let onward: Analyser<N, Emergence> = match row {
                    None => Analyser::intensity(),
                    Some((row, basis)) => (*row * Rotator::new(&carried, basis)).emergent(),
                };
                Self::ToDiffuser {
                    leaving: *leaving,
                    row: Some((onward * step.matrix, incidence)),
                }
            }
        }
    }

    /// The chain behind a scattering surface that sends light against `arriving`, for light that comes to it against
    /// `toward`.
    pub(super) fn behind(
        &self,
        receiver: &Receiver,
        optics: &Optics,
        vertex: &Vertex,
        toward: DVec3,
    ) -> Self {
        let direction = -vertex.arriving;
        if optics.polarises_scattering() {
            let light = scattered(optics, vertex.normal, direction);
            return Self::ToDiffuser {
                leaving: self.pass(receiver, direction, light),
                row: Some(taken_in(optics, vertex.normal, -toward)),
            };
        }
        Self::ToDiffuser {
            leaving: self.pass(receiver, direction, None),
            row: None,
        }
    }

    /// The chain behind a diffuse event, times a factor.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        if let Self::ToDiffuser { leaving, .. } = &mut self {
            *leaving = *leaving * factor;
        }
        self
    }
}
