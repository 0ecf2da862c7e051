//! The JSON of a glTF file, checked.

use super::super::LoadError;
use super::super::model::listed;
use ::gltf::json::validation::{Checked, Error, Validate};
use ::gltf::json::{Index, Path as Place, Root};
use ::gltf::{Document, Semantic};
use std::path::Path;

/// Extensions whose content is read, or that change nothing here.
const READ: [&str; 7] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_texture_transform",
];

/// Parses and checks the JSON, so that no index in it leads astray.
///
/// # Errors
/// If it is no glTF 2.0, needs an extension that is not read, or refers to something that is not there.
pub(super) fn parse(
    file: &Path,
    json: &[u8],
    notes: &mut Vec<String>,
) -> Result<Document, LoadError> {
    let mut root = Root::from_slice(json).map_err(|error| {
        LoadError::invalid(file, "JSON", error.to_string(), "a glTF 2.0 document")
    })?;
    extensions(file, &root, notes)?;
    texture_sources(&mut root);
    validate(file, &root)?;
    Ok(Document::from_json_without_validation(root))
}

/// Refuses extensions that hide geometry, before the missing data make errors of their own.
fn extensions(file: &Path, root: &Root, notes: &mut Vec<String>) -> Result<(), LoadError> {
    let refused = |extension: &str, remedy| LoadError::Extension {
        file: file.to_owned(),
        extension: extension.to_owned(),
        remedy,
    };
    for extension in &root.extensions_required {
        if let Some(remedy) = remedy(extension) {
            return Err(refused(extension, remedy));
        }
    }
    // Blender writes this one without requiring it; the instances would be missing all the same.
    const INSTANCING: &str = "EXT_mesh_gpu_instancing";
    let mut nodes = root.nodes.iter().filter_map(|n| n.extensions.as_ref());
    if nodes.any(|e| e.others.contains_key(INSTANCING)) {
        return Err(refused(INSTANCING, remedy(INSTANCING).unwrap_or_default()));
    }
    let mut unread = root.extensions_used.clone();
    unread.retain(|extension| !READ.contains(&extension.as_str()));
    if !unread.is_empty() {
        notes.push(format!("extensions that are not read: {}", listed(&unread)));
    }
    Ok(())
}

/// What to do about a required extension; none where the geometry is all there without it. Extensions of
/// materials and textures are such: the core fields stand beside them.
fn remedy(extension: &str) -> Option<&'static str> {
    match extension {
        "KHR_draco_mesh_compression" => Some("in Blender's glTF export untick Data > Compression"),
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => Some(
            "export again without compression (Blender: untick Data > Compression; gltfpack: no -c, no -cc)",
        ),
        "KHR_mesh_quantization" => Some(
            "export again with positions as floats (Blender: untick Data > Compression; gltfpack: -noq)",
        ),
        "EXT_mesh_gpu_instancing" => {
            Some("in Blender's glTF export untick Data > Scene Graph > GPU Instances")
        }
        _ if READ.contains(&extension) => None,
        _ if [
            "KHR_materials_",
            "KHR_texture_",
            "EXT_texture_",
            "MSFT_texture_",
            "KHR_animation_",
        ]
        .iter()
        .any(|family| extension.starts_with(family)) =>
        {
            None
        }
        _ => Some("export again without it"),
    }
}

/// Gives textures that exist in an extension's format only (WebP, Basis) that image as their source, so
/// that they end as an unreadable image and not as a broken file.
fn texture_sources(root: &mut Root) {
    let images = root.images.len();
    for texture in &mut root.textures {
        if texture.source.value() < images {
            continue;
        }
        let extensions = texture.extensions.iter().flat_map(|e| e.others.values());
        let source = extensions
            .filter_map(|extension| extension.get("source")?.as_u64())
            .find_map(|source| u32::try_from(source).ok());
        if let Some(source) = source {
            texture.source = Index::new(source);
        }
    }
}

/// The crate's own validation, spared two things: it refuses extensions that we can do without and positions
/// without stated bounds, and it panics on an index of positions that leads nowhere.
fn validate(file: &Path, root: &Root) -> Result<(), LoadError> {
    let invalid = |place: String, found: &str, allowed: &str| {
        Err(LoadError::invalid(file, place, found, allowed))
    };
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let positions = primitive
                .attributes
                .get(&Checked::Valid(Semantic::Positions));
            if let Some(index) = positions.filter(|i| i.value() >= root.accessors.len()) {
                return invalid(
                    format!("meshes[{m}].primitives[{p}].attributes.POSITION"),
                    &index.to_string(),
                    &format!("the file has {} accessors", root.accessors.len()),
                );
            }
        }
    }
    let mut faults: Vec<(Place, Error)> = Vec::new();
    root.validate(root, Place::new, &mut |place, error| {
        let place = place();
        if error != Error::Unsupported && !place.as_str().contains("attributes[\"POSITION\"]") {
            faults.push((place, error));
        }
    });
    match &faults[..] {
        [] => Ok(()),
        [(place, error), others @ ..] => invalid(
            place.to_string(),
            &error.to_string(),
            &match others.len() {
                0 => "see the glTF 2.0 specification".to_owned(),
                count => format!("and {count} more faults of this kind"),
            },
        ),
    }
}
