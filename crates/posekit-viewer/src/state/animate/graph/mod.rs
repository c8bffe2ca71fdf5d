//! What the graph editor shows and holds: which channels, which of their keys are selected, what is dragged.
//!
//! The selected keys are those of the scene ([`Authored::selection`]); the graph knows beside them which
//! channels of a key are meant, so that one angle of a joint can be moved without the others.
//!
//! [`Authored::selection`]: super::Authored::selection

mod hold;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use posekit::keyframe::edit::SAME_TIME_SECS;
use posekit::rotation::EulerOrder;

use super::channel::{self, Channels, Dot, Edited, Side, insert_on_curve};
use super::edit::mode::LOST_TURN;
use super::{Authored, KeyId, Lane, Owner};
use crate::state::session::Session;
pub use hold::{Held, HoldKind};

/// A channel of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ChannelId {
    /// The lane.
    pub lane: Lane,
    /// Which of its channels.
    pub channel: usize,
}

/// A key of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DotId {
    /// The lane.
    pub lane: Lane,
    /// Which key of which channel.
    pub dot: Dot,
}

impl DotId {
    /// The key that it is of.
    #[must_use]
    pub const fn key(self) -> KeyId {
        KeyId {
            lane: self.lane,
            index: self.dot.key,
        }
    }

    /// The channel that it is on.
    #[must_use]
    pub const fn channel(self) -> ChannelId {
        ChannelId {
            lane: self.lane,
            channel: self.dot.channel,
        }
    }
}

/// A handle of a key of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HandleId {
    /// The key.
    pub at: DotId,
    /// On which side of it.
    pub side: Side,
}

/// What a graph editor shows and holds.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    curves: BTreeMap<Lane, Arc<Channels>>,
    /// Lanes that are shown though nothing of them is selected.
    pinned: BTreeSet<Lane>,
    hidden: BTreeSet<ChannelId>,
    /// The channels of the selected keys.
    dots: BTreeSet<DotId>,
    held: Option<Held>,
    /// The order of angles that was chosen; the scene's own while none was.
    order: Option<EulerOrder>,
}

impl Graph {
    /// Follows what has changed in the session since it was asked last.
    pub fn update(&mut self, session: &Session) {
        let Some(authored) = session.authored() else {
            *self = Self {
                order: self.order,
                ..Self::default()
            };
            return;
        };
        let lanes = self.shown_lanes(session, authored);
        let before = std::mem::take(&mut self.curves);
        for lane in lanes {
            let Some(track) = authored.track(lane) else {
                continue;
            };
            let order = self.order_of(authored, lane);
            let old = before.get(&lane);
            let same = old.filter(|old| old.is_of(track, order));
            let channels = same.map(Arc::clone).unwrap_or_else(|| {
                // Angles stay on the turn that they were on.
                let near = old.map_or([0.0; 3], |old| old.at_key(0));
                Arc::new(Channels::of(track.to_value(), order, near))
            });
            self.curves.insert(lane, channels);
        }
        self.follow_selection(authored.selection());
    }

    /// The keyed lanes of selected joints and keys, of what is picked of the scene, and those that were pinned.
    fn shown_lanes(&self, session: &Session, authored: &Authored) -> BTreeSet<Lane> {
        let joints = session.selection().iter();
        let of_joints = joints.flat_map(|&joint| [Lane::Rotation(joint), Lane::Translation(joint)]);
        let of_keys = authored.selection().iter().map(|key| key.lane);
        let of_picked = session.picked().map(|picked| picked.owner.lanes());
        let pinned = self.pinned.iter().copied();
        let lanes = of_joints.chain(of_keys).chain(pinned);
        lanes.chain(of_picked.into_iter().flatten()).collect()
    }

    /// The order in which a lane's angles are shown: the chosen one, or that of the scene or the file.
    fn order_of(&self, authored: &Authored, lane: Lane) -> EulerOrder {
        let own = match lane {
            Lane::Rotation(joint) => authored.order_of(joint),
            _ => EulerOrder::ZXY,
        };
        self.order.unwrap_or(own)
    }

    /// Dots are of selected keys; of a key that was selected elsewhere all channels that are seen are.
    fn follow_selection(&mut self, keys: &BTreeSet<KeyId>) {
        self.dots.retain(|dot| keys.contains(&dot.key()));
        let known: BTreeSet<KeyId> = self.dots.iter().map(|dot| dot.key()).collect();
        for key in keys.difference(&known) {
            let channels = self.seen_channels(key.lane);
            self.dots.extend(channels.into_iter().map(|channel| DotId {
                lane: key.lane,
                dot: Dot {
                    key: key.index,
                    channel,
                },
            }));
        }
    }

