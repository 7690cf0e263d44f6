//! The one search for the first touch of a disk with a moving wall.

use super::WallMotion;
use crate::roots::first_descent;

/// Rounding of a gap, relative to the lengths that it is the difference of.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Room for a step where there is none, in units of the rounding: a search must end.
const LEAST_ROOM: f64 = 1e-3;

/// Most steps of a search. A wall that sweeps over its reach in each period is met within a few periods, each
/// a few tens of steps: so many are taken only under a wall that stays away from a large part of what it
/// claims to reach.
const MOST_STEPS: u32 = 1 << 20;

/// Most steps of a search that are as short as times can be told apart. A search that converges takes some of
/// them at its end; more come from a motion whose pieces are too short, or whose bounds are too large, for
/// its times.
const MOST_SHORT_STEPS: u32 = 1 << 10;

/// A surface that approaches a wall: its height above the wall's place at rest, along the wall's normal.
///
/// Its time is the phase of the motion that it approaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    time: f64,
    height: f64,
    velocity: f64,
    acceleration: f64,
}

impl Approach {
    /// Creates a surface that at `time` has this height and velocity, and always this acceleration.
    #[inline]
    pub const fn new(time: f64, height: f64, velocity: f64, acceleration: f64) -> Self {
        Self { time, height, velocity, acceleration }
    }

    #[inline]
    fn height(&self, time: f64) -> f64 {
        let elapsed = time - self.time;
        self.height + (self.velocity + 0.5 * self.acceleration * elapsed) * elapsed
    }

    /// Tells whether the surface begins and ends above this height, and is no lower between.
    #[inline]
    pub(crate) fn stays_above(&self, height: f64, until: f64) -> bool {
        // Pulled down it is highest in between, so its ends are enough; no branch, for most flights pass both
        // tests.
        (self.acceleration <= 0.0) & (self.height > height) & (self.height(until) > height)
    }

    #[inline]
    fn velocity(&self, time: f64) -> f64 {
        self.velocity + self.acceleration * (time - self.time)
    }
}

/// Returns the first time, not later than `until`, at which the surface touches the wall and closes.
///
/// On a piece with acceleration at most `$a_{max}$` the gap is never below the parabola with that
/// acceleration: the search steps to its root, where the gap is still open, and repeats until the gap is
/// closed. One step is exact where the acceleration is constant; elsewhere the steps shrink quadratically,
/// down to the rounding of the gap. No contact is ever stepped over. A gap that is closed at the start counts
/// only while it closes.
///
/// Flights beyond the reach of the wall are skipped, at the start and after a bounce. Within it the wall
/// sweeps over every height in each period, so the search takes no more steps than some periods have, however
/// fast the wall and long the flight. A surface that stays below the reach and outruns the wall, or that
/// hovers in a reach which the wall never gets to, is followed from piece to piece: give such a search an
/// end.
///
/// # Walls whose place nobody can tell
/// The search ends whatever the motion answers, and never lets the surface through unseen. In these cases the
/// wall counts as everywhere within its reach, at every speed, so the touch is the first time at which the
/// surface is within it:
/// - Times are too far from each other to tell the pieces of the motion apart, or a piece ends before it
///   begins.
/// - The state or the bounds are not finite. A reach that is not finite counts as one without ends.
/// - The search has taken more than a million steps, or more than a thousand that were as short as times can
///   be told apart: the pieces are too short, or the bounds too large, for the times.
///
/// The gap then need not be closed at the touch. An engine that resolves it finds the number that is not
/// finite, or a run without progress, and says so. A gap that is itself not a number counts as touched at
/// once.
///
/// ```
/// use granular_edmd::wall::{Approach, Fixed, first_touch};
/// let falling = Approach::new(0.0, 2.0, 0.0, -1.0);
/// assert_eq!(first_touch(&Fixed, &falling, 10.0), Some(2.0));
/// assert_eq!(first_touch(&Fixed, &falling, 1.0), None);
/// ```
pub fn first_touch<M: WallMotion + ?Sized>(motion: &M, approach: &Approach, until: f64) -> Option<f64> {
    let search = Search::new(motion, approach);
    let is_in_time = |time: f64| time <= until && time < f64::INFINITY;
    let start = search.enters_reach(approach.time)?;
    if let Some(touch) = search.low_bounce(start) {
        return is_in_time(touch).then_some(touch);
    }
    let (mut time, mut patience) = (start, Patience::default());
    while is_in_time(time) {
        match search.step(time) {
            Step::Touch(touch) => return is_in_time(touch).then_some(touch),
            Step::Open(next) if patience.lasts(time, next) => time = search.enters_reach(next)?,
            Step::Open(_) => return Some(time),
        }
    }
    None
}

/// Counts steps: a search must end under any motion.
#[derive(Default)]
struct Patience {
    steps: u32,
    short_steps: u32,
}

impl Patience {
    /// Counts a step, and tells whether there may be another.
    #[inline]
    fn lasts(&mut self, from: f64, to: f64) -> bool {
        self.steps += 1;
        self.short_steps += u32::from(to <= from.next_up().next_up());
        self.steps < MOST_STEPS && self.short_steps < MOST_SHORT_STEPS
    }
}

struct Search<'a, M: ?Sized> {
    motion: &'a M,
    approach: &'a Approach,
    /// Smallest and largest displacement of the wall.
    reach: (f64, f64),
}

