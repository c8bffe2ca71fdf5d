// The shading model of `shading.rs` and `cpu/floor.rs`, on the GPU.
//
// Everything is shaded in linear light and encoded to sRGB by this shader, so that the pictures of
// both back ends agree and the target can be handed to a toolkit that works in encoded values.

struct Globals {
    clip_from_world: mat4x4<f32>,
    // xyz: the eye; w: 1 for a lens, 0 for parallel rays.
    eye: vec4<f32>,
    // xyz: towards the viewer; w: 1 when the shadow map is seen from a lamp.
    back: vec4<f32>,
    // Shadow map coordinates and depth of a world point, times the fourth row.
    shadow_rows: array<vec4<f32>, 4>,
    // x: texels per world length, y: map depth per world length, z: 1 with a map, w: softness.
    shadow: vec4<f32>,
    // xyz: towards the key light; w: shadow strength.
    key_direction: vec4<f32>,
    // rgb: linear; w: contact strength.
    key: vec4<f32>,
    // w: the number of lamps.
    fill_direction: vec4<f32>,
    // w: the light that the ground has without any lamp.
    fill: vec4<f32>,
    // w: the exposure of light that is added up.
    sky: vec4<f32>,
    // w: 0 for light as the theme has it, 1 for light that is added up, 2 where the first lamp casts the
    // shadow, too.
    bounce: vec4<f32>,
    // Encoded colours. w of `top`: the picture's height in pixels; w of `bottom`: 1 for a target
    // that encodes by itself.
    top: vec4<f32>,
    bottom: vec4<f32>,
    // rgb: encoded; w: radius.
    ground: vec4<f32>,
    // rgb: encoded; w: distance of grid lines.
    line: vec4<f32>,
    // rgb: encoded; w: distance of strong grid lines.
    axis_x: vec4<f32>,
    // rgb: encoded; w: 1 with a ground.
    axis_z: vec4<f32>,
    // xyz: the ground's focus, y its height; w: the brightest part of its linear colour.
    focus: vec4<f32>,
    // The filter's taps, two in each.
    disc: array<vec4<f32>, 16>,
    // Two for each lamp. xyz: its place, w: the square of the distance at which it is at full
    // strength; rgb: linear.
    lamps: array<vec4<f32>, 32>,
}

@group(0) @binding(0) var<uniform> globals: Globals;
@group(0) @binding(1) var palette: texture_2d<f32>;
@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;
@group(1) @binding(2) var text_atlas: texture_2d<f32>;

const PALETTE_WIDTH: u32 = 1024u;
const MATERIAL_COUNT: u32 = 7u;
const MAP_SIZE: f32 = 1024.0;
const MAX_SPREAD: f32 = 30.0;
const KEY_WRAP: f32 = 0.15;
const HIGHLIGHT: f32 = 0.10;
const RIM: f32 = 0.16;
const BODY_SOFTNESS: f32 = 0.4;
const LAMP_CORE: f32 = 0.05;
const TONE_KNEE: f32 = 0.75;
const CONTACT_REACH: f32 = 4.0;
const SHADOW_TINT: vec3<f32> = vec3<f32>(1.0, 0.96, 0.88);

fn palette_texel(index: u32) -> vec4<f32> {
    let at = vec2<i32>(i32(index % PALETTE_WIDTH), i32(index / PALETTE_WIDTH));
    return textureLoad(palette, at, 0);
}

fn encode(linear: vec3<f32>) -> vec3<f32> {
    let clamped = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let low = clamped * 12.92;
    let high = 1.055 * pow(clamped, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, low, clamped <= vec3<f32>(0.0031308));
}

fn decode(encoded: vec3<f32>) -> vec3<f32> {
    let low = encoded / 12.92;
    let high = pow((encoded + 0.055) / 1.055, vec3<f32>(2.4));
    return select(high, low, encoded <= vec3<f32>(0.04045));
}

// What an encoded colour must be written as.
fn to_target(encoded: vec3<f32>) -> vec3<f32> {
    if (globals.bottom.w > 0.5) {
        return decode(encoded);
    }
    return encoded;
}

struct ModelVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // The joint times 256 plus the material.
    @location(2) joint_and_material: u32,
    // Where the instance's colours and transforms start in the palette.
    @location(3) palette_start: u32,
    // x: opacity, y: 1 for one that receives shadows.
    @location(4) look: vec2<f32>,
}

struct ModelFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) @interpolate(flat) albedo: vec3<f32>,
    @location(3) @interpolate(flat) look: vec2<f32>,
}

fn joint_rows(in: ModelVertex) -> array<vec4<f32>, 3> {
    let first = in.palette_start + MATERIAL_COUNT + (in.joint_and_material >> 8u) * 3u;
    return array<vec4<f32>, 3>(
        palette_texel(first),
        palette_texel(first + 1u),
        palette_texel(first + 2u),
    );
}

