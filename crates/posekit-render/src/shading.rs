//! How light becomes colour: the one shading model that both back ends follow.
//!
//! The CPU back end calls these functions; the shader in `gpu/shader.wgsl` says the same in WGSL.
//! Lit surfaces are shaded in linear light with a wrapped Lambert key light, an unshadowed fill
//! light, a hemisphere of sky and bounce light, a broad highlight and a faint rim. Lamps add plain
//! Lambert light that falls with the square of the distance; where there are any the sum is exposed and
//! tone-mapped ([`tone`]). The ground's pattern is mixed in encoded sRGB, where even steps look even.

use glam::Vec3;

use crate::color::Color;
use crate::scene::{Lamp, Lighting};

/// Taps of the shadow filter.
pub(crate) const SHADOW_TAPS: usize = 32;

/// Taps evenly spread over the unit disc: Vogel's sunflower spiral (Vogel 1979).
pub(crate) fn shadow_disc() -> [(f32, f32); SHADOW_TAPS] {
    const GOLDEN_ANGLE: f32 = 2.399_963_2;
    std::array::from_fn(|i| {
        let radius = ((i as f32 + 0.5) / SHADOW_TAPS as f32).sqrt();
        let (sin, cos) = libm::sincosf(i as f32 * GOLDEN_ANGLE);
        (cos * radius, sin * radius)
    })
}

/// How much a shadow darkens red, green and blue of the ground: it keeps a little of the sky's blue.
pub(crate) const SHADOW_TINT: [f32; 3] = [1.0, 0.96, 0.88];

/// A body part darkens the ground within this many of its radii.
pub(crate) const CONTACT_REACH: f32 = 4.0;

/// How much of the sky a ball hides from a point of the ground, 0..=1, faded to nothing at
/// [`CONTACT_REACH`] radii.
///
/// `offset` goes from the ball's middle to the point. A ball of radius r at distance d hides
/// (r / d)^2 times the cosine of its direction from the zenith (Bunnell 2005, "Dynamic ambient
/// occlusion and indirect lighting", with the ball as the emitter).
#[inline]
pub(crate) fn contact_window(offset: Vec3, radius: f32) -> f32 {
    let d2 = offset.length_squared().max(radius * radius);
    let d = d2.sqrt();
    let hidden = radius * radius * (-offset.y).max(0.0) / (d2 * d);
    let edge = (1.0 - d2 / (radius * radius * CONTACT_REACH * CONTACT_REACH)).max(0.0);
    hidden.min(1.0) * edge * edge
}

/// How far the key light reaches round the edge of the lit half: it softens the line between day
/// and night on a rounded body.
pub(crate) const KEY_WRAP: f32 = 0.15;
/// Strength of the highlight.
pub(crate) const HIGHLIGHT: f32 = 0.10;
/// Strength of the rim: the sky seen at grazing angles.
pub(crate) const RIM: f32 = 0.16;
/// Share of the shadow's softness that is used on bodies, where a wide filter would leak.
pub(crate) const BODY_SOFTNESS: f32 = 0.4;

/// The linear colour of a lit surface.
///
/// `normal`: unit, world. `to_eye`: unit, world. `key_light`: the share of the key light that
/// arrives, 0..=1. `openness`: the share of the sky that is seen, 0..=1.
#[inline]
pub(crate) fn shade(
    albedo: Color,
    normal: Vec3,
    to_eye: Vec3,
    key_light: f32,
    openness: f32,
    lighting: &Lighting,
) -> [f32; 3] {
    let facing = normal.dot(lighting.key_direction);
    let key = ((facing + KEY_WRAP) * (1.0 / (1.0 + KEY_WRAP))).max(0.0) * key_light;
    let fill = normal.dot(lighting.fill_direction).max(0.0);
    let up = normal.y * 0.5 + 0.5;
    let half = (lighting.key_direction + to_eye).normalize_or(normal);
    let glint = normal.dot(half).max(0.0);
    let glint2 = glint * glint;
    let glint4 = glint2 * glint2;
    let glint16 = glint4 * glint4 * glint4 * glint4;
    let highlight = glint16 * glint16 * HIGHLIGHT * key_light * facing.clamp(0.0, 1.0);
    let grazing = 1.0 - normal.dot(to_eye).max(0.0);
    let rim = grazing * grazing * grazing * RIM * up * openness;
    let channel = |albedo: f32, key_c: f32, fill_c: f32, sky: f32, bounce: f32| {
        let ambient = (bounce + (sky - bounce) * up) * openness;
        albedo * (key_c * key + fill_c * fill * openness + ambient) + key_c * highlight + sky * rim
    };
    let Lighting {
        key: k,
        fill: f,
        sky,
        bounce,
        ..
    } = lighting;
    [
        channel(albedo.r, k.r, f.r, sky.r, bounce.r),
        channel(albedo.g, k.g, f.g, sky.g, bounce.g),
        channel(albedo.b, k.b, f.b, sky.b, bounce.b),
    ]
}

/// Nearer to a lamp than this share of its `full_at` it gets no brighter: light stays finite.
pub(crate) const LAMP_CORE: f32 = 0.05;

/// The way from a point to a lamp, unit length, and how strong the lamp is there, before any cosine.
#[inline]
pub(crate) fn lamp_at(lamp: &Lamp, point: Vec3) -> (Vec3, f32) {
    let way = lamp.position - point;
    let d2 = way.length_squared();
    let full2 = lamp.full_at * lamp.full_at;
    let strength = full2 / d2.max(full2 * (LAMP_CORE * LAMP_CORE));
    (way * (1.0 / d2.max(1e-20).sqrt()), strength)
}

