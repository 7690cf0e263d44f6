//! The search for the first touch of a disk with a moving wall.

use super::WallMotion;
use crate::roots::first_descent;

/// Rounding error of a gap, relative to the two lengths whose difference is the gap.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Smallest room for a step, in units of the rounding error. It makes sure that a search ends.
const LEAST_ROOM: f64 = 1e-3;

/// Largest number of steps of a search. If a wall sweeps over its reach in each period, a search finds a
/// touch within a few periods, each of which takes a few tens of steps. A search that has taken more steps
/// returns to its caller, which resumes the search later.
const MOST_STEPS: u32 = 256;

/// The result of a search for the first touch: the touch, or the time up to which there is none.
///
/// In [`wall`](crate::wall), a touch is its time. In [`boundary`](crate::boundary), it is a
/// [`Touch`](crate::boundary::Touch). An `Option` becomes a result with `into`:
///
/// ```
/// use granular_edmd::wall::FirstTouch;
/// assert_eq!(FirstTouch::from(Some(2.0)), FirstTouch::At(2.0));
/// assert_eq!(FirstTouch::<f64>::from(None), FirstTouch::NONE);
/// assert_eq!(FirstTouch::At(2.0).map(|time| time - 1.0).touch(), Some(1.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use]
pub enum FirstTouch<T> {
    /// The first touch.
    At(T),
    /// There is no touch before this time, and nothing is known about later times. If this is the end of the
    /// search, or infinite, the search has found no touch at all. If it is the start of the search, the
    /// search cannot continue.
    NotBefore(f64),
}

impl<T> FirstTouch<T> {
    /// The result of a search that found no touch up to its end.
    pub const NONE: Self = Self::NotBefore(f64::INFINITY);

    /// Returns the touch, or `None` if the search found none.
    pub fn touch(self) -> Option<T> {
        match self {
            Self::At(touch) => Some(touch),
            Self::NotBefore(_) => None,
        }
    }

    /// Returns the same result, with another description of the touch.
    pub fn map<U>(self, change: impl FnOnce(T) -> U) -> FirstTouch<U> {
        match self {
            Self::At(touch) => FirstTouch::At(change(touch)),
            Self::NotBefore(time) => FirstTouch::NotBefore(time),
        }
    }
}

impl<T> From<Option<T>> for FirstTouch<T> {
    fn from(touch: Option<T>) -> Self {
        touch.map_or(Self::NONE, Self::At)
    }
}

/// The approach of a surface to a wall: its height above the wall's position at rest, along the wall's
/// normal.
///
/// Its `time` is a phase of the wall's motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    time: f64,
    height: f64,
    velocity: f64,
    acceleration: f64,
}

impl Approach {
    /// Creates the approach of a surface from its height and velocity at `time` and its constant
    /// acceleration.
    #[inline]
    pub const fn new(time: f64, height: f64, velocity: f64, acceleration: f64) -> Self {
        Self { time, height, velocity, acceleration }
    }

    #[inline]
    fn height(&self, time: f64) -> f64 {
        let elapsed = time - self.time;
        self.height + (self.velocity + 0.5 * self.acceleration * elapsed) * elapsed
    }

    /// Returns whether the surface stays above this height until this time. Under an upward pull, the result
    /// is always false, and the caller must search.
    #[inline]
    pub(crate) fn stays_above(&self, height: f64, until: f64) -> bool {
        // Under a downward pull, the surface is lowest at the first or the last of these times, so two tests
        // are enough. The tests do not branch, since most flights pass both.
        (self.acceleration <= 0.0) & (self.height > height) & (self.height(until) > height)
    }

    #[inline]
    fn velocity(&self, time: f64) -> f64 {
        self.velocity + self.acceleration * (time - self.time)
    }
}

/// Returns the first time, not later than `until`, at which the surface touches the wall and closes further.
///
/// In a piece in which the wall accelerates by at most $`a_{max}`$, the gap is never below the parabola with
/// that acceleration. The search steps to the root of the parabola, where the gap is still open, and repeats
/// until the gap is closed. One step is exact if the acceleration is constant. Otherwise, the steps shrink
/// quadratically, down to the rounding error of the gap. The search never steps over a contact. A gap that is
/// already closed at the start counts only if it closes further.
///
/// The search skips the parts of a flight that are beyond the reach of the wall, at the start and after a
/// bounce. Within the reach, the wall sweeps over every height in each period. The search therefore takes no
/// more steps than a few periods need, however fast the wall and however long the flight. There are two
/// exceptions: a surface may stay below the reach and outrun the wall, or hover in a part of the reach that
/// the wall never enters. The search then follows it from piece to piece.
///
/// # Searches that do not come to an end
/// A search never reports a touch that does not happen. It returns [`NotBefore`](FirstTouch::NotBefore) with
/// the time up to which the gap is known to be open:
/// - After 256 steps. The caller may resume the search from that time.
/// - Where floating-point times are too coarse to tell the pieces of the motion apart, where a piece ends
///   before it begins, or where a number is not finite. A search that starts there gets no further. A run
///   ends with an error at that time.
///
/// ```
/// use granular_edmd::wall::{Approach, FirstTouch, Fixed, first_touch};
/// let falling = Approach::new(0.0, 2.0, 0.0, -1.0);
/// assert_eq!(first_touch(&Fixed, &falling, 10.0), FirstTouch::At(2.0));
/// assert_eq!(first_touch(&Fixed, &falling, 1.0), FirstTouch::NONE);
/// ```
pub fn first_touch<M: WallMotion + ?Sized>(motion: &M, approach: &Approach, until: f64) -> FirstTouch<f64> {
    let search = Search::new(motion, approach);
    let is_in_time = |time: f64| time <= until && time < f64::INFINITY;
    let touch_at = |touch: f64| if is_in_time(touch) { FirstTouch::At(touch) } else { FirstTouch::NONE };
    let Some(mut time) = search.enters_reach(approach.time) else { return FirstTouch::NONE };
    if let Some(touch) = search.low_bounce(time) {
        return touch_at(touch);
    }
    for _ in 0..MOST_STEPS {
        // The test is also false for a time that is not a number.
        if !is_in_time(time) {
            return if time.is_nan() { FirstTouch::NotBefore(approach.time) } else { FirstTouch::NONE };
        }
        match search.step(time) {
            Step::Touch(touch) => return touch_at(touch),
            Step::Unknown => return FirstTouch::NotBefore(time),
            Step::Open(next) => match search.enters_reach(next) {
                Some(entry) => time = entry,
                None => return FirstTouch::NONE,
            },
        }
    }
    FirstTouch::NotBefore(time)
}

