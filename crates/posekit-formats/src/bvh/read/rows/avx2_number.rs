//! Four plain tokens into four numbers, with AVX2.
//!
//! A token's last 16 bytes are loaded, so that its digits stand right-aligned, two tokens to a register.
//! A shuffle takes the point out, and the digits are added up pair by pair (after Muła,
//! "SIMD-ized conversion of strings to integers", 2014), with no branch on where the point is or how many digits there
//! are. Both halves of 16 digits become doubles without error, and so does their sum up to 2^53, so that
//! the one division by an exact power of ten rounds once; see [`exact`](super::super::exact).

use std::arch::x86_64::*;

use super::super::exact::POWERS_OF_TEN;

/// How many bytes of a token are looked at.
const WIDTH: usize = 16;

/// The numbers that tokens say, given as begin and end from `base` on; `None` when one of them is not
/// short and plain. With `EXPONENTS` tokens may end in `e-` and two digits, as C writes small numbers, and
/// nothing branches on whether they do: exponents stand here and there, and every wrong guess costs more
/// than two tokens.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
pub(super) fn four<const EXPONENTS: bool>(
    bytes: &[u8],
    base: usize,
    tokens: &[[u16; 2]; 4],
) -> Option<[f64; 4]> {
    let mut ends = tokens.map(|[_, end]| base + usize::from(end));
    let mut exponents = [0; 4];
    if EXPONENTS {
        let tails = Tails::of(last_bytes(bytes, ends)?)?;
        exponents = tails.exponents;
        for (end, length) in ends.iter_mut().zip(tails.lengths) {
            *end -= length as usize;
        }
    }
    let texts = last_bytes(bytes, ends)?;
    let mut is_negative = [0; 4];
    let mut lengths = [0; 4];
    let mut longest = 0;
    for at in 0..4 {
        let begin = base + usize::from(tokens[at][0]);
        is_negative[at] = usize::from(*bytes.get(begin)? == b'-');
        lengths[at] = ends[at].wrapping_sub(begin + is_negative[at]);
        longest |= lengths[at].wrapping_sub(1);
    }
    if longest >= WIDTH {
        return None;
    }
    let even = Pair::of([texts[0], texts[2]], [lengths[0], lengths[2]]);
    let odd = Pair::of([texts[1], texts[3]], [lengths[1], lengths[3]]);
    // Each token's first eight digits and its last eight, token after token.
    let eights = _mm256_madd_epi16(
        _mm256_packus_epi32(even.fours, odd.fours),
        _mm256_set1_epi32(0x0001_2710),
    );
    let is_large = _mm256_cmpgt_epi32(eights, _mm256_set1_epi64x(MOST_EIGHTS));
    let is_odd = _mm256_or_si256(_mm256_or_si256(even.is_odd, odd.is_odd), is_large);
    if (_mm256_testz_si256(is_odd, is_odd) == 0) | (even.more_points | odd.more_points != 0) {
        return None;
    }
    let places = [even.places[0], odd.places[0], even.places[1], odd.places[1]];
    let mut divisors = [0.0; 4];
    let mut largest_scale = 0;
    for at in 0..4 {
        divisors[at] = if EXPONENTS {
            let scale = (WIDTH - 1 - places[at].min(WIDTH - 1)) + exponents[at] as usize;
            largest_scale = largest_scale.max(scale);
            BY_SCALE[is_negative[at]][scale & 31]
        } else {
            BY_PLACE[is_negative[at]][places[at]]
        };
    }
    if largest_scale >= POWERS_OF_TEN.len() {
        return None;
    }
    Some(divide(eights, divisors))
}

