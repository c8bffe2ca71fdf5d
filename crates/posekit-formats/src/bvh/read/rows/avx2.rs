//! Plain rows with AVX2, where the machine has it.
//!
//! Two stages over pieces of [`PIECE`] bytes, so that neither waits for the other's branches. The first
//! compares 64 bytes at a time with the blanks and writes down where tokens begin and end (after Langdale
//! and Lemire, "Parsing gigabytes of JSON per second", VLDB Journal 2019). The second, in [`number`],
//! turns four tokens at a time into numbers. Fours that it is not sure of go to the portable parser token
//! by token, and from there to the scanner.
#![allow(
    unsafe_code,
    reason = "vector loads and calls that need AVX2; proved by the test that every parser agrees, \
              tests/it/bvh_parsers_agree.rs, and by the fuzz target bvh_read"
)]

use std::arch::x86_64::*;
use std::mem::MaybeUninit;

#[path = "avx2_number.rs"]
mod number;

use super::super::scan::Comma;
use super::{Rows, portable};

/// How many bytes are indexed at once: enough to keep the second stage busy, few enough to stay in the
/// first cache with their index and values.
const PIECE: usize = 2048;

/// How many bytes are classified together.
const BLOCK: usize = 64;

/// How many bytes before and after a piece may be loaded: a token's 16 before its end.
const MARGIN: usize = 16;

/// After a piece that led nowhere, this many tokens go by before indexing is tried again, so that a file
/// full of odd tokens costs little more than without.
const PATIENCE: u32 = 64;

/// See [`super::read_plain`].
pub(super) fn read_plain(
    rows: &mut Rows,
    bytes: &[u8],
    pos: usize,
    limit: usize,
    comma: Comma,
) -> usize {
    // A decimal comma is rare enough for the portable parser.
    let is_fit = comma != Comma::Decimal && pos >= MARGIN && is_detected();
    if !is_fit || pos >= limit {
        return pos;
    }
    if rows.patience > 0 {
        rows.patience -= 1;
        return pos;
    }
    // SAFETY: `is_detected` found every feature that `walk` enables.
    let stopped = unsafe { walk(rows, bytes, pos, limit) };
    if stopped - pos < PIECE / 4 {
        rows.patience = PATIENCE;
    }
    stopped
}

fn is_detected() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("popcnt")
}

/// Where tokens and lines of a piece are, as offsets from its first byte.
struct Index {
    /// Begin, end, begin, end and so on; room for a block more, which is written in steps.
    bounds: [u16; PIECE + BLOCK],
    bound_count: usize,
    /// Line ends: where, and how many bounds are before it.
    lines: [(u16, u16); PIECE],
    line_count: usize,
    /// Whether an `e` stands anywhere.
    has_exponents: bool,
    /// How many bytes were indexed; fewer than asked when a lone CR stands in the next block.
    length: usize,
}

/// Reads piece after piece.
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn walk(rows: &mut Rows, bytes: &[u8], mut pos: usize, limit: usize) -> usize {
    let mut index = Index {
        bounds: [0; PIECE + BLOCK],
        bound_count: 0,
        lines: [(0, 0); PIECE],
        line_count: 0,
        has_exponents: false,
        length: 0,
    };
    while pos < limit {
        // One byte more than the blocks: what follows a CR at a block's end is looked at.
        let length = (bytes.len() - pos).saturating_sub(1).min(PIECE) / BLOCK * BLOCK;
        fill(&mut index, &bytes[pos..], length);
        rows.reserve(index.bound_count / 2, bytes.len() - pos);
        let converted = if index.has_exponents {
            convert::<true>(rows, bytes, pos, &index)
        } else {
            convert::<false>(rows, bytes, pos, &index)
        };
        rows.note_range();
        match converted {
            Ok(next) if next > pos => pos = next,
            Ok(stopped) | Err(stopped) => return stopped,
        }
    }
    pos
}