/// The gap and the wall at one time.
#[derive(Clone, Copy)]
struct Look {
    gap: f64,
    rate: f64,
    /// Lower bound of the gap's acceleration until `until`.
    pull: f64,
    /// True if the bound is the acceleration itself.
    exact: bool,
    tolerance: f64,
    /// End of the piece: not later than the time of the look where times cannot tell the pieces apart.
    until: f64,
    /// True if state, bounds and reach of the wall are finite.
    finite: bool,
}

/// Outcome of one step of the search.
enum Step {
    /// The surfaces touch at this time.
    Touch(f64),
    /// They do not touch before this time.
    Open(f64),
}

impl<'a, M: WallMotion + ?Sized> Search<'a, M> {
    fn new(motion: &'a M, approach: &'a Approach) -> Self {
        let (low, high) = motion.reach();
        // A wall that cannot say how far it reaches gets everywhere: no flight may be skipped above it.
        let is_told = low.is_finite() && high.is_finite();
        let reach = if is_told { (low, high) } else { (f64::NEG_INFINITY, f64::INFINITY) };
        Self { motion, approach, reach }
    }

    /// Returns the first time from this one on at which the surface is no higher than the wall ever gets.
    fn enters_reach(&self, time: f64) -> Option<f64> {
        let Approach { acceleration, .. } = *self.approach;
        let above = self.approach.height(time) - self.reach.1;
        if above > 0.0 {
            return Some(time + first_descent(above, self.approach.velocity(time), acceleration)?);
        }
        Some(time)
    }

    fn step(&self, time: f64) -> Step {
        let Look { gap, rate, pull, exact, tolerance, until, finite } = self.look(time);
        let is_resolved = finite && until > time;
        if !is_resolved || gap.is_nan() || rate.is_nan() || (gap <= tolerance && rate < 0.0) {
            return Step::Touch(time);
        }
        // So far away that its place overflows.
        if gap == f64::INFINITY {
            return Step::Open(f64::INFINITY);
        }
        if !exact {
            let room = (gap + tolerance).max(LEAST_ROOM * tolerance);
            return Step::Open(Self::still_open(time, room, rate, pull).min(until));
        }
        match first_descent(gap, rate, pull) {
            Some(wait) if time + wait <= until => Step::Touch(time + wait),
            _ => Step::Open(until),
        }
    }

    fn look(&self, time: f64) -> Look {
        let wall = self.motion.state(time);
        let bounds = self.motion.acceleration(time);
        let rate = self.approach.velocity(time) - wall.velocity;
        let exact = bounds.min == bounds.max;
        Look {
            gap: self.approach.height(time) - wall.displacement,
            rate,
            pull: self.approach.acceleration - bounds.max,
            exact,
            tolerance: if exact { 0.0 } else { self.tolerance(time, rate) },
            until: bounds.until,
            finite: [wall.displacement, wall.velocity, bounds.min, bounds.max, self.reach.1]
                .iter()
                .all(|number| number.is_finite()),
        }
    }

    /// Returns the end of a bounce that begins at `start` and stays lower than rounding, if there is one.
    ///
    /// The gap cannot tell when such a bounce is over, but the bounce is so short that the acceleration does
    /// not change in it: it is a parabola over the gap that it starts from, and ends when that gap closes as
    /// fast as it opened. If it ended before, bounces would lose speed that no rule takes; if after, each
    /// would go deeper into the wall than the last.
    fn low_bounce(&self, start: f64) -> Option<f64> {
        let first = self.look(start);
        let is_low = |pull: f64| first.rate * first.rate <= -2.0 * pull * first.tolerance;
        if first.exact
            || !first.finite
            || first.gap > first.tolerance
            || first.rate < 0.0
            || !is_low(first.pull)
        {
            return None;
        }
        let pull = self.pull_after(start, &first);
        let end = start + first_descent(0.0, first.rate, pull)?;
        (is_low(pull) && end < first.until).then_some(end)
    }

    /// Returns the acceleration of the gap in the time of a fall through the rounding, which cannot leave the
    /// piece.
    ///
    /// From the change of the rate: the motion says no more than bounds of it.
    fn pull_after(&self, start: f64, first: &Look) -> f64 {
        let fall = (-2.0 * first.tolerance / first.pull).sqrt();
        let soon = (start + fall.min(0.5 * (first.until - start))).max(start.next_up());
        (self.look(soon).rate - first.rate) / (soon - start)
    }

    /// Returns a time, later than this one, until which the gap cannot have closed by more than `room`.
    ///
    /// The room is the gap and its rounding: each step makes way, and the last ends in a gap closed by
    /// rounding. A gap that is closed by more has next to none: nothing goes much deeper into a wall than it
    /// is.
    fn still_open(time: f64, room: f64, rate: f64, pull: f64) -> f64 {
        first_descent(room, rate, pull).map_or(f64::INFINITY, |wait| (time + wait).max(time.next_up()))
    }

    /// Returns the gap below which it counts as closed: rounding of the lengths, and of the time at this
    /// speed.
    fn tolerance(&self, time: f64, rate: f64) -> f64 {
        let (low, high) = self.reach;
        let lengths = low.abs().max(high.abs()) + self.approach.height.abs();
        ROUNDING * (lengths + rate.abs() * time.abs())
    }
}