/// Of tokens in halves of eight digits, the fractions.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn divide(eights: __m256i, divisors: [f64; 4]) -> [f64; 4] {
    // An integer below 2^52 in the bits of the double 2^52 is their sum.
    let two_52 = _mm256_set1_pd(4_503_599_627_370_496.0);
    let bits = _mm256_castpd_si256(two_52);
    let high = _mm256_and_si256(eights, _mm256_set1_epi64x(0xffff_ffff));
    let low = _mm256_srli_epi64(eights, 32);
    let [high, low] = [high, low]
        .map(|half| _mm256_sub_pd(_mm256_castsi256_pd(_mm256_or_si256(half, bits)), two_52));
    let digits = _mm256_add_pd(_mm256_mul_pd(high, _mm256_set1_pd(1e8)), low);
    let [a, b, c, d] = divisors;
    let mut values = [0.0; 4];
    // SAFETY: there is room for four values.
    unsafe {
        _mm256_storeu_pd(
            values.as_mut_ptr(),
            _mm256_div_pd(digits, _mm256_setr_pd(a, b, c, d)),
        );
    }
    values
}

/// The bytes before each end.
#[inline(always)]
fn last_bytes(bytes: &[u8], [a, b, c, d]: [usize; 4]) -> Option<[&[u8; WIDTH]; 4]> {
    let last = |end: usize| bytes.get(..end)?.last_chunk();
    Some([last(a)?, last(b)?, last(c)?, last(d)?])
}

/// Two tokens side by side.
struct Pair {
    /// Their digits in groups of four.
    fours: __m256i,
    /// The lane of each one's point, 16 where there is none.
    places: [usize; 2],
    /// Lanes in which neither a digit nor a point stands; also that of a point with no digits.
    is_odd: __m256i,
    /// Not zero if one has two points.
    more_points: u32,
}

impl Pair {
    /// Two tokens that end with these texts; the lengths are 1 to 16.
    #[inline]
    #[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
    fn of(texts: [&[u8; WIDTH]; 2], lengths: [usize; 2]) -> Self {
        let text = load(texts);
        let inside = load(lengths.map(|length| &LAST_LANES[length & 31]));
        let digits = _mm256_sub_epi8(text, _mm256_set1_epi8(b'0'.cast_signed()));
        let is_digit = _mm256_cmpeq_epi8(_mm256_min_epu8(digits, _mm256_set1_epi8(9)), digits);
        // A point may stand in the last lane if the token has the lane before as well.
        let may_be_point = _mm256_shuffle_epi8(inside, load([&NOT_ALONE, &NOT_ALONE]));
        let is_point = _mm256_cmpeq_epi8(text, _mm256_set1_epi8(b'.'.cast_signed()));
        let is_point = _mm256_and_si256(is_point, may_be_point);
        let is_odd = _mm256_andnot_si256(_mm256_or_si256(is_digit, is_point), inside);
        let points = _mm256_movemask_epi8(is_point).cast_unsigned();
        let [first, second] = [points & 0xffff, points >> 16];
        let places = [first, second].map(|points| (points | 0x1_0000).trailing_zeros() as usize);
        let gaps = load(places.map(|place| &CLOSE_GAP[place]));
        let digits = _mm256_shuffle_epi8(_mm256_and_si256(digits, inside), gaps);
        let pairs = _mm256_maddubs_epi16(digits, _mm256_set1_epi16(0x010a));
        Self {
            fours: _mm256_madd_epi16(pairs, _mm256_set1_epi32(0x0001_0064)),
            places,
            is_odd,
            more_points: first & first.wrapping_sub(1) | second & second.wrapping_sub(1),
        }
    }
}

/// Two times 16 bytes.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
fn load([first, second]: [&[u8; WIDTH]; 2]) -> __m256i {
    // SAFETY: both have 16 bytes.
    unsafe {
        let first = _mm_loadu_si128(first.as_ptr().cast());
        let second = _mm_loadu_si128(second.as_ptr().cast());
        _mm256_set_m128i(second, first)
    }
}

/// The exponents of four tokens.
struct Tails {
    /// How long they are: 4, or 0 for none.
    lengths: [u32; 4],
    /// The powers of ten to divide by.
    exponents: [u32; 4],
}

