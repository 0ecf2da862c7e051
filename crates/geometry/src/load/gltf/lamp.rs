//! Lamps of KHR_lights_punctual.

use super::super::model::Names;
use super::super::{Lamp, LampKind};
use super::material::properties;
use ::gltf::Node;
use ::gltf::khr_lights_punctual::{Kind, Light};
use glam::{DAffine3, DVec3};

/// The lamp at a node, which shines along its local −Z; none where the transform leaves no direction.
///
/// Blender writes custom properties of the light's data to the light and those of the object to the node;
/// the object's win.
pub(super) fn placed(
    node: &Node,
    light: &Light,
    world: DAffine3,
    names: &mut Names,
) -> Option<Lamp> {
    let mut merged = properties(light.extras());
    merged.extend(properties(node.extras()));
    let name = match (node.name(), light.name()) {
        (Some(name), _) | (None, Some(name)) => name.to_owned(),
        (None, None) => format!("node {}", node.index()),
    };
    Some(Lamp {
        direction: world.transform_vector3(DVec3::NEG_Z).try_normalize()?,
        x_axis: world.transform_vector3(DVec3::X).try_normalize()?,
        name: names.unique(&name),
        properties: merged,
        kind: match light.kind() {
            Kind::Point => LampKind::Point,
            Kind::Directional => LampKind::Distant,
            Kind::Spot {
                inner_cone_angle,
                outer_cone_angle,
            } => LampKind::Spot {
                inner_rad: inner_cone_angle.into(),
                outer_rad: outer_cone_angle.into(),
            },
        },
        position: world.translation,
        intensity: light.intensity().into(),
        color: light.color().map(f64::from),
    })
}
