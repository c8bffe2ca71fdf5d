//! Feet that slide while they are planted.
//!
//! A figure whose root path does not fit its steps slides in every contact and all in one
//! direction: a walk on the spot, a wrong scale of the path, a retargeting onto other legs. That is
//! one finding about the path and not one for each contact.

use glam::Vec3;

use super::statistics::median;
use super::{
    CheckConfig, Contact, Figure, Finding, FindingCode, FloorContacts, FrameRange, Severity, Unit,
};
use crate::motion::Motion;
use crate::skeleton::JointId;

/// So many slides are told one by one; a path that does not fit needs more of them.
const SLIDES_TOLD_MAX: usize = 3;

/// The share of the contacts that slide when the path does not fit the steps.
const STEADY_SHARE: f64 = 0.7;

/// How long the mean of the slides' directions is then, 1 for all the same.
const STEADY_DIRECTION: f32 = 0.8;

pub(super) fn check(
    contacts: &FloorContacts,
    figure: &Figure,
    motion: &Motion,
    config: &CheckConfig,
    findings: &mut Vec<Finding>,
) {
    let slides: Vec<Slide<'_>> = contacts
        .contacts
        .iter()
        .map(|contact| Slide::new(contact, figure, motion))
        .filter(|slide| {
            slide.share >= config.slide_heights && slide.share / slide.secs >= config.slide_speed
        })
        .collect();
    let is_steady = slides.len() > SLIDES_TOLD_MAX
        && slides.len() as f64 >= STEADY_SHARE * contacts.contacts.len() as f64
        && mean_direction(&slides).length() >= STEADY_DIRECTION;
    if is_steady {
        findings.push(steady_finding(&slides, contacts.contacts.len()));
    } else {
        findings.extend(slides.iter().map(|slide| finding(slide, motion)));
    }
}

/// How far a foot slides in a contact.
struct Slide<'a> {
    contact: &'a Contact,
    distance: f64,
    share: f64,
    secs: f64,
}

impl<'a> Slide<'a> {
    fn new(contact: &'a Contact, figure: &Figure, motion: &Motion) -> Self {
        let distance = f64::from(contact.slide.length());
        Self {
            contact,
            distance,
            share: distance / figure.height,
            secs: contact.slide_steps as f64 * motion.frame_time_secs(),
        }
    }
}

/// The mean of the directions of the slides.
fn mean_direction(slides: &[Slide<'_>]) -> Vec3 {
    let sum: Vec3 = slides
        .iter()
        .map(|slide| slide.contact.slide.normalize_or_zero())
        .sum();
    sum / slides.len() as f32
}

fn steady_finding(slides: &[Slide<'_>], contact_count: usize) -> Finding {
    let mut feet: Vec<JointId> = slides.iter().map(|slide| slide.contact.joint).collect();
    feet.sort_unstable();
    feet.dedup();
    let of =
        |value: fn(&Slide<'_>) -> f64| median(&mut slides.iter().map(value).collect::<Vec<_>>());
    let speed = of(|slide| slide.share / slide.secs);
    let share = of(|slide| slide.share);
    let first = slides.iter().map(|slide| slide.contact.first).min();
    let last = slides.iter().map(|slide| slide.contact.last).max();
    Finding {
        code: FindingCode::FootSliding,
        severity: Severity::Warning,
        joints: feet,
        frames: first
            .zip(last)
            .map(|(first, last)| FrameRange { first, last }),
        value: of(|slide| slide.distance),
        unit: Unit::FileUnits,
        share_of_height: Some(share),
        message: format!(
            "the feet slide in {} of {contact_count} contacts, all the same way, by {:.1} per cent of \
             the height each at {speed:.2} heights a second: the path of the figure does not fit its \
             steps, as when it walks on the spot",
            slides.len(),
            100.0 * share
        ),
    }
}

fn finding(slide: &Slide<'_>, motion: &Motion) -> Finding {
    let joint = slide.contact.joint;
    let name = motion.skeleton().unique_name(joint);
    Finding {
        code: FindingCode::FootSliding,
        severity: Severity::Warning,
        joints: vec![joint],
        frames: Some(FrameRange {
            first: slide.contact.first,
            last: slide.contact.last,
        }),
        value: slide.distance,
        unit: Unit::FileUnits,
        share_of_height: Some(slide.share),
        message: format!(
            "{name} slides over the floor by {:.1} per cent of the height ({:.4} file units) in {:.2} \
             seconds while it carries the figure",
            100.0 * slide.share,
            slide.distance,
            slide.secs
        ),
    }
}
