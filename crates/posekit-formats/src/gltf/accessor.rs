//! Numbers out of buffers.

use gltf::json::accessor::{Accessor, ComponentType, Type, sparse};
use gltf::json::buffer::View;
use gltf::json::validation::{Checked, USize64};

/// What an accessor is read with: the bytes of the views that it names.
pub(super) struct Source<'a> {
    /// Those of its own view; none where it has no view, and its numbers are zeros.
    pub(super) elements: Option<Viewed<'a>>,
    /// Those of the indices and values of a sparse one.
    pub(super) sparse: Option<[Viewed<'a>; 2]>,
}

/// A view into a buffer.
#[derive(Clone, Copy)]
pub(super) struct Viewed<'a> {
    pub(super) view: &'a View,
    pub(super) buffer: &'a [u8],
}

/// The vectors of an accessor out of its buffers, each of `N` components; numbers of other types than `f32` as
/// the shares of one that they stand for. `Err` says what is wrong with it, for people.
///
/// Nothing is allocated for what the buffers do not hold, but for zeros: an accessor without a view has `most` at most.
pub(super) fn vectors<const N: usize>(
    accessor: &Accessor,
    source: &Source<'_>,
    most: usize,
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
        return Err(format!("its elements do not have {N} numbers"));
    }
    let component = component.0;
    if component != ComponentType::F32 && !accessor.normalized {
        return Err("its numbers are neither floats nor normalized".to_owned());
    }
    let size = N * bytes_of(component);
    let count = index(accessor.count).unwrap_or(usize::MAX);
    let element = |element: &[u8]| {
        let mut numbers = element.chunks_exact(bytes_of(component));
        std::array::from_fn(|_| {
            numbers
                .next()
                .map_or(0.0, |number| decoded(component, number))
        })
    };
    let mut all: Vec<[f32; N]> = match source.elements {
        Some(viewed) => {
            let start = index(accessor.byte_offset.unwrap_or_default());
            let stride = viewed.view.byte_stride.as_ref();
            let stride = stride.map_or(size, |stride| stride.0);
            let bytes = range(viewed, start, count, size, stride);
            let bytes = bytes.ok_or("it goes beyond its buffer")?;
            let chunks = bytes.chunks(stride);
            chunks
                .map(|chunk| element(&chunk[..size.min(chunk.len())]))
                .collect()
        }
        None if count <= most => vec![[0.0; N]; count],
        None => return Err("it has more elements than there can be keys".to_owned()),
    };
    if let Some(said) = &accessor.sparse {
        let views = source.sparse.ok_or("its sparse elements have no buffer")?;
        let places = sparse_places(said, views[0], count)?;
        let start = index(said.values.byte_offset);
        let bytes = range(views[1], start, places.len(), size, size);
        let bytes = bytes.ok_or("its sparse values go beyond their buffer")?;
        for (place, value) in places.into_iter().zip(bytes.chunks_exact(size)) {
            // Places rise and the last one is below the count.
            all[place] = element(value);
        }
    }
    Ok(all)
}

/// Which elements a sparse accessor replaces, in rising order, all of them below `count`.
fn sparse_places(
    said: &sparse::Sparse,
    viewed: Viewed<'_>,
    count: usize,
) -> Result<Vec<usize>, String> {
    let Checked::Valid(component) = &said.indices.component_type else {
        return Err("the component type of its sparse indices is unknown".to_owned());
    };
    let size = bytes_of(component.0);
    let start = index(said.indices.byte_offset);
    let replaced = index(said.count).unwrap_or(usize::MAX);
    let bytes = range(viewed, start, replaced, size, size);
    let bytes = bytes.ok_or("its sparse indices go beyond their buffer")?;
    let mut places: Vec<usize> = Vec::with_capacity(replaced);
    for number in bytes.chunks_exact(size) {
        let mut wide = [0; 4];
        wide[..size].copy_from_slice(number);
        let place = usize::try_from(u32::from_le_bytes(wide)).unwrap_or(usize::MAX);
        if place >= count {
            return Err(format!(
                "its sparse index {place} is beyond its {count} elements"
            ));
        }
        if places.last().is_some_and(|&before| place <= before) {
            return Err("its sparse indices do not rise".to_owned());
        }
        places.push(place);
    }
    Ok(places)
}

fn index(number: USize64) -> Option<usize> {
    usize::try_from(number.0).ok()
}

/// The bytes from an accessor's first element to its last.
fn range(
    Viewed { view, buffer }: Viewed<'_>,
    start: Option<usize>,
    count: usize,
    size: usize,
    stride: usize,
) -> Option<&[u8]> {
    let view_start = index(view.byte_offset.unwrap_or_default())?;
    let view_end = view_start.checked_add(index(view.byte_length)?)?;
    let view_bytes = buffer.get(view_start..view_end)?;
    let start = start?;
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