@vertex
fn model_vertex(in: ModelVertex) -> ModelFragment {
    let rows = joint_rows(in);
    let local = vec4<f32>(in.position, 1.0);
    var out: ModelFragment;
    out.world = vec3<f32>(dot(rows[0], local), dot(rows[1], local), dot(rows[2], local));
    // Normals go by the cofactors: under a scale they turn the other way than the surface.
    out.normal = vec3<f32>(
        dot(cross(rows[1].xyz, rows[2].xyz), in.normal),
        dot(cross(rows[2].xyz, rows[0].xyz), in.normal),
        dot(cross(rows[0].xyz, rows[1].xyz), in.normal),
    );
    out.clip = globals.clip_from_world * vec4<f32>(out.world, 1.0);
    out.albedo = palette_texel(in.palette_start + (in.joint_and_material & 255u)).rgb;
    out.look = in.look;
    return out;
}

fn shadow_point(world: vec3<f32>) -> vec4<f32> {
    let p = vec4<f32>(world, 1.0);
    return vec4<f32>(
        dot(globals.shadow_rows[0], p),
        dot(globals.shadow_rows[1], p),
        dot(globals.shadow_rows[2], p),
        dot(globals.shadow_rows[3], p),
    );
}

@vertex
fn shadow_vertex(in: ModelVertex) -> @builtin(position) vec4<f32> {
    let rows = joint_rows(in);
    let local = vec4<f32>(in.position, 1.0);
    let world = vec3<f32>(dot(rows[0], local), dot(rows[1], local), dot(rows[2], local));
    let p = shadow_point(world);
    return vec4<f32>(p.x * 2.0 - p.w, p.w - p.y * 2.0, p.z, p.w);
}

// The share of the light that casts the shadow that reaches a point; see `ShadowMap::light_at`.
fn light_at(world: vec3<f32>, radius: f32, bias: f32) -> f32 {
    let q = shadow_point(world);
    let distance = max(q.w, 1e-20);
    let p = q.xy / distance;
    let inside = q.w > 0.0 && all(p > vec2<f32>(0.0)) && all(p < vec2<f32>(1.0));
    let nearer = max(distance - bias * globals.back.w, 1e-20);
    let receiver = clamp(q.z / nearer + bias * globals.shadow.y, 0.0, 1.0);
    let spread = min(radius * globals.shadow.x / distance, MAX_SPREAD) / MAP_SIZE;
    var lit = 0.0;
    for (var i = 0; i < 16; i++) {
        let taps = globals.disc[i] * spread;
        lit += textureSampleCompareLevel(shadow_map, shadow_sampler, p + taps.xy, receiver);
        lit += textureSampleCompareLevel(shadow_map, shadow_sampler, p + taps.zw, receiver);
    }
    return select(1.0, lit / 32.0, inside && globals.shadow.z > 0.5);
}

fn brightest(color: vec3<f32>) -> f32 {
    return max(max(color.r, color.g), color.b);
}

// See `tone` of the CPU.
fn tone(value: f32) -> f32 {
    let over = max((value - TONE_KNEE) / (1.0 - TONE_KNEE), 0.0);
    return min(value, TONE_KNEE) + (1.0 - TONE_KNEE) * over / (1.0 + over);
}

// See `tone_map`.
fn tone_map(linear: vec3<f32>) -> vec3<f32> {
    let most = brightest(linear);
    return linear * (tone(most) / max(most, 1e-6));
}

// The way from a point to a lamp, and how strong the lamp is there; see `lamp_at`.
fn lamp_at(index: i32, world: vec3<f32>) -> vec4<f32> {
    let lamp = globals.lamps[2 * index];
    let way = lamp.xyz - world;
    let d2 = dot(way, way);
    let strength = lamp.w / max(d2, lamp.w * (LAMP_CORE * LAMP_CORE));
    return vec4<f32>(way / sqrt(max(d2, 1e-20)), strength);
}

// What lamps add to a lit surface; see `lamp_shade`.
fn lamp_shade(
    albedo: vec3<f32>,
    world: vec3<f32>,
    normal: vec3<f32>,
    to_eye: vec3<f32>,
    first_light: f32,
) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    let count = i32(globals.fill_direction.w);
    for (var i = 0; i < count; i++) {
        let at = lamp_at(i, world);
        let arriving = select(1.0, first_light, i == 0);
        let diffuse = max(dot(normal, at.xyz), 0.0) * at.w * arriving;
        let between = at.xyz + to_eye;
        let half_way = between / max(length(between), 1e-6);
        let highlight = pow(max(dot(normal, half_way), 0.0), 32.0) * HIGHLIGHT * diffuse;
        sum += globals.lamps[2 * i + 1].rgb * (albedo * diffuse + highlight);
    }
    return sum;
}

