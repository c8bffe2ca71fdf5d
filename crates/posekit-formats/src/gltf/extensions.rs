//! Which extensions a file may require and still be read.

use gltf::json::Root;

use super::Notes;
use super::json_path::Step;
use crate::report::{ReadError, ReadErrorKind, quote};

/// Extensions that change what is drawn, or say more about it, and leave nodes, accessors of animations and their
/// buffers as glTF itself has them. Of the compressions Draco holds the triangles of meshes alone; that of `meshopt`
/// holds whole views into buffers, keys among them, so that it is not here.
pub const HARMLESS_EXTENSIONS: [&str; 20] = [
    "AGI_articulations",
    "CESIUM_primitive_outline",
    "EXT_instance_features",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_features",
    "EXT_mesh_gpu_instancing",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "KHR_draco_mesh_compression",
    "KHR_gaussian_splatting",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_techniques_webgl",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "VRM",
    "VRMC_vrm",
    "VRMC_vrm_animation",
];

/// What the names of further ones start with: materials and textures.
pub const HARMLESS_EXTENSION_PREFIXES: [&str; 8] = [
    "EXT_materials_",
    "EXT_texture_",
    "KHR_materials_",
    "KHR_texture_",
    "MSFT_packing_",
    "MSFT_texture_",
    "ADOBE_materials_",
    "VRMC_materials_",
];

/// Refuses a file that requires an extension that may change where its joints are.
pub(super) fn check(root: &Root, notes: &Notes) -> Result<(), ReadError> {
    let is_harmless = |name: &str| {
        HARMLESS_EXTENSIONS.contains(&name)
            || HARMLESS_EXTENSION_PREFIXES
                .iter()
                .any(|prefix| name.starts_with(prefix))
    };
    let required = root.extensions_required.iter().enumerate();
    match required.into_iter().find(|(_, name)| !is_harmless(name)) {
        None => Ok(()),
        Some((place, name)) => Err(notes.error(
            ReadErrorKind::UnknownExtension,
            &[Step::Key("extensionsRequired"), Step::Index(place)],
            "extensions that leave joints and animations alone",
            format!(
                "{}, which is not read: write the file without it",
                quote(name.as_bytes())
            ),
        )),
    }
}
