//! Limits: what is projected where.

use core::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec3};
use posekit::ik::{Interval, JointLimit, JointLimitError, JointLimits};
use posekit::rotation::{EulerOrder, angle_between, exp};
use posekit::skeleton::JointId;
use proptest::prelude::*;

use crate::figures::any_rotation;

fn near(a: DQuat, b: DQuat) -> bool {
    angle_between(a, b) < 1e-9
}

#[test]
fn a_hinge_keeps_its_axis_and_its_range() {
    let hinge = JointLimit::Hinge {
        axis: DVec3::Z,
        angle_rad: Interval::new(0.0, 2.5),
    };
    let at = |angle: f64| exp(DVec3::Z * angle);
    assert!(near(hinge.project(at(1.0)), at(1.0)));
    assert!(near(hinge.project(at(-0.4)), at(0.0)));
    assert!(near(hinge.project(at(2.9)), at(2.5)));
    // Beyond half a turn the other end is nearer: -3.0 is 0.78 past 2.5 and 3.0 short of 0.
    assert!(near(hinge.project(at(-3.0)), at(2.5)));
    assert!(near(hinge.project(exp(DVec3::X * 0.7) * at(1.0)), at(1.0)));
    assert!(hinge.allows(at(1.0), 1e-12) && !hinge.allows(exp(DVec3::X * 0.1), 1e-3));
}

#[test]
fn a_cone_clamps_swing_and_twist_apart() {
    let cone = JointLimit::Cone {
        axis: DVec3::Y,
        swing_max_rad: 0.6,
        twist_rad: Interval::symmetric(0.3),
    };
    let motion = |swing: f64, twist: f64| exp(DVec3::X * swing) * exp(DVec3::Y * twist);
    for (swing, twist) in [(0.5, 0.2), (1.5, 0.2), (0.5, 1.0), (-2.0, -2.0)] {
        let expected = motion(f64::clamp(swing, -0.6, 0.6), f64::clamp(twist, -0.3, 0.3));
        assert!(
            near(cone.project(motion(swing, twist)), expected),
            "{swing} {twist}"
        );
    }
}

#[test]
fn euler_ranges_clamp_each_angle() {
    let ranges = [
        Interval::symmetric(0.5),
        Interval::new(0.0, 1.0),
        Interval::ALL,
    ];
    let limit = JointLimit::Euler {
        order: EulerOrder::ZXY,
        angles_rad: ranges,
    };
    let order = EulerOrder::ZXY;
    let given = limit.project(order.to_quat([0.9, -0.2, 2.0]));
    assert!(near(given, order.to_quat([0.5, 0.0, 2.0])));
}

/// Angles within wide ranges make a motion that other angles make as well, and those may lie nearer to the middle of
/// the ranges: it is within all the same.
#[test]
fn euler_angles_within_their_ranges_stay() {
    let order = EulerOrder::ZXY;
    let limit = JointLimit::Euler {
        order,
        angles_rad: [
            Interval::symmetric(2.7),
            Interval::symmetric(1.4),
            Interval::symmetric(1.7),
        ],
    };
    let steps = |most: f64| (0..9).map(move |i| most * (f64::from(i) / 4.0 - 1.0));
    for a in steps(2.7) {
        for b in steps(1.4) {
            for c in steps(1.7) {
                let motion = order.to_quat([a, b, c]);
                assert!(near(limit.project(motion), motion), "{a} {b} {c}");
            }
        }
    }
    // A range across half a turn, and a motion within it told the other way round: to the bit.
    let hinge = JointLimit::Hinge {
        axis: DVec3::Z,
        angle_rad: Interval::new(2.5, 5.0),
    };
    let motion = exp(DVec3::Z * -2.0);
    assert_eq!(hinge.project(motion), motion);
}

#[test]
fn tables_refuse_what_makes_no_sense() {
    let mut limits = JointLimits::default();
    let joint = JointId::new(3);
    assert!(limits.is_free());
    let no_axis = JointLimit::Hinge {
        axis: DVec3::ZERO,
        angle_rad: Interval::ALL,
    };
    let refused = limits.set_limit(joint, no_axis).unwrap_err();
    assert_eq!(refused, JointLimitError::NoDirection { axis: DVec3::ZERO });
    let empty = JointLimit::Slide {
        axis: DVec3::X,
        distance: Interval::new(1.0, 0.0),
    };
    assert!(matches!(
        limits.set_limit(joint, empty),
        Err(JointLimitError::EmptyRange { .. })
    ));
    assert!(
        limits.set_stiffness(joint, 1.5).is_err() && limits.set_stiffness(joint, f64::NAN).is_err()
    );
    let cone = JointLimit::Cone {
        axis: DVec3::X * 3.0,
        swing_max_rad: 4.0,
        twist_rad: Interval::ALL,
    };
    assert!(matches!(
        limits.set_limit(joint, cone),
        Err(JointLimitError::Swing { .. })
    ));
    assert!(limits.is_free(), "a refusal changes nothing");
    let scaled = JointLimit::Hinge {
        axis: DVec3::X * 3.0,
        angle_rad: Interval::symmetric(FRAC_PI_2),
    };
    limits.set_limit(joint, scaled).unwrap();
    let JointLimit::Hinge { axis, .. } = limits.limit(joint) else {
        panic!("a hinge");
    };
    assert_eq!(axis, DVec3::X);
    assert_eq!(limits.limit(JointId::new(99)), JointLimit::Free);
}

proptest! {
    /// Projecting puts a motion within the limits, and once is enough.
    #[test]
    fn projecting_twice_is_projecting_once(
        motion in any_rotation(),
        min in -PI..PI,
        length in 0.0..5.0_f64,
        swing_max_rad in 0.0..PI,
    ) {
        let motion = motion.as_dquat().normalize();
        let range = Interval::new(min, min + length);
        let limits = [
            JointLimit::Hinge { axis: DVec3::new(0.6, 0.0, 0.8), angle_rad: range },
            JointLimit::Cone { axis: DVec3::new(0.0, 0.6, 0.8), swing_max_rad, twist_rad: range },
            JointLimit::Euler { order: EulerOrder::ZXY, angles_rad: [Interval::symmetric(swing_max_rad), Interval::new(-0.4, 0.9), range] },
        ];
        for limit in limits {
            let once = limit.project(motion);
            prop_assert!(angle_between(limit.project(once), once) < 1e-7, "{:?}", limit);
            prop_assert!(limit.allows(once, 1e-7));
        }
    }
}