impl Tails {
    /// The exponents that texts end with; `None` when one is not a minus and two digits.
    #[inline]
    #[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
    fn of(texts: [&[u8; WIDTH]; 4]) -> Option<Self> {
        let [a, b, c, d] = texts.map(|&[.., w, x, y, z]| i32::from_le_bytes([w, x, y, z]));
        let words = _mm_setr_epi32(a, b, c, d);
        let letters = _mm_and_si128(
            _mm_or_si128(words, _mm_set1_epi32(0x20)),
            _mm_set1_epi32(0xff),
        );
        let has_exponent = _mm_cmpeq_epi32(letters, _mm_set1_epi32(i32::from(b'e')));
        // Of letter, sign, tens and ones: the letter stays, a minus becomes 0, digits their number.
        let parts = _mm_xor_si128(words, _mm_set1_epi32(0x3030_2d00));
        let is_plain = _mm_cmpeq_epi32(_mm_min_epu8(parts, _mm_set1_epi32(0x0909_00ff)), parts);
        let is_odd = _mm_andnot_si128(is_plain, has_exponent);
        if _mm_testz_si128(is_odd, is_odd) == 0 {
            return None;
        }
        let sums = _mm_maddubs_epi16(parts, _mm_set1_epi32(0x010a_0000));
        let exponents = _mm_and_si128(_mm_srli_epi32(sums, 16), has_exponent);
        let lengths = _mm_and_si128(has_exponent, _mm_set1_epi32(4));
        let mut tails = Self {
            lengths: [0; 4],
            exponents: [0; 4],
        };
        // SAFETY: there is room for four numbers.
        unsafe {
            _mm_storeu_si128(tails.lengths.as_mut_ptr().cast(), lengths);
            _mm_storeu_si128(tails.exponents.as_mut_ptr().cast(), exponents);
        }
        Some(tails)
    }
}

/// What the first eight of 16 digits may be at most, so that all are at most 2^53 whatever the last are,
/// and the last eight, as two 32-bit lanes.
const MOST_EIGHTS: i64 = (i32::MAX as i64) << 32 | 90_071_991;

/// The last n of 16 lanes, for n up to 16; all for n beyond that.
static LAST_LANES: [[u8; WIDTH]; 32] = {
    let mut masks = [[0xff; WIDTH]; 32];
    let mut length = 0;
    while length < WIDTH {
        let mut lane = 0;
        while lane < WIDTH - length {
            masks[length][lane] = 0;
            lane += 1;
        }
        length += 1;
    }
    masks
};

/// The shuffle that gives the last lane what the one before it has.
static NOT_ALONE: [u8; WIDTH] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 14];

/// For a point in each of 16 lanes, and for none: the shuffle that moves the lanes before it one on.
static CLOSE_GAP: [[u8; WIDTH]; WIDTH + 1] = {
    let mut shuffles = [[0; WIDTH]; WIDTH + 1];
    let mut point = 0;
    while point <= WIDTH {
        let mut lane = 0_u8;
        while (lane as usize) < WIDTH {
            let source = if lane as usize > point || point == WIDTH {
                lane
            } else {
                lane.wrapping_sub(1)
            };
            shuffles[point][lane as usize] = source;
            lane += 1;
        }
        point += 1;
    }
    shuffles
};

/// Powers of ten, and their negatives for negative numbers: a quotient's sign is right for zero, too.
static BY_SCALE: [[f64; 32]; 2] = {
    let mut divisors = [[1.0; 32]; 2];
    let mut scale = 0;
    while scale < POWERS_OF_TEN.len() {
        divisors[0][scale] = POWERS_OF_TEN[scale];
        divisors[1][scale] = -POWERS_OF_TEN[scale];
        scale += 1;
    }
    divisors
};

/// The same for a point in each of 16 lanes, and for none.
static BY_PLACE: [[f64; WIDTH + 1]; 2] = {
    let mut divisors = [[1.0; WIDTH + 1], [-1.0; WIDTH + 1]];
    let mut place = 0;
    while place < WIDTH {
        divisors[0][place] = BY_SCALE[0][WIDTH - 1 - place];
        divisors[1][place] = BY_SCALE[1][WIDTH - 1 - place];
        place += 1;
    }
    divisors
};