/// Finds the bounds of tokens and lines in the first `length` bytes, a multiple of [`BLOCK`]; the byte
/// before them counts as a blank.
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn fill(index: &mut Index, bytes: &[u8], length: usize) {
    index.bound_count = 0;
    index.line_count = 0;
    index.length = length;
    index.has_exponents = false;
    let mut before = 1_u64;
    for base in (0..length).step_by(BLOCK) {
        let block: &[u8; BLOCK] = match bytes[base..].first_chunk() {
            Some(block) => block,
            None => break,
        };
        let masks = classify(block);
        let follows_block = u64::from(bytes[base + BLOCK] == b'\n') << 63;
        if masks.returns & !(masks.lines >> 1 | follows_block) != 0 {
            index.length = base;
            return;
        }
        index.has_exponents |= masks.has_letters;
        let bounds = masks.blanks ^ (masks.blanks << 1 | before);
        before = masks.blanks >> 63;
        let mut lines = masks.lines;
        while lines != 0 {
            let at = lines.trailing_zeros();
            let bounds_before = (bounds & ((1_u64 << at) | ((1_u64 << at) - 1))).count_ones();
            index.lines[index.line_count] = (
                narrow(base + at as usize),
                narrow(index.bound_count + bounds_before as usize),
            );
            index.line_count += 1;
            lines &= lines - 1;
        }
        let count = bounds.count_ones() as usize;
        let mut bounds = bounds;
        for step in (0..count).step_by(8) {
            let from = index.bound_count + step;
            let out: &mut [u16] = &mut index.bounds[from..from + 8];
            for place in out {
                *place = narrow(base + bounds.trailing_zeros() as usize);
                bounds &= bounds.wrapping_sub(1);
            }
        }
        index.bound_count += count;
    }
}

/// An offset within a piece.
#[inline(always)]
fn narrow(offset: usize) -> u16 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a piece is shorter than 2^16 bytes"
    )]
    let narrow = offset as u16;
    narrow
}

/// One bit per byte of a block.
struct Masks {
    /// Blanks, tabs, CR and LF.
    blanks: u64,
    /// LF.
    lines: u64,
    /// CR.
    returns: u64,
    /// Whether an `e` stands in the block.
    has_letters: bool,
}

#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn classify(block: &[u8; BLOCK]) -> Masks {
    // A byte is a blank when the table, looked up by its low four bits, gives the byte itself. The other
    // entries have wrong low bits, and bytes from 0x80 on look up a zero.
    const TABLE: [i8; 32] = {
        let mut table = [1; 32];
        let mut half = 0;
        while half < 32 {
            table[half + 1] = 0;
            table[half] = b' '.cast_signed();
            table[half + 9] = b'\t'.cast_signed();
            table[half + 10] = b'\n'.cast_signed();
            table[half + 13] = b'\r'.cast_signed();
            half += 16;
        }
        table
    };
    // SAFETY: the block has 64 bytes and the table 32.
    let (low, high, table) = unsafe {
        (
            _mm256_loadu_si256(block.as_ptr().cast()),
            _mm256_loadu_si256(block.as_ptr().add(32).cast()),
            _mm256_loadu_si256(TABLE.as_ptr().cast()),
        )
    };
    let blanks = [low, high].map(|half| _mm256_cmpeq_epi8(_mm256_shuffle_epi8(table, half), half));
    let lines =
        [low, high].map(|half| _mm256_cmpeq_epi8(half, _mm256_set1_epi8(b'\n'.cast_signed())));
    let returns =
        [low, high].map(|half| _mm256_cmpeq_epi8(half, _mm256_set1_epi8(b'\r'.cast_signed())));
    let letters = [low, high].map(|half| {
        let lower = _mm256_or_si256(half, _mm256_set1_epi8(0x20));
        _mm256_cmpeq_epi8(lower, _mm256_set1_epi8(b'e'.cast_signed()))
    });
    let any_letter = _mm256_or_si256(letters[0], letters[1]);
    let has_letters = _mm256_testz_si256(any_letter, any_letter) == 0;
    Masks {
        blanks: bits(blanks),
        lines: bits(lines),
        returns: bits(returns),
        has_letters,
    }
}