/// What lamps add to the linear colour of a lit surface. `first_light`: the share of the first lamp's
/// light that arrives, 0..=1; the others cast no shadow.
pub(crate) fn lamp_shade(
    albedo: Color,
    (point, normal): (Vec3, Vec3),
    to_eye: Vec3,
    first_light: f32,
    lamps: &[Lamp],
) -> [f32; 3] {
    let mut sum = [0.0f32; 3];
    for (index, lamp) in lamps.iter().enumerate() {
        let (direction, strength) = lamp_at(lamp, point);
        let facing = normal.dot(direction).max(0.0);
        let arriving = if index == 0 { first_light } else { 1.0 };
        let diffuse = facing * strength * arriving;
        let half = (direction + to_eye).normalize_or(normal);
        let glint = normal.dot(half).max(0.0);
        let glint2 = glint * glint;
        let glint4 = glint2 * glint2;
        let glint16 = glint4 * glint4 * glint4 * glint4;
        let highlight = glint16 * glint16 * HIGHLIGHT * diffuse;
        let Color { r, g, b } = lamp.color;
        let albedos = [albedo.r, albedo.g, albedo.b];
        for ((sum, color), albedo) in sum.iter_mut().zip([r, g, b]).zip(albedos) {
            *sum += color * (albedo * diffuse + highlight);
        }
    }
    sum
}

/// Up to here light is shown as it is; above, tone mapping begins.
pub(crate) const TONE_KNEE: f32 = 0.75;

/// Tone mapping of one value: itself up to the knee, then a hyperbola that leaves it with the same slope and
/// comes near to 1 under endless light (Reinhard et al. 2002, "Photographic tone reproduction for digital
/// images", its curve x / (1 + x), here only above the knee).
#[inline]
pub(crate) fn tone(value: f32) -> f32 {
    let over = ((value - TONE_KNEE) * (1.0 / (1.0 - TONE_KNEE))).max(0.0);
    value.min(TONE_KNEE) + (1.0 - TONE_KNEE) * over / (1.0 + over)
}

/// Tone mapping of a colour by its brightest part, so that it keeps its hue: what is bright and orange does
/// not turn white.
#[inline]
pub(crate) fn tone_map(linear: [f32; 3]) -> [f32; 3] {
    let brightest = linear[0].max(linear[1]).max(linear[2]);
    let factor = tone(brightest) / brightest.max(1e-6);
    linear.map(|part| part * factor)
}

/// The light of a point of ground under lamps, linear. `ambient` is what it has without them.
pub(crate) fn ground_light(
    point: Vec3,
    ambient: [f32; 3],
    first_light: f32,
    lamps: &[Lamp],
) -> [f32; 3] {
    let mut sum = ambient;
    for (index, lamp) in lamps.iter().enumerate() {
        let (direction, strength) = lamp_at(lamp, point);
        let arriving = if index == 0 { first_light } else { 1.0 };
        let diffuse = direction.y.max(0.0) * strength * arriving;
        let Color { r, g, b } = lamp.color;
        for (sum, color) in sum.iter_mut().zip([r, g, b]) {
            *sum += color * diffuse;
        }
    }
    sum
}

/// Factors of the ground's encoded red, green and blue under an exposed light. `brightness` is the brightest
/// part of the ground's own linear colour. The root stands for the encoding: the ground is mixed in
/// encoded values.
#[inline]
pub(crate) fn ground_factors(light: [f32; 3], brightness: f32) -> [f32; 3] {
    let shown = brightness * light[0].max(light[1]).max(light[2]);
    let factor = tone(shown) / shown.max(1e-6);
    light.map(|part| (part * factor).max(0.0).sqrt())
}

/// What is left of the ground's ambient light in the key light's shadow; squared, as that is measured on
/// encoded values.
#[inline]
pub(crate) fn ambient_in_shadow(ambient: f32, shade: f32) -> [f32; 3] {
    SHADOW_TINT.map(|tint| {
        let left = 1.0 - shade * tint;
        ambient * left * left
    })
}

/// The share of the sky that a body sees at a height above the ground: less close to it, most of
/// all where it faces down. `reach` is the height from which on the ground is not felt.
#[inline]
pub(crate) fn openness_above_ground(height: f32, normal_y: f32, reach: f32) -> f32 {
    let near = 1.0 - (height / reach).clamp(0.0, 1.0);
    1.0 - near * near * (0.45 - 0.25 * normal_y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tone_mapping_keeps_what_is_shown_as_it_is_and_never_reaches_white() {
        for value in [0.0, 0.18, 0.5, TONE_KNEE] {
            assert!((tone(value) - value).abs() < 1e-7, "{value}");
        }
        // No corner at the knee, and always onward.
        let slope = |at: f32| (tone(at + 1e-3) - tone(at)) / 1e-3;
        assert!((slope(TONE_KNEE + 1e-4) - 1.0).abs() < 0.02);
        let mut before = 0.0;
        for step in 1..200_u16 {
            let now = tone(f32::from(step) * 0.05);
            assert!(now > before && now < 1.0, "{step}");
            before = now;
        }
        assert!(tone(1e9) <= 1.0);
    }

    #[test]
    fn tone_mapping_keeps_hues() {
        let [r, g, b] = tone_map([9.0, 4.5, 0.9]);
        assert!(r < 1.0 && (g / r - 0.5).abs() < 1e-5 && (b / r - 0.1).abs() < 1e-5);
        assert_eq!(tone_map([0.0; 3]), [0.0; 3]);
    }

    /// The ground without lamps, in the room's own light, is nearly as the theme has it.
    #[test]
    fn the_ground_in_its_own_light_has_its_own_colour() {
        for brightness in [0.05, 0.5, 0.91] {
            let factors = ground_factors([1.0; 3], brightness);
            for factor in factors {
                assert!((0.96..=1.0).contains(&factor), "{brightness}: {factor}");
            }
        }
    }
}
