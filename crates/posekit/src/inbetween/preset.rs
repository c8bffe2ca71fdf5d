//! Orientations that show something about the ways between them.

use std::fmt;

use glam::{DQuat, DVec3};

use super::between::Ends;
use crate::rotation::{EulerOrder, exp};

/// Orientations that show something: two, or a row of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Preset {
    /// A quarter turn about Z: the element-wise matrix halves its volume on the way.
    Lecture,
    /// A quarter turn about an axis askew: it skews as well.
    Quarter,
    /// A small turn at the lock of XYZ, about the axis that is lost.
    Gimbal,
    /// A large one.
    GimbalFar,
    /// From one side of the lock of ZXY to the other.
    Zxy,
    /// Nearly half a turn.
    HalfTurn,
    /// Half a turn to the last bit: there are two shortest ways.
    Flip,
    /// Quaternions of opposite sign.
    LongWay,
    /// Half a degree.
    Near,
    /// Five keys that go round corners.
    Keys,
    /// Five keys evenly spaced on one turn, past the lock of ZXY.
    Swing,
}

impl Preset {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 11] = [
        Self::Lecture,
        Self::Quarter,
        Self::Gimbal,
        Self::GimbalFar,
        Self::Zxy,
        Self::HalfTurn,
        Self::Flip,
        Self::LongWay,
        Self::Near,
        Self::Keys,
        Self::Swing,
    ];

    /// The word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lecture => "lecture",
            Self::Quarter => "quarter",
            Self::Gimbal => "gimbal",
            Self::GimbalFar => "gimbal-far",
            Self::Zxy => "zxy",
            Self::HalfTurn => "half-turn",
            Self::Flip => "flip",
            Self::LongWay => "long-way",
            Self::Near => "near",
            Self::Keys => "keys",
            Self::Swing => "swing",
        }
    }

    /// What it is.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Lecture => "A quarter turn about Z",
            Self::Quarter => "A quarter turn, axis askew",
            Self::Gimbal => "Gimbal lock: 40 degrees",
            Self::GimbalFar => "Gimbal lock: 120 degrees",
            Self::Zxy => "Across the lock of ZXY",
            Self::HalfTurn => "Nearly half a turn",
            Self::Flip => "Half a turn exactly",
            Self::LongWay => "The long way round",
            Self::Near => "Nearly equal",
            Self::Keys => "Five keys round corners",
            Self::Swing => "Five keys past the lock",
        }
    }

    /// What to look for.
    #[must_use]
    pub const fn says(self) -> &'static str {
        match self {
            Self::Lecture => {
                "The element-wise matrix shrinks: half way its determinant is 0.5, its body half as large. \
                 All others turn about Z as slerp does."
            }
            Self::Quarter => {
                "The matrix skews as well as shrinks, the raw quaternion shrinks evenly. Euler angles leave \
                 the way, each order by its own path."
            }
            Self::Gimbal => {
                "At a pitch of 89 degrees X and Z of XYZ turn about nearly one axis, and the turn wanted is \
                 about another: euler:XYZ swings 15 degrees aside and goes at nearly twice the speed. The \
                 other orders have their locks elsewhere."
            }
            Self::GimbalFar => {
                "The same by 120 degrees: the head of euler:XYZ looks 44 degrees aside on the way. Compare the \
                 paths of its tips on the sphere."
            }
            Self::Zxy => {
                "The middle angle of ZXY comes near 90 on the way, and the outer two run a quarter turn each \
                 to go only 30 degrees: the speed of euler:ZXY doubles, slerp's stays level."
            }
            Self::HalfTurn => {
                "The matrix collapses half way and its nearest rotation snaps over: a needle in the speed. \
                 The chord between quaternions (nlerp) hurries through the middle, too."
            }
            Self::Flip => {
                "Two shortest ways, and every method must choose one. Half way the matrix is flat: its \
                 determinant is 0 and no rotation is the nearest."
            }
            Self::LongWay => {
                "The end is the quaternion of a turn of 60 degrees with its sign turned: the same \
                 orientation. Slerp looks at the sign; rawslerp does not and goes 300 degrees round."
            }
            Self::Near => {
                "Half a degree: a straight line is as good as the arc, whatever is interpolated. This is why \
                 many keys hide a poor method."
            }
            Self::Keys => {
                "Over all keys slerp goes straight from key to key and turns a corner at each, so that its \
                 speed steps. Squad goes through them without a corner."
            }
            Self::Swing => {
                "Over all keys: one even turn, keys 30 degrees apart. Slerp and squad do not show the keys; \
                 euler:ZXY jerks at those beside its lock."
            }
        }
    }

    /// The order in which its angles are easiest to read.
    #[must_use]
    pub const fn order(self) -> EulerOrder {
        match self {
            Self::Zxy | Self::Keys | Self::Swing => EulerOrder::ZXY,
            _ => EulerOrder::XYZ,
        }
    }

    /// Its orientations, two at least.
    #[must_use]
    pub fn keys(self) -> Vec<DQuat> {
        // A degree short of the lock the first and the last axis are nearly one, X; Y is the second.
        let pitched = EulerOrder::XYZ.to_quat([0.0, f64::to_radians(89.0), 0.0]);
        let at_the_lock = |angle_deg: f64| vec![pitched, exp(turn(DVec3::Z, angle_deg)) * pitched];
        let askew = |angle_deg: f64| exp(turn(DVec3::new(1.0, 2.0, 2.0) / 3.0, angle_deg));
        let zxy = |angles_deg: [f64; 3]| EulerOrder::ZXY.to_quat(angles_deg.map(f64::to_radians));
        match self {
            Self::Lecture => vec![DQuat::IDENTITY, exp(turn(DVec3::Z, 90.0))],
            Self::Quarter => vec![DQuat::IDENTITY, askew(90.0)],
            Self::Gimbal => at_the_lock(40.0),
            Self::GimbalFar => at_the_lock(120.0),
            Self::Zxy => vec![zxy([0.0, 85.0, 0.0]), zxy([90.0, 60.0, -90.0])],
            Self::HalfTurn => vec![DQuat::IDENTITY, askew(179.0)],
            Self::Flip => vec![DQuat::IDENTITY, DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0)],
            Self::LongWay => vec![DQuat::IDENTITY, -askew(60.0)],
            Self::Near => vec![zxy([20.0, 30.0, 10.0]), zxy([20.0, 30.5, 10.0])],
            Self::Keys => [
                [0.0, 0.0, -80.0],
                [30.0, 0.0, -20.0],
                [0.0, -50.0, 20.0],
                [-40.0, 20.0, 30.0],
                [0.0, 0.0, 90.0],
            ]
            .map(zxy)
            .to_vec(),
            Self::Swing => {
                let middle = zxy([0.0, 85.0, 0.0]);
                let key = |turned_deg: f64| exp(turn(DVec3::Y, turned_deg)) * middle;
                [-60.0, -30.0, 0.0, 30.0, 60.0].map(key).to_vec()
            }
        }
    }

    /// Which of its keys is the start of the two that are looked at first.
    #[must_use]
    pub const fn gap(self) -> usize {
        match self {
            Self::Keys | Self::Swing => 1,
            _ => 0,
        }
    }

    /// The two that are looked at first, with the keys around them.
    #[must_use]
    pub fn ends(self) -> Ends {
        let keys = self.keys();
        let gap = self.gap();
        Ends {
            before: gap.checked_sub(1).map(|before| keys[before]),
            after: keys.get(gap + 2).copied(),
            ..Ends::new(keys[gap], keys[gap + 1])
        }
    }

    /// The one of a name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }
}

fn turn(axis: DVec3, angle_deg: f64) -> DVec3 {
    axis * angle_deg.to_radians()
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
