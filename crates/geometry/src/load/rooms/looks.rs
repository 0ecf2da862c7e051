//! Lamps and materials of the office, against the script that made it.

use super::office;
use crate::load::{LampKind, Look};
use glam::DVec3;
use serde_json::json;

#[test]
fn lamps_have_blenders_intensities_cones_and_directions() {
    let model = office("office.glb");
    let [point, spot, sun] = &model.lamps[..] else {
        panic!("{:?}", model.lamps)
    };
    // W × 683/4π cd; the sun W/m² × 683 lx.
    assert_eq!((&*point.name, point.kind), ("Point_Bulb", LampKind::Point));
    assert!((point.intensity - 60.0 * 683.0 / (4.0 * std::f64::consts::PI)).abs() < 1e-3);
    assert!((point.position - DVec3::new(0.4, 3.6, 1.8)).length() < 1e-6);
    assert_eq!(point.color, [1.0; 3]);
    let LampKind::Spot {
        inner_rad,
        outer_rad,
    } = spot.kind
    else {
        panic!("{spot:?}")
    };
    // 50° in full; blend 0.2.
    assert!((outer_rad - 25f64.to_radians()).abs() < 1e-6);
    assert!((inner_rad - 0.8 * 25f64.to_radians()).abs() < 1e-6);
    assert!((spot.direction - DVec3::NEG_Z).length() < 1e-6);
    assert!((spot.x_axis - DVec3::X).length() < 1e-6);
    assert_eq!(
        spot.properties["malus_polarisation"],
        json!([1.0, 0.3, 0.0, 0.0])
    );
    assert_eq!(sun.kind, LampKind::Distant);
    assert!((sun.intensity - 2049.0).abs() < 1e-9);
    // Straight down, turned by 50° about X.
    let (sin, cos) = 50f64.to_radians().sin_cos();
    assert!((sun.direction - DVec3::new(0.0, sin, -cos)).length() < 1e-6);
}

#[test]
fn materials_have_the_values_of_the_script_that_made_them() {
    let model = office("office.glb");
    let material = |name: &str| model.materials.iter().find(|m| m.name == name).unwrap();
    assert_eq!(model.materials.len(), 11);
    let Look::Gltf {
        base_color,
        metallic,
        roughness,
        ior,
        opaque,
        double_sided,
        textured,
        alpha,
        ..
    } = material("Wall_Paint").look
    else {
        panic!()
    };
    assert_eq!(base_color, [0.78, 0.77, 0.74]);
    assert_eq!((metallic, roughness, ior, alpha), (0.0, 0.9, None, 1.0));
    assert!(opaque && !double_sided && !textured);
    let Look::Gltf {
        transmission, ior, ..
    } = material("Glass").look
    else {
        panic!()
    };
    assert_eq!((transmission, ior), (1.0, Some(1.517)));
    let Look::Gltf { specular, .. } = material("Chair_Fabric").look else {
        panic!()
    };
    assert_eq!(specular, 0.0);
    let Look::Gltf {
        specular,
        specular_color,
        ..
    } = material("Door_Lacquer").look
    else {
        panic!()
    };
    assert_eq!((specular, specular_color), (1.0, [1.6; 3]));
    let panel = material("Lamp_Panel");
    let Look::Gltf { emissive, .. } = panel.look else {
        panic!()
    };
    assert_eq!(emissive, [12.0, 0.95 * 12.0, 0.88 * 12.0]);
    assert_eq!(panel.properties["malus_emit_lm"], json!(3600.0));
    assert_eq!(material("Ceiling").properties["malus_rho"], json!(0.85));
}

#[test]
fn the_mtl_gives_the_same_colours_as_the_glb() {
    let (gltf, obj) = (office("office.glb"), office("office.obj"));
    assert_eq!(obj.materials.len(), 11);
    for m in &obj.materials {
        let Look::Mtl { kd, ni, pr, pm, .. } = m.look else {
            panic!()
        };
        assert!(kd.is_some() && ni.is_some() && pr.is_some() && pm.is_some());
        let Some(twin) = gltf.materials.iter().find(|g| g.name == m.name) else {
            panic!("{}", m.name)
        };
        let Look::Gltf { base_color, .. } = twin.look else {
            panic!()
        };
        assert_eq!(kd, Some(base_color), "{}", m.name);
    }
}
