//! Scenes, properties, lamps, materials and textures of small glTF files.

use super::super::writer::Writer;
use super::only_part;
use crate::load::{LampKind, Look, Model, Placement, load};
use glam::DVec3;
use serde_json::json;

/// Stores an image of one colour and gives the first material a base-colour texture of it.
fn textured(image: serde_json::Value) -> Writer {
    let mut file = Writer::triangle();
    file.json["materials"] =
        json!([{"name": "Wall", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    file.json["textures"] = json!([{"source": 0}]);
    file.json["images"] = json!([image]);
    file
}

fn png(pixel: [u8; 4]) -> Vec<u8> {
    let image = ::image::RgbaImage::from_pixel(2, 2, pixel.into());
    let mut bytes = std::io::Cursor::new(Vec::new());
    image
        .write_to(&mut bytes, ::image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

fn base_color(model: &Model) -> [f64; 3] {
    match model.materials[0].look {
        Look::Gltf {
            base_color,
            textured: true,
            ..
        } => base_color,
        _ => panic!("{:?}", model.materials[0]),
    }
}

#[test]
fn only_the_default_scene_is_read() {
    let mut file = Writer::triangle();
    file.json["nodes"] = json!([{"name": "A"}, {"name": "B"}, {"name": "C", "children": [1]}]);
    file.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [2]}]);
    let names = |file: &Writer| {
        let model = file.load().unwrap();
        (
            model
                .objects
                .into_iter()
                .map(|o| o.name)
                .collect::<Vec<_>>()
                .join(" "),
            model.notes,
        )
    };
    file.json["scene"] = json!(1);
    assert_eq!(names(&file).0, "C B");
    file.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(names(&file).0, "A");
    assert!(names(&file).1[0].contains("1 others"));
    file.json["scenes"] = json!([]);
    let (all, notes) = names(&file);
    assert_eq!(all, "A C B");
    assert!(notes[0].contains("no scene"), "{notes:?}");
}

#[test]
fn an_objects_properties_win_over_its_meshs() {
    let mut file = Writer::triangle();
    file.json["meshes"][0]["extras"] = json!({"malus_rho": 0.1, "malus_a": 0.2});
    file.json["nodes"][0]["extras"] = json!({"malus_rho": 0.3});
    let properties = &file.load().unwrap().objects[0].properties;
    assert_eq!(json!(properties), json!({"malus_rho": 0.3, "malus_a": 0.2}));
    file.json["nodes"][0]["extras"] = json!("text");
    assert_eq!(file.load().unwrap().objects[0].properties.len(), 2);
}

#[test]
fn a_lamp_merges_the_properties_of_its_object_and_its_light() {
    let mut file = Writer::triangle();
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "name": "Light", "intensity": 7.5,
        "color": [1, 0.5, 0.25], "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}, "extras": {"a": 1, "b": 2}}]}});
    let light = json!({"KHR_lights_punctual": {"light": 0}});
    file.json["nodes"] = json!([{"extensions": light, "extras": {"a": 3}, "translation": [1, 2, 3], "scale": [2, 2, 2]}]);
    let model = file.load().unwrap();
    let [lamp] = &model.lamps[..] else { panic!() };
    assert_eq!(json!(lamp.properties), json!({"a": 3, "b": 2}));
    assert_eq!(
        (&*lamp.name, lamp.intensity, lamp.color),
        ("Light", 7.5, [1.0, 0.5, 0.25])
    );
    assert_eq!(
        lamp.kind,
        LampKind::Spot {
            inner_rad: 0.25,
            outer_rad: 0.5
        }
    );
    // A lamp shines along −Z of the file, which is +Y of the world.
    assert_eq!(
        (lamp.position, lamp.direction, lamp.x_axis),
        (DVec3::new(1.0, -3.0, 2.0), DVec3::Y, DVec3::X)
    );
    assert_eq!(model.objects, []);
    file.json["nodes"][0]["scale"] = json!([0, 0, 0]);
    assert!(file.error().contains("lamp"));
}

#[test]
fn a_lamp_with_a_mesh_is_both_and_a_camera_is_neither() {
    let mut file = Writer::triangle();
    file.json["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "point"}, {"type": "directional"}]}});
    file.json["cameras"] =
        json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]);
    file.json["nodes"] = json!([{"name": "Both", "mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 1}}, "children": [1]},
        {"name": "Camera", "camera": 0, "children": [2]}, {"name": "Child"}]);
    let model = file.load().unwrap();
    let names: Vec<_> = model.objects.iter().map(|o| &*o.name).collect();
    assert_eq!(names, ["Both", "Child"]);
    assert_eq!(
        (model.lamps.len(), model.lamps[0].kind),
        (1, LampKind::Distant)
    );
}

#[test]
fn every_field_of_a_material_arrives() {
    let mut file = Writer::triangle();
    file.json["materials"] = json!([{"doubleSided": true, "alphaMode": "BLEND", "emissiveFactor": [0.5, 1, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.6, "roughnessFactor": 0.7},
        "extras": {"malus_n": 1.6},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_transmission": {"transmissionFactor": 0.9}}}]);
    file.primitive()["material"] = json!(0);
    let model = file.load().unwrap();
    assert_eq!(only_part(&model).material, Some(0));
    assert_eq!(model.materials[0].name, "material 0");
    assert_eq!(
        json!(model.materials[0].properties),
        json!({"malus_n": 1.6})
    );
    let expected = Look::Gltf {
        base_color: [0.1, 0.2, 0.3],
        textured: false,
        metallic: 0.6,
        roughness: 0.7,
        specular: 1.0,
        specular_color: [1.0; 3],
        ior: Some(1.33),
        transmission: 0.9,
        emissive: [4.0, 8.0, 0.0],
        alpha: 0.4,
        opaque: false,
        double_sided: true,
        thickness: 0.0,
    };
    assert_eq!(model.materials[0].look, expected);
}

#[test]
fn a_texture_counts_with_its_mean_in_linear_light() {
    // sRGB level 128 is a linear 0.21586 (IEC 61966-2-1).
    let bytes = png([128, 255, 0, 51]);
    let mut file = textured(json!({"bufferView": 2, "mimeType": "image/png"}));
    assert_eq!(file.view(&bytes), 2);
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] =
        json!([0.5, 0.5, 0.5, 1]);
    let material = &mut file.json["materials"][0];
    material["emissiveTexture"] = json!({"index": 0});
    material["emissiveFactor"] = json!([1, 1, 1]);
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({"index": 0});
    let model = file.load().unwrap();
    let [r, g, b] = base_color(&model);
    assert!((r - 0.5 * 0.215_860_5).abs() < 1e-7);
    assert_eq!((g, b), (0.5, 0.0));
    let Look::Gltf {
        emissive,
        alpha,
        metallic,
        roughness,
        ..
    } = model.materials[0].look
    else {
        panic!()
    };
    assert_eq!((alpha, roughness, metallic), (0.2, 1.0, 0.0));
    assert!((emissive[0] - 0.215_860_5).abs() < 1e-7);
    assert_eq!(model.notes.len(), 3);
    assert!(
        model
            .notes
            .iter()
            .all(|n| n.contains("Wall") && n.contains("mean")),
        "{:?}",
        model.notes
    );
}

#[test]
fn an_image_beside_the_file_is_found_by_its_escaped_name() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("my wall.png"), png([255, 0, 0, 255])).unwrap();
    std::fs::write(
        folder.path().join("room.gltf"),
        textured(json!({"uri": "my%20wall.png"})).text(),
    )
    .unwrap();
    let model = load(&folder.path().join("room.gltf"), &Placement::default()).unwrap();
    assert_eq!(base_color(&model), [1.0, 0.0, 0.0]);
}

#[test]
fn an_unreadable_image_counts_as_white_and_is_noted() {
    for image in [
        json!({"uri": "absent.png"}),
        json!({"uri": "data:image/png;base64,AAAA"}),
        json!({}),
        json!({"bufferView": 0}),
        json!({"uri": "http://a/b.png"}),
    ] {
        let model = textured(image.clone()).load().unwrap();
        assert_eq!(base_color(&model), [1.0; 3], "{image}");
        assert!(model.notes[1].contains("images[0]"), "{:?}", model.notes);
    }
    // A texture in WebP alone.
    let mut file = textured(json!({"uri": "a.webp"}));
    file.json["extensionsRequired"] = json!(["EXT_texture_webp"]);
    file.json["textures"] = json!([{"extensions": {"EXT_texture_webp": {"source": 0}}}]);
    assert_eq!(base_color(&file.load().unwrap()), [1.0; 3]);
}