struct Search<'a, M: ?Sized> {
    motion: &'a M,
    approach: &'a Approach,
    /// Smallest and largest displacement of the wall.
    reach: (f64, f64),
}

/// The gap and its rate at one time, with bounds that hold until the end of the wall's piece.
#[derive(Clone, Copy)]
struct Look {
    gap: f64,
    rate: f64,
    /// Lower bound on the gap's acceleration until `until`.
    pull: f64,
    /// True if the bound is the acceleration itself.
    exact: bool,
    tolerance: f64,
    /// End of the piece. It is not later than the present time of the search if floating-point times cannot
    /// tell the pieces apart.
    until: f64,
    /// True if state, bounds and reach of the wall are finite.
    finite: bool,
}

/// Outcome of one step of the search.
enum Step {
    /// The surfaces touch at this time.
    Touch(f64),
    /// The surfaces do not touch before this time.
    Open(f64),
    /// The position of the wall is unknown from this time on.
    Unknown,
}

impl<'a, M: WallMotion + ?Sized> Search<'a, M> {
    fn new(motion: &'a M, approach: &'a Approach) -> Self {
        let (low, high) = motion.reach();
        // A wall without a finite reach counts as reaching everywhere, so that no flight above it is skipped.
        let is_told = low.is_finite() && high.is_finite();
        let reach = if is_told { (low, high) } else { (f64::NEG_INFINITY, f64::INFINITY) };
        Self { motion, approach, reach }
    }

    /// Returns the first time, not before `time`, at which the wall could reach the surface if the wall were
    /// at its highest position.
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
        if !is_resolved || gap.is_nan() || rate.is_nan() {
            return Step::Unknown;
        }
        if gap <= tolerance && rate < 0.0 {
            return Step::Touch(time);
        }
        // The surface is so far away that its position overflows.
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

    /// Returns the end of a bounce that begins at `start`, or `None` if the bounce rises above the rounding
    /// error of the gap.
    ///
    /// The gap itself does not show when such a bounce is over. However, the bounce is so short that the
    /// acceleration does not change in it: the gap follows a parabola that starts from its present value, and
    /// the bounce is over when the gap closes as fast as it opened. At an earlier end, bounces would lose
    /// speed that no rule takes away. At a later end, each bounce would go deeper into the wall than the
    /// previous one.
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

    /// Returns the mean acceleration of the gap while it falls through its rounding error, within the piece.
    ///
    /// The acceleration comes from the change of the rate, since the motion only gives bounds on the
    /// acceleration.
    fn pull_after(&self, start: f64, first: &Look) -> f64 {
        let fall = (-2.0 * first.tolerance / first.pull).sqrt();
        let soon = (start + fall.min(0.5 * (first.until - start))).max(start.next_up());
        (self.look(soon).rate - first.rate) / (soon - start)
    }

    /// Returns a time, later than this one, until which the gap cannot have closed by more than `room`.
    ///
    /// The room is the gap plus its rounding error, so each step advances, and the last step ends where the
    /// gap is zero within rounding. A gap that is negative by more than its rounding error gets almost no
    /// room, so that no surface goes much deeper into a wall than it already is.
    fn still_open(time: f64, room: f64, rate: f64, pull: f64) -> f64 {
        first_descent(room, rate, pull).map_or(f64::INFINITY, |wait| (time + wait).max(time.next_up()))
    }

    /// Returns the value below which a gap counts as closed: the rounding error of the lengths, plus `rate`
    /// times the rounding error of `time`.
    fn tolerance(&self, time: f64, rate: f64) -> f64 {
        let (low, high) = self.reach;
        let lengths = low.abs().max(high.abs()) + self.approach.height.abs();
        ROUNDING * (lengths + rate.abs() * time.abs())
    }
}
