//! glTF files as they should not be: what is read of them, what is warned of and where, and what is refused.

use glam::Vec3;
use posekit_formats::gltf::{self, Gltf, Wanted};
use posekit_formats::report::{Import, Place, ReadError, ReadErrorKind};

/// A file of these nodes and whatever else is given.
fn with(nodes: &str, more: &str) -> String {
    format!("{{\"asset\": {{\"version\": \"2.0\"}},\n\"nodes\": [{nodes}]{more}}}")
}

fn read(nodes: &str, more: &str) -> Import<Gltf> {
    gltf::read(with(nodes, more).as_bytes()).unwrap()
}

fn refused(nodes: &str, more: &str) -> ReadError {
    gltf::read(with(nodes, more).as_bytes()).unwrap_err()
}

fn codes(import: &Import<Gltf>) -> Vec<&'static str> {
    let warnings = import.report.warnings.iter();
    warnings.map(|warning| warning.code.code()).collect()
}

#[test]
fn what_makes_no_tree_is_refused_with_its_place() {
    let cases = [
        (r#"{"children": [0]}"#, ReadErrorKind::NotATree, "nodes[0]"),
        (
            r#"{"children": [1]}, {"children": [0]}"#,
            ReadErrorKind::NotATree,
            "nodes[0]",
        ),
        (
            r#"{"children": [1, 1]}, {}"#,
            ReadErrorKind::NotATree,
            "nodes[0].children[1]",
        ),
        (
            r#"{"children": [7]}"#,
            ReadErrorKind::UnknownName,
            "nodes[0].children[0]",
        ),
        ("", ReadErrorKind::Unexpected, ""),
        (
            r#"{"translation": [1e300, 0, 0]}"#,
            ReadErrorKind::NotFinite,
            "nodes[0]",
        ),
        (
            r#"{"children": [1]}, {"translation": [0, 0, 1e20]}"#,
            ReadErrorKind::OutOfRange,
            "nodes[1]",
        ),
        (
            r#"{}, {"rotation": [0, "no", 0, 1]}"#,
            ReadErrorKind::Unexpected,
            "nodes[1].rotation[1]",
        ),
    ];
    for (nodes, kind, path) in cases {
        let error = refused(nodes, "");
        assert_eq!(error.kind, kind, "{nodes}: {error}");
        assert_eq!(error.place, Place::Json(path.into()), "{nodes}: {error}");
    }
    let error = refused("{}", ",\n\"skins\": [{\"joints\": [3]}]");
    assert_eq!(error.kind, ReadErrorKind::UnknownName);
    assert_eq!(error.place.to_string(), "skins[0].joints[0]");
}

#[test]
fn what_is_broken_is_placed_by_its_byte() {
    let place = |bytes: &[u8]| gltf::read(bytes).unwrap_err().place;
    assert_eq!(place(b"{\n \"asset\": ]"), Place::Byte(12));
    assert_eq!(place(b"\xef\xbb\xbf{\n \"asset\": ]"), Place::Byte(15));
    let binary = b"glTF\x02\0\0\0\x20\0\0\0\x05\0\0\0JSON{\"a\",";
    assert_eq!(place(binary), Place::Byte(24));
    assert_eq!(place(b"glTF\x01\0\0\0\0\0\0\0"), Place::Byte(4));
}

#[test]
fn a_required_extension_that_may_move_joints_is_refused_by_its_name() {
    let asks = |names: &str| with("{}", &format!(", \"extensionsRequired\": [{names}]"));
    for name in [
        "EXT_meshopt_compression",
        "KHR_meshopt_compression",
        "KHR_animation_pointer",
        "ACME_bones",
    ] {
        let text = asks(&format!("\"KHR_texture_transform\", \"{name}\""));
        let error = gltf::read(text.as_bytes()).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::UnknownExtension);
        assert_eq!(error.place.to_string(), "extensionsRequired[1]");
        assert!(error.found.contains(name), "{error}");
    }
    for name in [
        "KHR_draco_mesh_compression",
        "KHR_mesh_quantization",
        "KHR_materials_unlit",
        "KHR_texture_basisu",
        "EXT_texture_webp",
    ] {
        let import = gltf::read(asks(&format!("\"{name}\"")).as_bytes());
        assert!(import.is_ok(), "{name}");
    }
    let used = with("{}", ", \"extensionsUsed\": [\"ACME_bones\"]");
    assert!(gltf::read(used.as_bytes()).is_ok());
}

