//! The thresholds of the checks, and why they are what they are.

/// Rotations that change less than this from frame to frame are never jumps or spikes, in degrees.
/// Captured clips at 30 frames a second snap toes and wrists by up to 35 degrees when they land.
pub const BREAK_ANGLE_DEG: f64 = 20.0;

/// A joint that turns slower than this is not suspicious whatever its neighbours do, in degrees per
/// second. Landing feet reach 1,000 and throwing wrists 3,000 for an instant. A spike that comes back may
/// be slower, down to [`BREAK_ANGLE_DEG`] a frame, if it stands out twice as much.
pub const BREAK_SPEED_DEG_PER_SEC: f64 = 1500.0;

/// The most that [`BREAK_SPEED_DEG_PER_SEC`] may ask for in one frame, in degrees: at 15 frames a
/// second it would otherwise never be reached.
pub const BREAK_ANGLE_MAX_DEG: f64 = 60.0;

/// The figure never teleports over less than this share of its height: a hand's breadth.
pub const BREAK_DISTANCE_HEIGHTS: f64 = 0.05;

/// How many times a step must exceed the median of the steps around it, plus three times their
/// median absolute deviation (scaled to a standard deviation), to be a break.
pub const BREAK_FACTOR: f64 = 2.0;

/// How many times a step must exceed each of the two steps beside it. Fast but smooth motion ramps
/// up and down over some frames; a break does not.
pub const BREAK_CONTRAST: f64 = 2.5;

/// A break that is taken back within so many frames is a spike; a longer one is two jumps.
pub const SPIKE_FRAMES_MAX: usize = 3;

/// Channels that change less than this from frame to frame do not flip, in degrees. Real joints
/// stay below it at 30 frames a second.
pub const FLIP_ANGLE_DEG: f64 = 60.0;

/// A pair of frames is a flip when other angles of the very same rotation are nearer by this factor.
pub const FLIP_GAIN: f64 = 2.0;

/// Channels race near gimbal lock when they move this many times farther than the joint turns.
pub const GIMBAL_FACTOR: f64 = 4.0;

/// Identical frames are a freeze when they last at least this long, in seconds; shorter ones do
/// not catch the eye.
pub const FREEZE_SECS: f64 = 0.1;

/// ... and are at least so many steps without a change.
pub const FREEZE_STEPS_MIN: usize = 3;

/// Single repeated frames are reported from this share of all frames on. 24 frames a second shown
/// at 30 repeat every fifth frame; a stray one in a thousand means nothing.
pub const DUPLICATE_SHARE: f64 = 0.02;

/// Frame times outside this range are not believed, in seconds: from 1,000 frames a second to 5.
pub const FRAME_TIME_RANGE_SECS: (f64, f64) = (0.001, 0.2);

/// A playback speed is doubted when gravity or gait say that it is wrong by this factor.
/// Wrong factors are 2 or 4 in practice, and the measurements are good to 25 per cent.
pub const PLAYBACK_FACTOR: f64 = 1.6;

/// The floor is reported when it is farther from the height 0 than this share of the figure's
/// height: files that were put on the floor by hand are that good.
pub const FLOOR_OFFSET_HEIGHTS: f64 = 0.1;

/// How far a foot may go through the floor, as a share of the figure's height: 4 cm of a grown-up.
/// Toes are modelled as stiff, so their ends dip by up to 2 per cent when clean walks push off.
pub const PENETRATION_HEIGHTS: f64 = 0.025;

/// A floor that is measured above the height 0 by less than this, as a share of the figure's height,
/// is the sole's thickness: feet are below the floor only below 0 then.
pub const SOLE_HEIGHTS: f64 = 0.06;

/// A foot joint is on the floor when it is this close to its lowest usual height, as a share of
/// the figure's height.
pub const CONTACT_HEIGHT_HEIGHTS: f64 = 0.02;

/// A foot is planted when it moves slower than this, in heights per second. While no foot is that
/// slow, the low one that is slowest carries the figure, however fast it slides.
pub const CONTACT_ENTER_SPEED: f64 = 0.25;

/// A planted foot stays so until it moves faster than this, in heights per second: half the speed
/// of a slow walk, so a sliding foot still counts as planted and a swinging one does not.
pub const CONTACT_LEAVE_SPEED: f64 = 0.5;

/// A foot that carries the figure while it slides rises or sinks slower than this, in heights per
/// second: feet that land or leave are faster.
pub const CONTACT_VERTICAL_SPEED: f64 = 0.15;

/// Contacts shorter than this are not looked at, in seconds: a foot that passes the floor.
pub const CONTACT_SECS_MIN: f64 = 0.1;

/// How far a planted foot may slide, as a share of the figure's height: 7 cm of a grown-up.
pub const SLIDE_HEIGHTS: f64 = 0.04;

/// A slide is faster than this, in heights per second; feet that shuffle while standing are not.
pub const SLIDE_SPEED: f64 = 0.06;

/// How much a bone may change, as a share of its median length.
pub const BONE_CHANGE: f64 = 0.01;

/// ... and as a share of the figure's height, so that tiny bones do not report rounding.
pub const BONE_CHANGE_HEIGHTS: f64 = 0.001;

/// How far the median of a joint's position channels may be from its OFFSET, as a share of the
/// figure's height.
pub const OFFSET_HEIGHTS: f64 = 0.01;