@fragment
fn model_fragment(in: ModelFragment) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    var to_eye = globals.back.xyz;
    if (globals.eye.w > 0.5) {
        to_eye = normalize(globals.eye.xyz - in.world);
    }
    let softness = globals.shadow.w;
    let radius = softness * BODY_SOFTNESS;
    let shadowed = light_at(in.world + normal * (radius * 1.5), radius, radius * 0.5);
    let facing = dot(normal, globals.key_direction.xyz);
    var facing_shadow = facing;
    let lamp_casts = globals.bounce.w > 1.5;
    if (lamp_casts) {
        facing_shadow = dot(normal, lamp_at(0, in.world).xyz);
    }
    let key_light = select(1.0, shadowed, in.look.y > 0.5 && facing_shadow >= -0.2);
    var openness = 1.0;
    if (globals.axis_z.w > 0.5) {
        let height = in.world.y - globals.focus.y;
        let near = 1.0 - clamp(height / (softness * 16.0), 0.0, 1.0);
        openness = 1.0 - near * near * (0.45 - 0.25 * normal.y);
    }
    let key = max((facing + KEY_WRAP) / (1.0 + KEY_WRAP), 0.0) * key_light;
    let fill = max(dot(normal, globals.fill_direction.xyz), 0.0);
    let up = normal.y * 0.5 + 0.5;
    let half_way = normalize(globals.key_direction.xyz + to_eye);
    let glint = pow(max(dot(normal, half_way), 0.0), 32.0);
    let highlight = glint * HIGHLIGHT * key_light * clamp(facing, 0.0, 1.0);
    let grazing = 1.0 - max(dot(normal, to_eye), 0.0);
    let rim = grazing * grazing * grazing * RIM * up * openness;
    let ambient = mix(globals.bounce.rgb, globals.sky.rgb, up) * openness;
    let light = globals.key.rgb * key + globals.fill.rgb * (fill * openness) + ambient;
    var linear = in.albedo * light + globals.key.rgb * highlight + globals.sky.rgb * rim;
    if (globals.bounce.w > 0.5) {
        let first_light = select(1.0, key_light, lamp_casts);
        linear += lamp_shade(in.albedo, in.world, normal, to_eye, first_light);
        linear = tone_map(linear * globals.sky.w);
    }
    return vec4<f32>(to_target(encode(linear)), in.look.x);
}

// --- The background and the ground -------------------------------------------------------------

fn background_at(pixel_y: f32) -> vec3<f32> {
    return mix(globals.top.rgb, globals.bottom.rgb, pixel_y / globals.top.w);
}

@vertex
fn background_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    // One triangle over the whole picture, at the far end of reversed depth.
    let x = f32(index & 1u) * 4.0 - 1.0;
    let y = f32(index >> 1u) * 4.0 - 1.0;
    return vec4<f32>(x, y, 0.0, 1.0);
}

@fragment
fn background_fragment(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(to_target(background_at(at.y)), 1.0);
}

struct GroundFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec2<f32>,
}

@vertex
fn ground_vertex(@builtin(vertex_index) index: u32) -> GroundFragment {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    var out: GroundFragment;
    out.world = globals.focus.xz + corner * globals.ground.w;
    out.clip = globals.clip_from_world * vec4<f32>(out.world.x, globals.focus.y, out.world.y, 1.0);
    return out;
}