#[test]
fn what_is_no_gltf_is_refused() {
    let cases: [(&[u8], ReadErrorKind); 8] = [
        (b"", ReadErrorKind::Empty),
        (b"HIERARCHY", ReadErrorKind::Unexpected),
        (b"\x00\x01", ReadErrorKind::NotText),
        (b"{}", ReadErrorKind::Unexpected),
        (
            b"{\"asset\": {\"version\": \"1.0\"}}",
            ReadErrorKind::Unexpected,
        ),
        (b"glTF", ReadErrorKind::Unexpected),
        (b"glTF\x01\0\0\0\0\0\0\0", ReadErrorKind::Unexpected),
        (
            b"glTF\x02\0\0\0\0\0\0\0\x01\0\0\0BIN\0x",
            ReadErrorKind::Unexpected,
        ),
    ];
    for (bytes, kind) in cases {
        let error = gltf::read(bytes).unwrap_err();
        assert_eq!(error.kind, kind, "{error}");
    }
}

#[test]
fn every_liberty_is_a_warning() {
    let cases = [
        (
            r#"{"name": "a", "rotation": [0, 0, 2, 0]}"#,
            &["rotation-not-unit"][..],
        ),
        (
            r#"{"name": "a", "rotation": [0, 0, 0, 0]}"#,
            &["rotation-not-unit"],
        ),
        (r#"{"name": "a", "scale": [2, 2, 2]}"#, &["node-scale"]),
        (r#"{"name": "a", "scale": [1, 2, 1]}"#, &["uneven-scale"]),
        (r#"{"name": "a", "scale": [-1, -1, -1]}"#, &["node-scale"]),
        (r#"{"name": "a", "scale": [0, 0, 0]}"#, &["uneven-scale"]),
        (r#"{"name": "a", "scale": [-1, 1, 1]}"#, &["uneven-scale"]),
        (
            r#"{"name": "a", "matrix": [0,0,0,0, 0,0,0,0, 0,0,0,0, 1,2,3,1]}"#,
            &["uneven-scale"],
        ),
        (
            r#"{"name": "a", "matrix": [1,0,0,0, 1,1,0,0, 0,0,1,0, 1,2,3,1]}"#,
            &["uneven-scale"],
        ),
        (r#"{"name": "a"}, {}"#, &["unnamed-node", "several-roots"]),
    ];
    for (nodes, wanted) in cases {
        let import = read(nodes, "");
        assert_eq!(codes(&import), wanted, "{nodes}");
    }
    let import = read(
        r#"{"name": "a"}, {"name": "b"}"#,
        r#", "skins": [{"joints": [0]}, {"joints": [0, 1]}]"#,
    );
    assert_eq!(codes(&import), ["other-skin"]);
    assert_eq!(import.document.skeleton.joint_count(), 1);
}

#[test]
fn scales_of_all_kinds_leave_the_rest_pose_where_it_is() {
    let nodes = r#"
        {"name": "a", "scale": [1, 2, 3], "rotation": [0.6, 0, 0, 0.8], "children": [1]},
        {"name": "b", "translation": [1, 1, 1], "scale": [2, 2, 2], "children": [2]},
        {"name": "c", "translation": [0, 1, 0]}"#;
    let skeleton = read(nodes, "").document.skeleton;
    let pose = posekit::pose::LocalPose::rest(&skeleton).to_global(&skeleton);
    // A quaternion of 0.6 and 0.8: cosine 0.28, sine 0.96 about X.
    let turned = |v: Vec3| Vec3::new(v.x, 0.28 * v.y - 0.96 * v.z, 0.96 * v.y + 0.28 * v.z);
    let b = turned(Vec3::new(1.0, 2.0, 3.0));
    let c = turned(Vec3::new(1.0, 2.0 + 2.0 * 2.0, 3.0));
    assert!(
        pose.positions[1].distance(b) < 1e-6,
        "{}",
        pose.positions[1]
    );
    assert!(
        pose.positions[2].distance(c) < 1e-6,
        "{}",
        pose.positions[2]
    );
}

#[test]
fn the_scene_that_is_shown_first_is_the_skeleton_where_there_is_no_skin() {
    let nodes = r#"{"name": "lamp"}, {"name": "hip", "children": [2]}, {"name": "knee"}"#;
    let scene = r#", "scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [1]}]"#;
    let skeleton = read(nodes, scene).document.skeleton;
    let names: Vec<&str> = skeleton
        .joints()
        .map(|joint| skeleton.name(joint))
        .collect();
    assert_eq!(names, ["hip", "knee"]);
}

/// An animation of node 0 whose keys are in one buffer of three times and three vectors.
fn animated(buffer: &str, accessors: &str) -> String {
    format!(
        r#", "animations": [{{"samplers": [{{"input": 0, "output": 1}}],
        "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "translation"}}}}]}}],
        "accessors": [{accessors}],
        "bufferViews": [{{"buffer": 0, "byteLength": 12}}, {{"buffer": 0, "byteOffset": 12, "byteLength": 36}}],
        "buffers": [{{"byteLength": 48, "uri": "{buffer}"}}]"#
    )
}

const ACCESSORS: &str = r#"
    {"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 3},
    {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 3}"#;

fn numbers(times: [f32; 3]) -> Vec<u8> {
    let places = (0_u8..9).map(f32::from);
    times
        .into_iter()
        .chain(places)
        .flat_map(f32::to_le_bytes)
        .collect()
}

#[test]
fn buffers_beside_the_file_are_asked_for_by_name() {
    let text = with(r#"{"name": "a"}"#, &animated("a%20walk.bin", ACCESSORS));
    let mut asked = Vec::new();
    let import = gltf::read_with(text.as_bytes(), |name| {
        asked.push(name.to_owned());
        Some(numbers([0.0, 0.5, 1.0]))
    });
    let import = import.unwrap();
    assert_eq!(asked, ["a walk.bin"]);
    assert!(import.report.is_empty(), "{:?}", import.report);
    let animation = &import.document.animations[0];
    assert_eq!(animation.name, "animation 0");
    assert_eq!(
        animation.tracks.sample(0.25).translations[0],
        Vec3::new(1.5, 2.5, 3.5)
    );
    let alone = gltf::read(text.as_bytes()).unwrap();
    assert_eq!(codes(&alone), ["missing-buffer", "unreadable-track"]);
    assert!(alone.document.animations[0].tracks.range_secs().is_none());
}

#[test]
fn channels_that_make_no_sense_are_left_out() {
    let short = ACCESSORS.replace("\"count\": 3}", "\"count\": 4}");
    let huge = ACCESSORS.replace("\"count\": 3}", "\"count\": 4611686018427387905}");
    let whole = ACCESSORS.replace("5126", "5121");
    let unknown = ACCESSORS.replace("5126", "4");
    let scalar = ACCESSORS.replace("VEC3", "SCALAR");
    let ordered = [0.0, 0.5, 1.0];
    let cases = [
        (short.as_str(), ordered),
        (&huge, ordered),
        (&whole, ordered),
        (&unknown, ordered),
        (&scalar, ordered),
        (ACCESSORS, [0.0, 0.5, 0.5]),
        (ACCESSORS, [0.0, f32::NAN, 1.0]),
        ("", ordered),
    ];
    // Three times out of nothing are three zeros, which do not rise; the other counts are promises.
    let no_view = [3, 1_u64 << 40].map(|count| {
        let first = r#""bufferView": 0, "#;
        let counted = format!("\"count\": {count}}},");
        ACCESSORS
            .replace(first, "")
            .replace("\"count\": 3},", &counted)
    });
    let cases = cases.into_iter();
    let cases = cases.chain(
        no_view
            .iter()
            .map(|accessors| (accessors.as_str(), ordered)),
    );
    for (accessors, times) in cases {
        let text = with(r#"{"name": "a"}"#, &animated("b.bin", accessors));
        let import = gltf::read_with(text.as_bytes(), |_| Some(numbers(times))).unwrap();
        assert_eq!(codes(&import), ["unreadable-track"], "{accessors}");
        let warning = &import.report.warnings[0];
        let place = Place::Json("animations[0].channels[0]".into());
        assert_eq!(warning.place, place, "{warning}");
    }
}

/// The accessors, the first of them with one sparse time.
fn sparse(count: u64, index_type: u32, index_offset: u64, value_offset: u64) -> String {
    let said = format!(
        r#""count": 3, "sparse": {{"count": {count},
        "indices": {{"bufferView": 1, "byteOffset": {index_offset}, "componentType": {index_type}}},
        "values": {{"bufferView": 1, "byteOffset": {value_offset}}}}}}},"#
    );
    ACCESSORS.replacen("\"count\": 3},", &said, 1)
}

#[test]
fn sparse_accessors_that_make_no_sense_are_left_out() {
    let mut bytes = numbers([0.0, 0.5, 1.0]);
    // The second view: the indices 2, 1 and 9, then the value 4.
    bytes[12..20].copy_from_slice(&[2, 1, 9, 0, 0, 0, 0x80, 0x40]);
    let read = |accessors: &str| {
        let text = with(r#"{"name": "a"}"#, &animated("b.bin", accessors));
        gltf::read_with(text.as_bytes(), |_| Some(bytes.clone())).unwrap()
    };
    let import = read(&sparse(1, 5121, 0, 4));
    assert!(import.report.is_empty(), "{:?}", import.report);
    let range = import.document.animations[0].tracks.range_secs();
    assert_eq!(range, Some([0.0, 4.0]));
    for (wrong, why) in [
        (sparse(2, 5121, 0, 4), "do not rise"),
        (sparse(1, 5121, 2, 4), "beyond its 3 elements"),
        (sparse(1, 5126, 0, 4), "component type"),
        (sparse(1 << 60, 5125, 0, 4), "beyond their buffer"),
        (sparse(1, 5121, u64::MAX, 4), "beyond their buffer"),
        (sparse(1, 5121, 0, 36), "beyond their buffer"),
    ] {
        let import = read(&wrong);
        assert_eq!(codes(&import), ["unreadable-track"], "{wrong}");
        let warning = import.report.warnings[0].to_string();
        assert!(warning.contains(why), "{warning}");
    }
}

#[test]
fn only_what_is_wanted_is_read_and_told_of() {
    let animation = |name: &str| {
        format!(
            r#"{{"name": "{name}", "samplers": [{{"input": 0, "output": 1}}],
            "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "scale"}}}}]}}"#
        )
    };
    let text = with(
        r#"{"name": "a"}"#,
        &format!(", \"animations\": [{}, {}]", animation("x"), animation("y")),
    );
    let read = |wanted| gltf::read_wanted(text.as_bytes(), wanted, |_| None);
    let places = |wanted| {
        let report = read(wanted).unwrap().report;
        let places = report.warnings.iter().map(|w| w.place.to_string());
        places.collect::<Vec<_>>()
    };
    let [first, second] = [0, 1].map(|index| format!("animations[{index}].channels[0]"));
    assert_eq!(places(Wanted::All), [first.clone(), second.clone()]);
    assert_eq!(places(Wanted::First), [first]);
    assert_eq!(places(Wanted::Named("y")), [second]);
    assert!(places(Wanted::Skeleton).is_empty());
    let error = read(Wanted::Named("z")).unwrap_err();
    assert_eq!(error.kind, ReadErrorKind::UnknownName);
    assert_eq!(
        error.to_string(),
        "animations: expected an animation `z`, found `x`, `y`"
    );
}

#[test]
fn many_animations_of_many_joints_are_too_many() {
    let nodes = vec![r#"{"name": "n"}"#; 3000].join(",");
    let animations = vec![r#"{"channels": [], "samplers": []}"#; 3000].join(",");
    let error = refused(&nodes, &format!(", \"animations\": [{animations}]"));
    assert_eq!(error.kind, ReadErrorKind::LimitExceeded);
}
