//! What the URDF reader makes of files that can be read, and what it says about the liberties it takes.

use posekit::check::Severity;
use posekit::mechanism::ValueRange;
use posekit_formats::report::{Import, WarningCode};
use posekit_formats::urdf::{self, UpAxis, Urdf, UrdfJointKind, UrdfShape};

fn read(body: &str) -> Import<Urdf> {
    let text = format!("<robot name=\"r\">{body}</robot>");
    urdf::read(text.as_bytes()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A robot of two links and one joint of these words.
fn joint(kind: &str, inside: &str) -> Import<Urdf> {
    read(&format!(
        "<link name='a'/><link name='b'/><joint name='j' type='{kind}'>
         <parent link='a'/><child link='b'/>{inside}</joint>"
    ))
}

fn codes(import: &Import<Urdf>) -> Vec<&'static str> {
    let warnings = import.report.warnings.iter();
    warnings.map(|warning| warning.code.code()).collect()
}

#[test]
fn every_kind_of_joint_is_read() {
    for kind in UrdfJointKind::ALL {
        let import = joint(
            kind.name(),
            "<limit lower='-1' upper='2' effort='3' velocity='4'/>",
        );
        let joint = &import.document.joints[0];
        assert_eq!(joint.kind, kind);
        assert_eq!((joint.parent, joint.child), (0, 1));
        let limit = joint.limit.unwrap();
        assert_eq!((limit.lower, limit.upper), (-1.0, 2.0));
        assert_eq!((limit.effort, limit.velocity), (Some(3.0), Some(4.0)));
        assert!(import.report.is_empty());
        assert_eq!(joint.axis, [1.0, 0.0, 0.0], "the format's default");
    }
}

#[test]
fn numbers_may_stand_on_several_lines_and_have_exponents() {
    let import = joint(
        "continuous",
        "<origin xyz=' 1e-1\n\t+2 -.5 ' rpy='0 0 -3E0'/><axis xyz='0 0 1'/>",
    );
    let joint = &import.document.joints[0];
    assert_eq!(joint.origin.xyz, [0.1, 2.0, -0.5]);
    assert_eq!(joint.origin.rpy, [0.0, 0.0, -3.0]);
    assert!(import.report.is_empty());
}

#[test]
fn entities_and_quotes_are_those_of_xml() {
    let import = read("<link name='a &lt; \"b\" &#x41;'/>");
    assert_eq!(import.document.links[0].name, "a < \"b\" A");
}

#[test]
fn an_axis_of_another_length_is_used_by_its_direction() {
    let import = joint("continuous", "<axis xyz='0 3 4'/>");
    assert_eq!(import.document.joints[0].axis, [0.0, 0.6, 0.8]);
    assert_eq!(codes(&import), ["axis-not-unit"]);
    let rounded = joint("continuous", "<axis xyz='0.7071 0 0.7071'/>");
    assert!(rounded.report.is_empty(), "four digits are unit enough");
    let huge = joint("continuous", "<axis xyz='0 1e300 0'/>");
    assert_eq!(huge.document.joints[0].axis, [0.0, 1.0, 0.0]);
}

#[test]
fn a_missing_or_reversed_limit_is_said() {
    assert_eq!(codes(&joint("revolute", "")), ["missing-joint-limit"]);
    assert!(joint("continuous", "").report.is_empty());
    let import = joint("prismatic", "<limit lower='2' upper='-1'/>");
    assert_eq!(codes(&import), ["reversed-joint-limit"]);
    let limit = import.document.joints[0].limit.unwrap();
    assert_eq!((limit.lower, limit.upper), (-1.0, 2.0));
    // A bound that is not given is zero.
    let import = joint("prismatic", "<limit upper='0.2' effort='1' velocity='1'/>");
    assert_eq!(import.document.joints[0].limit.unwrap().lower, 0.0);
    assert!(import.report.is_empty());
}

/// A robot of three hinges, `j`, `k` and `m`, with these words inside.
fn three([j, k, m]: [&str; 3]) -> Import<Urdf> {
    let hinge = |name: &str, parent: &str, child: &str, inside: &str| {
        format!(
            "<link name='{child}'/>\n<joint name='{name}' type='continuous'><parent link='{parent}'/>\
             <child link='{child}'/>{inside}</joint>"
        )
    };
    let joints = [
        hinge("j", "a", "b", j),
        hinge("k", "b", "c", k),
        hinge("m", "c", "d", m),
    ];
    read(&format!("<link name='a'/>{}", joints.concat()))
}

#[test]
fn a_mimic_that_makes_no_sense_leaves_the_joint_its_own_value() {
    let whole = "<mimic joint='j' multiplier='2'/>";
    for (broken, why) in [
        ("<mimic/>", "mimics no joint by name"),
        ("<mimic joint='x'/>", "mimics `x`, which is not a joint"),
        (
            "<mimic joint='m'/>",
            "mimics itself, directly or through others",
        ),
        (
            "<mimic joint='j' multiplier='twice'/>",
            "mimics `j` with multiplier `twice`",
        ),
        (
            "<mimic joint='j' offset='nan'/>",
            "mimics `j` with offset `nan`",
        ),
    ] {
        let import = three(["", whole, broken]);
        assert_eq!(codes(&import), ["broken-mimic"], "{broken}");
        let text = import.report.warnings[0].to_string();
        assert!(text.contains(&format!("joint `m` {why}")), "{text}");
        assert!(text.contains("it keeps its own value"), "{text}");
        let joints = &import.document.joints;
        assert!(joints[2].mimic.is_none());
        assert!(joints[1].mimic.is_some_and(|mimic| mimic.multiplier == 2.0));
        let robot = import.document.to_robot(urdf::UpAxis::Y).unwrap();
        assert_eq!(robot.value_count(), 2, "j and m");
    }
    let circle = three([
        "<mimic joint='k'/>",
        "<mimic joint='j'/>",
        "<mimic joint='k'/>",
    ]);
    assert_eq!(codes(&circle), ["broken-mimic"; 2]);
    let follows: Vec<_> = circle
        .document
        .joints
        .iter()
        .map(|j| j.mimic.is_some())
        .collect();
    assert_eq!(
        follows,
        [false, false, true],
        "what follows the circle still does"
    );
    let slide =
        "<link name='e'/><joint name='p' type='planar'><parent link='a'/><child link='e'/></joint>";
    let import = read(&format!(
        "<link name='a'/><link name='b'/>{slide}<joint name='j' type='continuous'>\
         <parent link='a'/><child link='b'/><mimic joint='p'/></joint>"
    ));
    assert_eq!(codes(&import), ["broken-mimic"]);
}

#[test]
fn moving_pieces_without_a_mass_are_found() {
    let text = |inertial: &str| {
        let link = |name: &str, inside: &str| format!("<link name='{name}'>{inside}</link>");
        let joint = |name: &str, kind: &str, parent: &str, child: &str| {
            format!(
                "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/></joint>"
            )
        };
        [
            link("a", ""),
            link("b", ""),
            link("c", ""),
            link("d", inertial),
            joint("j", "continuous", "a", "b"),
            joint("k", "continuous", "b", "c"),
            joint("m", "fixed", "c", "d"),
        ]
        .concat()
    };
    let found = |inertial: &str| {
        let import = read(&text(inertial));
        urdf::check(&import.document, &import.report)
    };
    let none = found("");
    assert_eq!(none.len(), 1);
    assert_eq!((none[0].code, none[0].value), ("missing-inertia", 2.0));
    assert!(
        none[0]
            .message
            .contains("2 of 2 moving pieces have no mass (`b`, `c`)")
    );
    // What is fixed to a piece belongs to it.
    let one = found("<inertial><mass value='0.5'/></inertial>");
    assert!(
        one[0]
            .message
            .contains("1 of 2 moving pieces have no mass (`b`)")
    );
    assert_eq!(one[0].joints, ["j"]);
    for senseless in ["0", "-1", "much", "nan", ""] {
        let inertial = format!("<inertial><mass value='{senseless}'/></inertial>");
        assert_eq!(found(&inertial)[0].value, 2.0, "{senseless}");
    }
}

/// Full shapes of the density of water (`make_inertials.py` writes the tensors, too). `MuJoCo` 3.17.0 takes all three files.
#[test]
fn links_of_the_samples_weigh_what_their_shapes_do() {
    for (name, _) in urdf::sample::names() {
        let import = urdf::read(urdf::sample::by_name(name).unwrap().as_bytes()).unwrap();
        assert!(urdf::check(&import.document, &import.report).is_empty());
        for link in &import.document.links {
            let volume = |shape: &UrdfShape| match shape {
                UrdfShape::Box { size: [x, y, z] } => x * y * z,
                UrdfShape::Cylinder { radius, length } => {
                    std::f64::consts::PI * radius * radius * length
                }
                UrdfShape::Sphere { radius } => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
                UrdfShape::Mesh { .. } => panic!("ours have none"),
            };
            let volume: f64 = link
                .visuals
                .iter()
                .map(|visual| volume(&visual.shape))
                .sum();
            let mass = link.mass_kg.unwrap_or(0.0);
            assert!(
                (mass - 1000.0 * volume).abs() < 1e-4 * mass.max(0.1),
                "{name} {}",
                link.name
            );
        }
    }
}

#[test]
fn shapes_and_their_places_are_read() {
    let import = read(
        "<link name='a'>
           <visual name='one'><geometry><box size='1 2 3'/></geometry></visual>
           <visual><origin xyz='0 0 1'/><geometry><cylinder radius='.5' length='2'/></geometry></visual>
           <visual><geometry><sphere radius='4'/></geometry></visual>
           <visual><geometry><mesh filename='package://x/y.stl' scale='1 1 -1'/></geometry></visual>
           <collision><geometry><sphere radius='nonsense'/></geometry></collision>
         </link>",
    );
    let visuals = &import.document.links[0].visuals;
    assert_eq!(visuals.len(), 4);
    assert_eq!(visuals[0].name.as_deref(), Some("one"));
    assert_eq!(
        visuals[0].shape,
        UrdfShape::Box {
            size: [1.0, 2.0, 3.0]
        }
    );
    assert_eq!(visuals[1].origin.xyz, [0.0, 0.0, 1.0]);
    let length = 2.0;
    assert_eq!(
        visuals[1].shape,
        UrdfShape::Cylinder {
            radius: 0.5,
            length
        }
    );
    assert_eq!(visuals[2].shape, UrdfShape::Sphere { radius: 4.0 });
    let mesh = UrdfShape::Mesh {
        filename: "package://x/y.stl".into(),
        scale: [1.0, 1.0, -1.0],
    };
    assert_eq!(visuals[3].shape, mesh);
    assert!(import.report.is_empty());
}

#[test]
fn materials_are_found_by_name_wherever_they_stand() {
    let visual = |material: &str| {
        format!("<visual><geometry><sphere radius='1'/></geometry>{material}</visual>")
    };
    let import = read(&format!(
        "<link name='a'>{}{}{}{}{}</link>
         <material name='red'><color rgba='1 0 0 1'/></material>
         <material name='wood'><texture filename='wood.png'/></material>",
        visual("<material name='red'/>"),
        visual("<material name='wood'/>"),
        visual("<material name='late'/>"),
        visual("<material name='late'><color rgba='0 2 0 0.5'/></material>"),
        visual("<material name='none'/>"),
    ));
    let visuals = &import.document.links[0].visuals;
    assert_eq!(visuals[0].color, Some([1.0, 0.0, 0.0, 1.0]));
    assert_eq!(visuals[1].texture.as_deref(), Some("wood.png"));
    assert_eq!(visuals[2].color, Some([0.0, 1.0, 0.0, 0.5]));
    assert_eq!(visuals[3].color, visuals[2].color);
    assert_eq!(visuals[4].color, None);
    assert_eq!(codes(&import), ["unknown-material"]);
}

#[test]
fn a_shape_that_urdf_does_not_have_is_left_out() {
    let import = read(
        "<link name='a'><visual><geometry><capsule radius='1' length='2'/></geometry></visual>
         <visual><geometry/></visual></link>",
    );
    assert!(import.document.links[0].visuals.is_empty());
    assert_eq!(codes(&import), ["unknown-shape", "unknown-shape"]);
}

#[test]
fn joints_of_transmissions_and_extensions_are_no_joints() {
    let import = read(
        "<link name='a'/><transmission name='t'><joint name='x'/></transmission>
         <gazebo><joint name='y' type='strange'/></gazebo><gazebo reference='a'/>",
    );
    assert!(import.document.joints.is_empty());
    assert!(import.report.is_empty());
}

#[test]
fn comments_declarations_and_a_byte_order_mark_do_no_harm() {
    let text = "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\"?><!-- a --><robot><link name='a'/>
        <!-- <link name='b'/> --></robot><!-- after -->";
    let import = urdf::read(text.as_bytes()).unwrap();
    assert_eq!(import.document.links.len(), 1);
    assert!(import.report.has(WarningCode::ByteOrderMark));
    assert_eq!(import.document.name, "");
}

#[test]
fn children_may_come_before_their_parents() {
    let link = |name: &str| format!("<link name='{name}'/>");
    let joint = |parent: &str, child: &str| {
        format!(
            "<joint name='{parent}{child}' type='fixed'><parent link='{parent}'/>
             <child link='{child}'/></joint>"
        )
    };
    let body = [
        joint("c", "d"),
        link("d"),
        joint("b", "c"),
        link("c"),
        joint("a", "b"),
        link("a"),
        joint("a", "e"),
        link("b"),
        link("e"),
    ]
    .concat();
    let document = read(&body).document;
    assert_eq!(document.links[document.root].name, "a");
    let order: Vec<&str> = document
        .links_from_root()
        .into_iter()
        .map(|link| document.links[link].name.as_str())
        .collect();
    assert_eq!(order, ["a", "b", "c", "d", "e"]);
    let robot = document.to_robot(urdf::UpAxis::Y).unwrap();
    assert_eq!(
        robot.skeleton().depth(robot.skeleton().find("cd").unwrap()),
        3
    );
}

#[test]
fn the_samples_need_no_repair() {
    let mut names = Vec::new();
    for (name, what) in urdf::sample::names() {
        let text = urdf::sample::by_name(name).unwrap();
        let import = urdf::read(text.as_bytes()).unwrap();
        assert!(import.report.is_empty(), "{name}");
        assert_eq!(import.document.name, name);
        assert!(!what.is_empty());
        assert!(
            import
                .document
                .links
                .iter()
                .all(|link| !link.visuals.is_empty())
        );
        names.push(name);
    }
    assert_eq!(names, ["planar2", "arm6", "arm7"]);
    assert_eq!(urdf::sample::by_name("arm8"), None);
}

/// An origin that no robot can be made of is kept and told with its place; bounds that nothing reaches are none.
#[test]
fn origins_and_limits_beyond_the_range() {
    let import = joint(
        "prismatic",
        "<limit lower='-1e16' upper='1e300'/>\n<origin xyz='0 1e39 0'/>",
    );
    assert_eq!(codes(&import), ["value-out-of-range"]);
    assert_eq!(import.report.warnings[0].place.location().unwrap().line, 3);
    let found = urdf::check(&import.document, &import.report);
    let found = found
        .iter()
        .find(|it| it.code == "value-out-of-range")
        .unwrap();
    assert_eq!(found.severity, Severity::Error);
    let error = import.document.to_robot(UpAxis::Y).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("joint 1 `j` has an offset of 1e39"),
        "{error}"
    );

    let import = joint("prismatic", "<limit lower='-1e16' upper='1e300'/>");
    assert_eq!(codes(&import), [""; 0]);
    let robot = import.document.to_robot(UpAxis::Y).unwrap();
    assert_eq!(robot.value_ranges(), [ValueRange::FREE]);
}