    /// The lanes that are shown, and their channels.
    #[must_use]
    pub fn curves(&self) -> &BTreeMap<Lane, Arc<Channels>> {
        &self.curves
    }

    /// Whether a channel's curve is seen.
    #[must_use]
    pub fn is_seen(&self, id: ChannelId) -> bool {
        self.curves.contains_key(&id.lane) && !self.hidden.contains(&id)
    }

    /// The channels of a lane that are seen.
    #[must_use]
    pub fn seen_channels(&self, lane: Lane) -> Vec<usize> {
        let count = self.curves.get(&lane).map_or(0, |curves| curves.count());
        let channels = 0..count;
        channels
            .filter(|&channel| self.is_seen(ChannelId { lane, channel }))
            .collect()
    }

    /// The channels that are seen.
    pub fn seen(&self) -> impl Iterator<Item = (ChannelId, &Arc<Channels>)> {
        self.curves.iter().flat_map(|(&lane, channels)| {
            let ids = (0..channels.count()).map(move |channel| ChannelId { lane, channel });
            ids.filter(|id| self.is_seen(*id))
                .map(move |id| (id, channels))
        })
    }

    /// Shows or hides a channel's curve.
    pub fn set_seen(&mut self, id: ChannelId, is_seen: bool) {
        if is_seen {
            self.hidden.remove(&id);
        } else {
            self.hidden.insert(id);
        }
    }

    /// Shows a lane though nothing of it is selected, or no longer.
    pub fn set_pinned(&mut self, lane: Lane, is_pinned: bool) {
        if is_pinned {
            self.pinned.insert(lane);
        } else {
            self.pinned.remove(&lane);
        }
    }

    /// Whether a lane is shown though nothing of it is selected.
    #[must_use]
    pub fn is_pinned(&self, lane: Lane) -> bool {
        self.pinned.contains(&lane)
    }

    /// The order of angles that was chosen; `None` for that of the scene's file.
    #[must_use]
    pub fn order(&self) -> Option<EulerOrder> {
        self.order
    }

    /// Chooses the order of angles.
    pub fn set_order(&mut self, order: Option<EulerOrder>) {
        self.order = order;
    }

    /// The selected dots that are seen.
    #[must_use]
    pub fn selected(&self) -> BTreeSet<DotId> {
        let seen = |dot: &&DotId| self.is_seen(dot.channel());
        self.dots.iter().filter(seen).copied().collect()
    }

    /// Whether a dot is selected.
    #[must_use]
    pub fn is_selected(&self, dot: DotId) -> bool {
        self.dots.contains(&dot)
    }

    /// Every dot that is seen.
    pub fn dots(&self) -> impl Iterator<Item = DotId> {
        self.seen().flat_map(|(id, channels)| {
            (0..channels.times_secs().len()).map(move |key| DotId {
                lane: id.lane,
                dot: Dot {
                    key,
                    channel: id.channel,
                },
            })
        })
    }

    /// Where a dot is: seconds and value.
    #[must_use]
    pub fn place(&self, id: DotId) -> Option<[f64; 2]> {
        let channels = self.curves.get(&id.lane)?;
        let time = channels.times_secs().get(id.dot.key)?;
        Some([*time, channels.at_key(id.dot.key)[id.dot.channel]])
    }

    /// Where a handle is: seconds and value.
    #[must_use]
    pub fn handle_place(&self, id: HandleId) -> Option<[f64; 2]> {
        let DotId { lane, dot } = id.at;
        let channels = self.curves.get(&lane)?;
        (dot.key < channels.times_secs().len()).then_some(())?;
        channels.handle(dot.key, dot.channel, id.side)
    }

    /// Selects dots, and with them their keys. What was shown stays so, though nothing of it may be
    /// selected any more.
    pub fn select(&mut self, session: &mut Session, dots: BTreeSet<DotId>) {
        let is_shown = |lane: &Lane| match lane.owner() {
            Owner::Joint(joint) => session.selection().contains(&joint),
            owner => session.picked().is_some_and(|picked| picked.owner == owner),
        };
        let others = self.curves.keys().filter(|lane| !is_shown(lane));
        self.pinned.extend(others.copied());
        let keys: BTreeSet<KeyId> = dots.iter().map(|dot| dot.key()).collect();
        self.dots = dots;
        session.author(|authored| authored.select(keys));
    }

