//! The looks: colours of the room, the lights and the characters.

use glam::Vec3;

use crate::color::Color;
use crate::mesh::MATERIAL_COUNT;
use crate::scene::{Background, Lighting};
use crate::stage::GhostSide;

/// The colours of everything but the characters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theme {
    /// Behind everything, at the top of the picture.
    pub background_top: Color,
    /// Behind everything, at the bottom.
    pub background_bottom: Color,
    /// The floor near the character.
    pub ground: Color,
    /// Grid lines.
    pub grid_line: Color,
    /// The grid lines through the origin: along X, along Z.
    pub axis_lines: [Color; 2],
    /// Captions and labels.
    pub text: Color,
    /// The brightness of all lights, 1 for the light theme.
    pub exposure: f32,
}

impl Theme {
    /// The light theme: the default.
    #[must_use]
    pub fn light() -> Self {
        Self {
            background_top: Color::from_hex(0xE9_ED_F2),
            background_bottom: Color::from_hex(0xD3_DA_E2),
            ground: Color::from_hex(0xF4_F6_F8),
            grid_line: Color::from_hex(0xC3_CB_D5),
            axis_lines: [Color::from_hex(0xD9_8A_86), Color::from_hex(0x86_A3_D6)],
            text: Color::from_hex(0x3A_43_4F),
            exposure: 1.0,
        }
    }

    /// The dark theme.
    #[must_use]
    pub fn dark() -> Self {
        Self {
            background_top: Color::from_hex(0x20_24_2B),
            background_bottom: Color::from_hex(0x2B_30_39),
            ground: Color::from_hex(0x3A_40_4A),
            grid_line: Color::from_hex(0x56_5E_6B),
            axis_lines: [Color::from_hex(0xA6_5A_58), Color::from_hex(0x55_74_B0)],
            text: Color::from_hex(0xD5_DB_E3),
            exposure: 0.82,
        }
    }

    /// The theme's background.
    #[must_use]
    pub fn background(&self) -> Background {
        Background::Gradient {
            top: self.background_top,
            bottom: self.background_bottom,
        }
    }

    /// The lights, for figures of height `scale`, in a room seen from `camera_yaw_rad`: the key
    /// light stands at the viewer's left shoulder, wherever the viewer goes first.
    #[must_use]
    pub fn lighting(&self, scale: f32, camera_yaw_rad: f32) -> Lighting {
        let toward = |yaw: f32, pitch: f32| {
            let (sin_yaw, cos_yaw) = libm::sincosf(camera_yaw_rad + yaw);
            let (sin_pitch, cos_pitch) = libm::sincosf(pitch);
            Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch)
        };
        let light = |hex: u32, strength: f32| Color::from_hex(hex).scaled(strength * self.exposure);
        Lighting {
            key_direction: toward(-0.75, 0.92),
            key: light(0xFF_F4_E6, 0.78),
            fill_direction: toward(1.1, 0.25),
            fill: light(0xDC_E8_FF, 0.20),
            sky: light(0xE6_EE_FA, 0.46),
            bounce: light(0xD8_D2_CA, 0.24),
            shadow_strength: 0.36,
            ground_ambient: 1.0,
            shadow_softness: 0.022 * scale,
            contact_strength: 0.42,
            exposure: 1.0,
        }
    }
}

/// The colours of a character.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CharacterColors {
    /// Trunk and head.
    pub base: Color,
    /// Joint balls, hands and feet.
    pub accent: Color,
    /// Limbs on the left.
    pub left: Color,
    /// Limbs on the right.
    pub right: Color,
}

/// Colours of characters in the order in which they join a scene: `[base, accent, left, right]`.
const CHARACTERS: [[u32; 4]; 6] = [
    [0xE8_E4_DE, 0x3D_47_56, 0xB3_C8_DE, 0xE5_C6_B1],
    [0xF2_A6_5E, 0x5A_3A_26, 0xF5_C1_8C, 0xE0_8A_48],
    [0x6F_A8_DC, 0x24_3B_55, 0x8F_C0_EA, 0x5A_90_C6],
    [0x8C_C0_8A, 0x2B_4A_35, 0xAE_D5_A5, 0x72_A9_76],
    [0xB5_9A_D6, 0x3F_30_57, 0xC9_B5_E3, 0x9E_82_C4],
    [0xE5_8F_9B, 0x57_2B_36, 0xEE_AD_B5, 0xD4_78_86],
];

/// What ghosts of keys before and after the time shown are tinted with: apart from each other, and from
/// the blue and orange of left and right.
const GHOST_TINTS: [u32; 2] = [0x2F_9E_6B, 0xB0_4F_C4];

/// How much of the tint a ghost of a key has.
const GHOST_TINT: f32 = 0.62;

/// How many characters get colours of their own before they repeat.
pub const CHARACTER_COLOR_COUNT: usize = CHARACTERS.len();

impl CharacterColors {
    /// The colours of the `index`th character of a scene.
    #[must_use]
    pub fn of(index: usize) -> Self {
        let [base, accent, left, right] = CHARACTERS[index % CHARACTERS.len()].map(Color::from_hex);
        Self {
            base,
            accent,
            left,
            right,
        }
    }

    /// All colours `amount` of the way towards `other`: for ghosts.
    #[must_use]
    pub fn mixed(self, other: Color, amount: f32) -> Self {
        Self {
            base: self.base.mix(other, amount),
            accent: self.accent.mix(other, amount),
            left: self.left.mix(other, amount),
            right: self.right.mix(other, amount),
        }
    }

    /// The colours of the ghost of a key on one side of the time shown.
    #[must_use]
    pub(crate) fn of_key_ghost(self, side: GhostSide) -> Self {
        let tint = match side {
            GhostSide::Before => GHOST_TINTS[0],
            GhostSide::After => GHOST_TINTS[1],
        };
        self.mixed(Color::from_hex(tint), GHOST_TINT)
    }

    /// One colour for each material of a mesh.
    #[must_use]
    pub fn palette(&self) -> [Color; MATERIAL_COUNT] {
        [
            self.base,
            self.accent,
            self.left,
            self.right,
            AXES[0],
            AXES[1],
            AXES[2],
        ]
    }
}

/// X red, Y green, Z blue, as everybody has them.
const AXES: [Color; 3] = [
    Color {
        r: 0.72,
        g: 0.07,
        b: 0.07,
    },
    Color {
        r: 0.12,
        g: 0.48,
        b: 0.08,
    },
    Color {
        r: 0.06,
        g: 0.20,
        b: 0.75,
    },
];
