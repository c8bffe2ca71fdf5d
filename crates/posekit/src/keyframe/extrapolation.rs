//! What a property does before its first key and after its last one.

/// What a property does before its first key or after its last one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Extrapolation {
    /// It keeps the value of that key.
    #[default]
    Hold,
    /// It starts again from the other end.
    Cycle,
    /// It starts again, each time moved by the way from the first key to the last one: added for
    /// numbers and vectors; for orientations the turn from the first to the last is applied in the
    /// parent's space, after the value's own. So a step forward becomes a walk, a turn a pirouette.
    CycleWithOffset,
    /// It goes back the way it came, and forth again.
    PingPong,
}

impl Extrapolation {
    /// Whether the end of the track is joined to its start.
    pub(super) fn cycles(self) -> bool {
        matches!(self, Self::Cycle | Self::CycleWithOffset)
    }
}

/// Beyond so many turns there is no telling where in a turn a time is: whole numbers end there, and the way
/// added for each turn would leave every range. The track holds instead.
const MOST_TURNS: f64 = (1_u64 << 53) as f64;

/// A time brought between the first and the last key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// In seconds, from the first key's time to the last one's.
    pub time_secs: f64,
    /// How many times the value there is moved by the way from the first to the last key: whole, and 0
    /// but for [`Extrapolation::CycleWithOffset`].
    pub shifts: f64,
}

impl Place {
    pub(super) fn of(time_secs: f64, [start, end]: [f64; 2], ends: [Extrapolation; 2]) -> Self {
        let held = |time_secs| Self {
            time_secs,
            shifts: 0.0,
        };
        if time_secs >= start && time_secs <= end {
            return held(time_secs);
        }
        // NaN is neither before nor after.
        let way = if time_secs > end { ends[1] } else { ends[0] };
        let span = end - start;
        let nearest = if time_secs > end { end } else { start };
        if span <= 0.0 || !time_secs.is_finite() {
            return held(nearest);
        }
        let turns = ((time_secs - start) / span).floor();
        if turns.abs() > MOST_TURNS {
            return held(nearest);
        }
        // Rounding may leave a little more than the span, or less than nothing.
        let rest = (time_secs - start - turns * span).clamp(0.0, span);
        match way {
            Extrapolation::Hold => held(nearest),
            Extrapolation::Cycle => held(start + rest),
            Extrapolation::CycleWithOffset => Self {
                time_secs: start + rest,
                shifts: turns,
            },
            Extrapolation::PingPong if turns % 2.0 == 0.0 => held(start + rest),
            Extrapolation::PingPong => held(end - rest),
        }
    }
}
