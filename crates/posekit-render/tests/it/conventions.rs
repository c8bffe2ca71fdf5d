//! Bodies on skeletons as many programs lay them out.

use crate::inside::assert_fits;

#[path = "../../../posekit/tests/it/body/conventions.rs"]
#[allow(dead_code, reason = "the tests of the landmarks ask it for more")]
mod figures;

#[test]
fn bones_of_twelve_conventions_lie_inside_their_parts() {
    for convention in figures::conventions() {
        assert_fits(convention.label, &convention.motion());
    }
}