fn ground_fade(world: vec2<f32>) -> f32 {
    let distance = length(world - globals.focus.xz) / globals.ground.w;
    let t = clamp((1.0 - distance) / 0.85, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

fn grid_line(value: f32, span: f32, spacing: f32, half_width: f32) -> f32 {
    let cells = value / spacing;
    let nearest = abs(cells - round(cells)) * spacing;
    let coverage = clamp(half_width + 0.5 - nearest / span, 0.0, 1.0);
    let sparse = clamp((spacing / span - 4.0) / 12.0, 0.0, 1.0);
    return coverage * sparse;
}

// Factors of the ground's encoded colour where light is added up, and a share of the light that casts the
// shadow arrives; see `LitGround` of the CPU.
fn ground_factors(world: vec3<f32>, shadowed: f32) -> vec3<f32> {
    var sum = vec3<f32>(globals.fill.w);
    var first_light = shadowed;
    if (globals.bounce.w < 1.5) {
        let left = 1.0 - (1.0 - shadowed) * globals.key_direction.w * SHADOW_TINT;
        sum *= left * left;
        first_light = 1.0;
    }
    let count = i32(globals.fill_direction.w);
    for (var i = 0; i < count; i++) {
        let at = lamp_at(i, world);
        let arriving = select(1.0, first_light, i == 0);
        sum += globals.lamps[2 * i + 1].rgb * (max(at.y, 0.0) * at.w * arriving);
    }
    let light = sum * globals.sky.w;
    let shown = globals.focus.w * brightest(light);
    return sqrt(max(light * (tone(shown) / max(shown, 1e-6)), vec3<f32>(0.0)));
}

@fragment
fn ground_fragment(in: GroundFragment) -> @location(0) vec4<f32> {
    let dx = dpdx(in.world);
    let dy = dpdy(in.world);
    let span = sqrt(dx * dx + dy * dy);
    let fade = ground_fade(in.world);
    let minor = max(
        grid_line(in.world.x, span.x, globals.line.w, 0.5),
        grid_line(in.world.y, span.y, globals.line.w, 0.5),
    ) * 0.55;
    let major = max(
        grid_line(in.world.x, span.x, globals.axis_x.w, 0.75),
        grid_line(in.world.y, span.y, globals.axis_x.w, 0.75),
    );
    var color = mix(globals.ground.rgb, globals.line.rgb, max(minor, major));
    let along_x = clamp(1.6 - abs(in.world.y) / span.y, 0.0, 1.0) * 0.8;
    let along_z = clamp(1.6 - abs(in.world.x) / span.x, 0.0, 1.0) * 0.8;
    color = mix(color, globals.axis_x.rgb, along_x);
    color = mix(color, globals.axis_z.rgb, along_z);
    let softness = globals.shadow.w;
    let world = vec3<f32>(in.world.x, globals.focus.y, in.world.y);
    let first_light = light_at(world, softness, softness * 0.1);
    var shade = (1.0 - first_light) * globals.key_direction.w * fade;
    if (globals.bounce.w > 0.5) {
        color = min(color * ground_factors(world, first_light), vec3<f32>(1.0));
        shade = 0.0;
    }
    color = mix(background_at(in.clip.y), color, fade);
    return vec4<f32>(to_target(color * (1.0 - shade * SHADOW_TINT)), 1.0);
}

// The dark under a ball near the ground: multiplied onto it.

struct ContactFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec2<f32>,
    @location(1) @interpolate(flat) ball: vec4<f32>,
}

@vertex
fn contact_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) ball: vec4<f32>,
) -> ContactFragment {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    var out: ContactFragment;
    out.ball = ball;
    out.world = ball.xz + corner * (ball.w * CONTACT_REACH);
    out.clip = globals.clip_from_world * vec4<f32>(out.world.x, globals.focus.y, out.world.y, 1.0);
    return out;
}

@fragment
fn contact_fragment(in: ContactFragment) -> @location(0) vec4<f32> {
    let radius = in.ball.w;
    let offset = vec3<f32>(in.world.x, globals.focus.y, in.world.y) - in.ball.xyz;
    let d2 = max(dot(offset, offset), radius * radius);
    let hidden = radius * radius * max(-offset.y, 0.0) / (d2 * sqrt(d2));
    let edge = max(1.0 - d2 / (radius * radius * CONTACT_REACH * CONTACT_REACH), 0.0);
    let dark = min(hidden, 1.0) * edge * edge * globals.key.w * ground_fade(in.world);
    // On a target that encodes by itself the factor acts on linear light.
    let factor = select(1.0 - dark, pow(1.0 - dark, 2.2), globals.bottom.w > 0.5);
    return vec4<f32>(vec3<f32>(factor), 1.0);
}

// --- Lines and text ----------------------------------------------------------------------------

struct LineFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) color: vec4<f32>,
}

@vertex
fn line_vertex(@location(0) position: vec3<f32>, @location(1) color: vec4<f32>) -> LineFragment {
    var out: LineFragment;
    out.clip = globals.clip_from_world * vec4<f32>(position, 1.0);
    out.color = color;
    return out;
}

@fragment
fn line_fragment(in: LineFragment) -> @location(0) vec4<f32> {
    return vec4<f32>(to_target(encode(in.color.rgb)), in.color.a);
}

struct TextFragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) texel: vec2<f32>,
}

@vertex
fn text_vertex(@location(0) clip: vec2<f32>, @location(1) texel: vec2<f32>) -> TextFragment {
    var out: TextFragment;
    out.clip = vec4<f32>(clip, 1.0, 1.0);
    out.texel = texel;
    return out;
}

@fragment
fn text_fragment(in: TextFragment) -> @location(0) vec4<f32> {
    let texel = textureLoad(text_atlas, vec2<i32>(floor(in.texel)), 0);
    if (texel.a <= 0.0) {
        return vec4<f32>(0.0);
    }
    let straight = to_target(min(texel.rgb / texel.a, vec3<f32>(1.0)));
    return vec4<f32>(straight * texel.a, texel.a);
}
