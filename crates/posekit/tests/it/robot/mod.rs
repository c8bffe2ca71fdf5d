//! Mechanisms and robots.

mod mechanisms;
mod two_link;