/// How far from its OFFSET the joint that carries the figure may move, as a share of the height.
pub const ROOT_OFFSET_HEIGHTS: f64 = 0.5;

/// How far the bones' steepness in the rest pose may be from that in the motion, in degrees, as the
/// mean over the length of all bones. A T-pose is 20 to 30 degrees from a walk: its arms hang.
pub const REST_POSE_DEG: f64 = 45.0;

/// The thresholds of all checks; the defaults are the constants of the same names.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckConfig {
    /// See [`BREAK_ANGLE_DEG`].
    pub break_angle_deg: f64,
    /// See [`BREAK_SPEED_DEG_PER_SEC`].
    pub break_speed_deg_per_sec: f64,
    /// See [`BREAK_ANGLE_MAX_DEG`].
    pub break_angle_max_deg: f64,
    /// See [`BREAK_DISTANCE_HEIGHTS`].
    pub break_distance_heights: f64,
    /// See [`BREAK_FACTOR`].
    pub break_factor: f64,
    /// See [`BREAK_CONTRAST`].
    pub break_contrast: f64,
    /// See [`SPIKE_FRAMES_MAX`].
    pub spike_frames_max: usize,
    /// See [`FLIP_ANGLE_DEG`].
    pub flip_angle_deg: f64,
    /// See [`FLIP_GAIN`].
    pub flip_gain: f64,
    /// See [`GIMBAL_FACTOR`].
    pub gimbal_factor: f64,
    /// See [`FREEZE_SECS`].
    pub freeze_secs: f64,
    /// See [`FREEZE_STEPS_MIN`].
    pub freeze_steps_min: usize,
    /// See [`DUPLICATE_SHARE`].
    pub duplicate_share: f64,
    /// See [`FRAME_TIME_RANGE_SECS`].
    pub frame_time_range_secs: (f64, f64),
    /// See [`PLAYBACK_FACTOR`].
    pub playback_factor: f64,
    /// See [`FLOOR_OFFSET_HEIGHTS`].
    pub floor_offset_heights: f64,
    /// See [`PENETRATION_HEIGHTS`].
    pub penetration_heights: f64,
    /// See [`SOLE_HEIGHTS`].
    pub sole_heights: f64,
    /// See [`CONTACT_HEIGHT_HEIGHTS`].
    pub contact_height_heights: f64,
    /// See [`CONTACT_ENTER_SPEED`].
    pub contact_enter_speed: f64,
    /// See [`CONTACT_LEAVE_SPEED`].
    pub contact_leave_speed: f64,
    /// See [`CONTACT_VERTICAL_SPEED`].
    pub contact_vertical_speed: f64,
    /// See [`CONTACT_SECS_MIN`].
    pub contact_secs_min: f64,
    /// See [`SLIDE_HEIGHTS`].
    pub slide_heights: f64,
    /// See [`SLIDE_SPEED`].
    pub slide_speed: f64,
    /// See [`BONE_CHANGE`].
    pub bone_change: f64,
    /// See [`BONE_CHANGE_HEIGHTS`].
    pub bone_change_heights: f64,
    /// See [`OFFSET_HEIGHTS`].
    pub offset_heights: f64,
    /// See [`ROOT_OFFSET_HEIGHTS`].
    pub root_offset_heights: f64,
    /// See [`REST_POSE_DEG`].
    pub rest_pose_deg: f64,
}

impl Default for CheckConfig {
    fn default() -> Self {
        Self {
            break_angle_deg: BREAK_ANGLE_DEG,
            break_speed_deg_per_sec: BREAK_SPEED_DEG_PER_SEC,
            break_angle_max_deg: BREAK_ANGLE_MAX_DEG,
            break_distance_heights: BREAK_DISTANCE_HEIGHTS,
            break_factor: BREAK_FACTOR,
            break_contrast: BREAK_CONTRAST,
            spike_frames_max: SPIKE_FRAMES_MAX,
            flip_angle_deg: FLIP_ANGLE_DEG,
            flip_gain: FLIP_GAIN,
            gimbal_factor: GIMBAL_FACTOR,
            freeze_secs: FREEZE_SECS,
            freeze_steps_min: FREEZE_STEPS_MIN,
            duplicate_share: DUPLICATE_SHARE,
            frame_time_range_secs: FRAME_TIME_RANGE_SECS,
            playback_factor: PLAYBACK_FACTOR,
            floor_offset_heights: FLOOR_OFFSET_HEIGHTS,
            penetration_heights: PENETRATION_HEIGHTS,
            sole_heights: SOLE_HEIGHTS,
            contact_height_heights: CONTACT_HEIGHT_HEIGHTS,
            contact_enter_speed: CONTACT_ENTER_SPEED,
            contact_leave_speed: CONTACT_LEAVE_SPEED,
            contact_vertical_speed: CONTACT_VERTICAL_SPEED,
            contact_secs_min: CONTACT_SECS_MIN,
            slide_heights: SLIDE_HEIGHTS,
            slide_speed: SLIDE_SPEED,
            bone_change: BONE_CHANGE,
            bone_change_heights: BONE_CHANGE_HEIGHTS,
            offset_heights: OFFSET_HEIGHTS,
            root_offset_heights: ROOT_OFFSET_HEIGHTS,
            rest_pose_deg: REST_POSE_DEG,
        }
    }
}
