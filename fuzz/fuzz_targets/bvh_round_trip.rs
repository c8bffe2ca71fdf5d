//! Read, write, read: the second document is the first, to the bit, and needs no repair in its layout.
#![no_main]

use libfuzzer_sys::fuzz_target;
use posekit_formats::bvh;

fuzz_target!(|bytes: &[u8]| {
    let Ok(first) = bvh::read(bytes) else { return };
    let written = bvh::write(&first.document);
    let second = bvh::read(&written).expect("what was written reads back");
    assert_eq!(first.document, second.document);
    assert_eq!(
        written,
        bvh::write(&second.document),
        "zeros keep their sign"
    );
});