/// The high bits of 64 bytes.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn bits([low, high]: [__m256i; 2]) -> u64 {
    let low = _mm256_movemask_epi8(low).cast_unsigned();
    let high = _mm256_movemask_epi8(high).cast_unsigned();
    u64::from(low) | u64::from(high) << 32
}

/// Converts the tokens of a piece. Gives where the next piece begins, or, as an error, where a token is
/// not plain.
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn convert<const EXPONENTS: bool>(
    rows: &mut Rows,
    bytes: &[u8],
    base: usize,
    index: &Index,
) -> Result<usize, usize> {
    let bounds = &index.bounds[..index.bound_count];
    let mut from = 0;
    for &(line_at, bounds_before) in &index.lines[..index.line_count] {
        let to = usize::from(bounds_before);
        convert_tokens::<EXPONENTS>(rows, bytes, base, &bounds[from..to])?;
        rows.end_line(base + usize::from(line_at));
        from = to;
    }
    let rest = &bounds[from..];
    convert_tokens::<EXPONENTS>(rows, bytes, base, rest)?;
    // A token that the piece cuts begins the next one.
    match rest.last() {
        Some(&begin) if rest.len() % 2 == 1 => Ok(base + usize::from(begin)),
        _ if index.length == 0 => Err(base),
        _ => Ok(base + index.length),
    }
}

/// Converts the tokens between pairs of bounds; fails with the position of one that is not plain.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn convert_tokens<const EXPONENTS: bool>(
    rows: &mut Rows,
    bytes: &[u8],
    base: usize,
    bounds: &[u16],
) -> Result<(), usize> {
    let (mut fours, rest) = bounds.as_chunks::<2>().0.as_chunks::<4>();
    loop {
        let length = rows.values.len();
        let room = rows.values.spare_capacity_mut().as_chunks_mut::<4>().0;
        let done = convert_fours::<EXPONENTS>(room, bytes, base, fours);
        // SAFETY: the first `done` fours of the room were written, one after the other.
        unsafe { rows.values.set_len(length + 4 * done) };
        match fours[done..].split_first() {
            Some((tokens, others)) => {
                convert_singly(rows, bytes, base, tokens)?;
                fours = others;
            }
            None => break,
        }
    }
    let Some(last) = rest.last() else {
        return Ok(());
    };
    let mut padded = [[*last; 4]];
    padded[0][..rest.len()].copy_from_slice(rest);
    let mut values = [[MaybeUninit::uninit(); 4]];
    if convert_fours::<EXPONENTS>(&mut values, bytes, base, &padded) == 1 {
        // SAFETY: its one four was written.
        let values = values[0].map(|value| unsafe { value.assume_init() });
        rows.values.extend_from_slice(&values[..rest.len()]);
        return Ok(());
    }
    convert_singly(rows, bytes, base, rest)
}

/// Converts tokens four by four into as much room, up to the first four that are not plain, and says how many fours
/// that were.
#[inline(never)]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn convert_fours<const EXPONENTS: bool>(
    room: &mut [[MaybeUninit<f64>; 4]],
    bytes: &[u8],
    base: usize,
    fours: &[[[u16; 2]; 4]],
) -> usize {
    let mut done = 0;
    for (tokens, place) in fours.iter().zip(room) {
        // Called from here alone, so that it is built in.
        let Some(four) = number::four::<EXPONENTS>(bytes, base, tokens) else {
            break;
        };
        *place = four.map(MaybeUninit::new);
        done += 1;
    }
    done
}

/// As [`convert_tokens`], by the portable parser.
#[cold]
fn convert_singly(
    rows: &mut Rows,
    bytes: &[u8],
    base: usize,
    tokens: &[[u16; 2]],
) -> Result<(), usize> {
    for token in tokens {
        let [begin, end] = token.map(|offset| base + usize::from(offset));
        match portable::number(bytes, begin, Comma::Unknown) {
            Some((value, stopped)) if stopped == end => rows.values.push(value),
            _ => return Err(begin),
        }
    }
    Ok(())
}