    /// The span of what is seen, or of what is selected: times, and values between these times.
    /// `None` when there is nothing.
    #[must_use]
    pub fn extent(&self, dots: impl IntoIterator<Item = DotId>) -> Option<[[f64; 2]; 2]> {
        let places = dots.into_iter().filter_map(|dot| self.place(dot));
        places.fold(None, |extent, [time, value]| {
            let [times, values] = extent.unwrap_or([[time; 2], [value; 2]]);
            Some([
                [times[0].min(time), times[1].max(time)],
                [values[0].min(value), values[1].max(value)],
            ])
        })
    }

    /// Puts a key onto a lane's curve, which does not move, and selects it.
    pub fn insert_key(&mut self, session: &mut Session, id: ChannelId, time_secs: f64) {
        let Some(channels) = self.curves.get(&id.lane) else {
            return;
        };
        let Ok(edited) = insert_on_curve(channels.track(), time_secs) else {
            return;
        };
        let times = edited.track.as_track();
        let at = |time: &f64| (time - time_secs).abs() <= SAME_TIME_SECS;
        let Some(key) = times.times_secs().iter().position(at) else {
            return;
        };
        let dot = DotId {
            lane: id.lane,
            dot: Dot {
                key,
                channel: id.channel,
            },
        };
        self.put(
            session,
            ("Insert key", None),
            vec![(id.lane, edited)],
            &BTreeSet::new(),
        );
        self.select(session, BTreeSet::from([dot]));
    }

    /// Changes one dot's time and value.
    pub fn set_dot(
        &mut self,
        session: &mut Session,
        step: Step<'_>,
        id: DotId,
        [time_secs, value]: [f64; 2],
    ) {
        let (Some(channels), Some(place)) = (self.curves.get(&id.lane), self.place(id)) else {
            return;
        };
        let edited =
            channel::move_dots(channels, &[id.dot], time_secs - place[0], value - place[1]);
        if channels.loses_turn(id.dot, value) {
            session.tell(LOST_TURN);
        }
        if let Ok(edited) = edited {
            let dots = self.dots.clone();
            self.put(session, step, vec![(id.lane, edited)], &dots);
        }
    }

    /// Changes the slope of one dot on a side.
    pub fn set_slope(&mut self, session: &mut Session, step: Step<'_>, id: HandleId, slope: f64) {
        let DotId { lane, dot } = id.at;
        let Some(channels) = self.curves.get(&lane) else {
            return;
        };
        if let Ok(edited) = channel::drag_handle(channels, dot, id.side, slope) {
            let dots = self.dots.clone();
            self.put(session, step, vec![(lane, edited)], &dots);
        }
    }

    /// Writes edited lanes, and follows `dots` to where their keys have gone. Keys of other lanes stay
    /// selected.
    fn put(
        &mut self,
        session: &mut Session,
        (name, gesture): Step<'_>,
        edited: Vec<(Lane, Edited)>,
        dots: &BTreeSet<DotId>,
    ) {
        if edited.is_empty() {
            return;
        }
        let moved: BTreeMap<Lane, &BTreeMap<usize, usize>> = edited
            .iter()
            .map(|(lane, edited)| (*lane, &edited.keys))
            .collect();
        let followed = dots.iter().filter_map(|id| {
            let Some(keys) = moved.get(&id.lane) else {
                return Some(*id);
            };
            let dot = Dot {
                key: *keys.get(&id.dot.key)?,
                ..id.dot
            };
            Some(DotId { dot, ..*id })
        });
        self.dots = followed.collect();
        let mut selection: BTreeSet<KeyId> = self.dots.iter().map(|dot| dot.key()).collect();
        let lanes: BTreeSet<Lane> = moved.into_keys().collect();
        session.author(|authored| {
            let others = authored.selection().iter();
            selection.extend(others.filter(|key| !lanes.contains(&key.lane)));
            let changes = edited
                .into_iter()
                .map(|(lane, edited)| (lane, Some(edited.track)));
            authored.set_tracks(name, gesture, changes.collect(), selection);
        });
        self.update(session);
    }
}

/// A step of the history: its name, and the gesture that it is part of.
pub type Step<'a> = (&'a str, Option<crate::state::edit::Gesture>);
