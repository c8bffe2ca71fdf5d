//! The planar arm in closed form.

use glam::DVec2;
use posekit::ik::robot::{TwoLink, TwoLinkSolutions};
use proptest::prelude::*;

const ARM: TwoLink = TwoLink {
    upper: 0.5,
    fore: 0.4,
};

proptest! {
    /// Both solutions reach, their elbows lie on both sides of the line to the target, and one of them is
    /// where the target came from.
    #[test]
    fn both_solutions_reach(t1 in -3.1..3.1_f64, t2 in 0.001..3.1_f64, upper in 0.1..2.0_f64, fore in 0.1..2.0_f64) {
        let arm = TwoLink { upper, fore };
        let target = arm.tip(t1, t2);
        let TwoLinkSolutions::Two([right, left]) = arm.solve(target) else {
            panic!("{:?}", arm.solve(target));
        };
        for [a, b] in [right, left] {
            prop_assert!(arm.tip(a, b).distance(target) < 1e-9);
        }
        prop_assert!((right[1] - t2).abs() < 1e-6 && (left[1] + t2).abs() < 1e-6);
        let aside = |t: [f64; 2]| target.perp_dot(arm.elbow(t[0]));
        prop_assert!(aside(right) <= 0.0 && aside(left) >= 0.0);
        prop_assert!((arm.manipulability(right[1]) - upper * fore * t2.sin()).abs() < 1e-6);
    }
}

#[test]
fn at_the_edges_there_is_one_solution() {
    let TwoLinkSolutions::One([t1, t2]) = ARM.solve(DVec2::new(0.0, 0.9)) else {
        panic!("stretched");
    };
    assert!((t1 - std::f64::consts::FRAC_PI_2).abs() < 1e-12 && t2 == 0.0);
    let TwoLinkSolutions::One([t1, t2]) = ARM.solve(DVec2::new(0.1, 0.0)) else {
        panic!("folded");
    };
    assert!(ARM.tip(t1, t2).distance(DVec2::new(0.1, 0.0)) < 1e-12);
    let equal = TwoLink {
        upper: 0.5,
        fore: 0.5,
    };
    assert_eq!(equal.solve(DVec2::ZERO), TwoLinkSolutions::AnyDirection);
}

#[test]
fn out_of_reach_is_said_with_the_nearest_pose() {
    for (target, by) in [
        (DVec2::new(3.0, 4.0), 4.1),
        (DVec2::new(0.03, -0.04), 0.05),
        (DVec2::new(-2.0, 0.0), 1.1),
    ] {
        let TwoLinkSolutions::OutOfReach { by: said, nearest } = ARM.solve(target) else {
            panic!("{target}");
        };
        assert!((said - by).abs() < 1e-12);
        assert!((ARM.tip(nearest[0], nearest[1]).distance(target) - by).abs() < 1e-12);
    }
    // An upper link that is the shorter one folds the other way.
    let arm = TwoLink {
        upper: 0.4,
        fore: 0.5,
    };
    let target = DVec2::new(0.02, 0.0);
    let TwoLinkSolutions::OutOfReach { by, nearest } = arm.solve(target) else {
        panic!("inside");
    };
    assert!((arm.tip(nearest[0], nearest[1]).distance(target) - by).abs() < 1e-12);
}

#[test]
fn odd_arms_give_finite_answers() {
    for (upper, fore) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)] {
        let arm = TwoLink { upper, fore };
        for target in [DVec2::ZERO, DVec2::X, DVec2::Y * 2.0] {
            match arm.solve(target) {
                TwoLinkSolutions::One(t) | TwoLinkSolutions::OutOfReach { nearest: t, .. } => {
                    assert!(t.iter().all(|angle| angle.is_finite()));
                }
                TwoLinkSolutions::AnyDirection => assert_eq!(target, DVec2::ZERO),
                other => panic!("{other:?}"),
            }
        }
    }
}
