//! Large pages for large arrays.
//!
//! New memory comes from the system page by page, each one cleared when it is first touched. For the values of a large
//! motion, 20,000 pages of 4 KiB, that takes as long as a third of parsing them. Linux gives pages of 2 MiB to programs
//! that ask for them (`madvise`, "transparent huge pages"), as NumPy does for its arrays. Elsewhere, and where the system
//! is set not to, nothing happens.
#![cfg_attr(
    target_os = "linux",
    allow(
        unsafe_code,
        reason = "the call takes an address; it is advice and changes no byte, and the test below says so"
    )
)]

/// Arrays smaller than this, in bytes, are not worth a call to the system.
#[cfg(target_os = "linux")]
const SMALLEST: usize = 4 << 20;

/// The size of a large page, in bytes, on the processors that matter here. Where it is another, the advice is for a
/// little less than it could be.
#[cfg(target_os = "linux")]
const LARGE_PAGE: usize = 2 << 20;

/// Asks the system for large pages for the room of a vector, before it is filled. Small ones are left alone.
pub fn prefer_large_pages<T>(array: &mut Vec<T>) {
    #[cfg(target_os = "linux")]
    {
        let start = array.as_mut_ptr() as usize;
        let byte_count = array.capacity().saturating_mul(size_of::<T>());
        advise(start, byte_count);
    }
    #[cfg(not(target_os = "linux"))]
    let _ = array;
}

#[cfg(target_os = "linux")]
fn advise(start: usize, byte_count: usize) {
    if byte_count < SMALLEST {
        return;
    }
    // Whole large pages: beside the ends other things may lie.
    let first = start.next_multiple_of(LARGE_PAGE);
    let length = (start + byte_count).saturating_sub(first) / LARGE_PAGE * LARGE_PAGE;
    if length == 0 {
        return;
    }
    // SAFETY: the range lies within one allocation that the caller borrows mutably. This advice moves or changes nothing
    // in it, and a failure leaves all as it was.
    unsafe {
        libc::madvise(first as *mut libc::c_void, length, libc::MADV_HUGEPAGE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_changes_no_value() {
        for length in [0, 1, 1_000, 524_288, 3_000_000] {
            let mut array: Vec<u64> = (0..length).collect();
            array.reserve_exact(1_000_000);
            let capacity = array.capacity();
            prefer_large_pages(&mut array);
            array.extend(length..length + 1_000);
            assert_eq!(array.capacity(), capacity);
            assert!(array.iter().copied().eq(0..length + 1_000));
        }
        let mut nothing: Vec<()> = vec![(); 5];
        prefer_large_pages(&mut nothing);
        assert_eq!(nothing.len(), 5);
    }
}
