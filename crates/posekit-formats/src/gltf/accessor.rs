//! Numbers out of buffers.

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::buffer::View;
use gltf::json::validation::Checked;

/// The vectors of an accessor out of its buffer, each of `N` components; numbers of other types than `f32` as
/// the shares of one that they stand for. `Err` says what is wrong with it, for people.
///
/// Nothing is allocated for what the buffer does not hold.
pub(super) fn vectors<const N: usize>(
    accessor: &Accessor,
    view: &View,
    buffer: &[u8],
) -> Result<Vec<[f32; N]>, String> {
    let Checked::Valid(component) = &accessor.component_type else {
        return Err("its component type is unknown".to_owned());
    };
    let components = match &accessor.type_ {
        Checked::Valid(Type::Scalar) => 1,
        Checked::Valid(Type::Vec2) => 2,
        Checked::Valid(Type::Vec3) => 3,
        Checked::Valid(Type::Vec4) => 4,
        _ => 0,
    };
    if components != N {
        return Err(format!("its elements are not of {N} numbers"));
    }
    if accessor.sparse.is_some() {
        return Err("it is sparse, which is not read".to_owned());
    }
    let component = component.0;
    if component != ComponentType::F32 && !accessor.normalized {
        return Err("its numbers are neither floats nor normalized".to_owned());
    }
    let size = N * bytes_of(component);
    let bytes = range(accessor, view, buffer, size).ok_or("it goes beyond its buffer")?;
    let stride = view.byte_stride.as_ref().map_or(size, |stride| stride.0);
    let element = |element: &[u8]| {
        let mut numbers = element.chunks_exact(bytes_of(component));
        std::array::from_fn(|_| {
            numbers
                .next()
                .map_or(0.0, |number| decoded(component, number))
        })
    };
    Ok(bytes
        .chunks(stride)
        .map(|chunk| element(&chunk[..size.min(chunk.len())]))
        .collect())
}

/// The bytes from an accessor's first element to its last.
fn range<'a>(accessor: &Accessor, view: &View, buffer: &'a [u8], size: usize) -> Option<&'a [u8]> {
    let index = |number: u64| usize::try_from(number).ok();
    let view_start = index(view.byte_offset.map_or(0, |offset| offset.0))?;
    let view_end = view_start.checked_add(index(view.byte_length.0)?)?;
    let view_bytes = buffer.get(view_start..view_end)?;
    let start = index(accessor.byte_offset.map_or(0, |offset| offset.0))?;
    let count = index(accessor.count.0)?;
    let stride = view.byte_stride.as_ref().map_or(size, |stride| stride.0);
    if stride < size {
        return None;
    }
    let Some(before_last) = count.checked_sub(1) else {
        return Some(&[]);
    };
    let length = before_last.checked_mul(stride)?.checked_add(size)?;
    view_bytes.get(start..start.checked_add(length)?)
}

const fn bytes_of(component: ComponentType) -> usize {
    match component {
        ComponentType::I8 | ComponentType::U8 => 1,
        ComponentType::I16 | ComponentType::U16 => 2,
        ComponentType::U32 | ComponentType::F32 => 4,
    }
}

/// A number as section 3.6.2.2 and section 3.11 of the specification say what it stands for.
#[allow(
    clippy::cast_precision_loss,
    reason = "32-bit integers are not what animations are made of"
)]
fn decoded(component: ComponentType, bytes: &[u8]) -> f32 {
    let two = || bytes.first_chunk::<2>().copied().unwrap_or_default();
    let four = || bytes.first_chunk::<4>().copied().unwrap_or_default();
    let one = || bytes.first().copied().unwrap_or_default();
    match component {
        ComponentType::F32 => f32::from_le_bytes(four()),
        ComponentType::I8 => (f32::from(i8::from_le_bytes([one()])) / 127.0).max(-1.0),
        ComponentType::U8 => f32::from(one()) / 255.0,
        ComponentType::I16 => (f32::from(i16::from_le_bytes(two())) / 32767.0).max(-1.0),
        ComponentType::U16 => f32::from(u16::from_le_bytes(two())) / 65535.0,
        ComponentType::U32 => u32::from_le_bytes(four()) as f32 / u32::MAX as f32,
    }
}
