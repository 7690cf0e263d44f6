//! A motion through given displacements at given times.

use super::{AccelerationBounds, WallMotion, WallState};
use crate::error::Readable;
use crate::quantity::{accept, finite, positive};
use crate::{Fingerprint, ParameterError};

/// A motion through the rows of a table, each a time and a displacement.
///
/// The wall is at rest before the first row and after the last. Between two rows there are two parabolic
/// arcs, which meet halfway in time, so every contact is the root of a parabola. Displacement and velocity
/// have no jumps.
///
/// The velocity at a row is 0 if the row is the first, the last, the end of a rest, or a turning point.
/// Otherwise, with the times $`h`$ and the mean velocities $`w`$ before and after the row,
///
/// ```math
/// v = \pm\min\left(\frac{|h_+w_- + h_-w_+|}{h_- + h_+},\ 2|w_-|,\ 2|w_+|\right),
/// ```
///
/// in the direction of both. The first of these is the slope of the parabola through the row and its
/// neighbors. The other two keep the wall from turning between rows, so it never leaves the range of the
/// table.
///
/// ```
/// use granular_edmd::wall::{Tabulated, WallMotion};
/// // A gate that opens, waits and closes.
/// let gate = Tabulated::new([(1.0, 0.0), (2.0, 3.0), (5.0, 3.0), (6.0, 0.0)])?;
/// let displacements = [1.0, 1.5, 2.0, 4.0, 7.0].map(|time| gate.state(time).displacement);
/// assert_eq!(displacements, [0.0, 1.5, 3.0, 3.0, 0.0]);
/// assert_eq!([1.0, 1.5, 2.0].map(|time| gate.state(time).velocity), [0.0, 6.0, 0.0]);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Tabulated {
    rows: Vec<(f64, f64)>,
    /// Smallest and largest displacement.
    #[cfg_attr(feature = "serde", serde(skip))]
    reach: (f64, f64),
    /// Two arcs from each row to the next, then the arc at rest after the last row.
    #[cfg_attr(feature = "serde", serde(skip))]
    arcs: Vec<Arc>,
}

/// A piece of the motion at constant acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arc {
    from: f64,
    displacement: f64,
    velocity: f64,
    acceleration: f64,
}

impl Tabulated {
    /// Creates the motion through these rows, each a time and a displacement.
    ///
    /// # Errors
    /// If there are fewer than two rows, a number is not finite, or a time is not later than the previous
    /// time by more than rounding. Also if an acceleration would not be finite. Rows are counted from 0.
    pub fn new(rows: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, ParameterError> {
        let rows: Vec<(f64, f64)> = rows.into_iter().collect();
        accept(rows.len() > 1, "number of rows", "at least 2", rows.len() as f64)?;
        for (number, &(time, displacement)) in rows.iter().enumerate() {
            finite(format!("time of row {number}"), time)?;
            finite(format!("displacement of row {number}"), displacement)?;
        }
        let velocities = velocities(&rows);
        let mut arcs = Vec::with_capacity(2 * rows.len());
        for first in 1..rows.len() {
            arcs.extend(arcs_to(first, &rows, &velocities)?);
        }
        let &(from, displacement) = &rows[rows.len() - 1];
        arcs.push(Arc { from, displacement, velocity: 0.0, acceleration: 0.0 });
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let reach = rows.iter().fold(none, |(low, high), &(_, place)| (low.min(place), high.max(place)));
        Ok(Self { rows, reach, arcs })
    }

    /// Creates the motion from one displacement to another in this time, at rest before and after.
    ///
    /// From $`A`$ to $`B`$ in the time $`T`$, the wall accelerates by $`4(B-A)/T^2`$ for half of the time,
    /// and by the opposite for the other half:
    ///
    /// ```math
    /// z(t) = A + 2(B-A)(t/T)^2\quad (0\le t<T/2),\qquad z(t) = B - 2(B-A)(1-t/T)^2\quad (T/2\le t<T).
    /// ```
    ///
    /// It begins at phase 0; [`Combined::delayed_until`](super::Combined::delayed_until) moves the start.
    ///
    /// # Errors
    /// If the time is not positive, or another number or the acceleration is not finite.
    ///
    /// ```
    /// use granular_edmd::wall::{Tabulated, WallMotion};
    /// let piston = Tabulated::from_to(0.0, 2.0, 4.0)?;
    /// let displacements = [-1.0, 1.0, 2.0, 3.0, 9.0].map(|time| piston.state(time).displacement);
    /// assert_eq!(displacements, [0.0, 0.25, 1.0, 1.75, 2.0]);
    /// assert_eq!((piston.state(2.0).velocity, piston.state(9.0).velocity), (1.0, 0.0));
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub fn from_to(from: f64, to: f64, duration: f64) -> Result<Self, ParameterError> {
        Self::new([(0.0, from), (positive("duration", duration)?, to)])
    }

    /// Returns the rows.
    pub fn rows(&self) -> &[(f64, f64)] {
        &self.rows
    }

    /// Returns the arc at a phase, and the phase at which it ends. Before the first row, the wall rests at
    /// the displacement of that row.
    fn arc(&self, phase: f64) -> (Arc, f64) {
        let next = self.arcs.partition_point(|arc| arc.from <= phase);
        let until = self.arcs.get(next).map_or(f64::INFINITY, |arc| arc.from);
        match next.checked_sub(1) {
            Some(number) => (self.arcs[number], until),
            None => (Arc { from: phase, velocity: 0.0, acceleration: 0.0, ..self.arcs[0] }, until),
        }
    }
}

/// Returns the mean velocity from the previous row to this row.
fn slope(row: usize, rows: &[(f64, f64)]) -> f64 {
    (rows[row].1 - rows[row - 1].1) / (rows[row].0 - rows[row - 1].0)
}

fn velocities(rows: &[(f64, f64)]) -> Vec<f64> {
    let inner = (1..rows.len() - 1).map(|row| {
        let (before, after) = (slope(row, rows), slope(row + 1, rows));
        if before * after <= 0.0 {
            return 0.0;
        }
        let share = (rows[row].0 - rows[row - 1].0) / (rows[row + 1].0 - rows[row - 1].0);
        let through = before + share * (after - before);
        through.abs().min(2.0 * before.abs()).min(2.0 * after.abs()).copysign(before)
    });
    [0.0].into_iter().chain(inner).chain([0.0]).collect()
}

/// Returns the two arcs from the previous row to this row.
fn arcs_to(row: usize, rows: &[(f64, f64)], velocities: &[f64]) -> Result<[Arc; 2], ParameterError> {
    let ((from, displacement), (to, _)) = (rows[row - 1], rows[row]);
    let middle = from + 0.5 * (to - from);
    let later = || format!("later than {} by more than rounding", Readable(from));
    accept(from < middle && middle < to, format!("time of row {row}"), later(), to)?;
    let (first, second) = (middle - from, to - middle);
    let (start, end) = (velocities[row - 1], velocities[row]);
    // The middle time is rounded. The arcs take the durations of both halves after this rounding, so they
    // meet at the same position and velocity.
    let share = first / (to - from);
    let velocity = 2.0 * slope(row, rows) - share * start - (1.0 - share) * end;
    let acceleration = |gain: f64, wait: f64| finite(format!("acceleration before row {row}"), gain / wait);
    Ok([
        Arc { from, displacement, velocity: start, acceleration: acceleration(velocity - start, first)? },
        Arc {
            from: middle,
            displacement: displacement + (0.5 * start + 0.5 * velocity) * first,
            velocity,
            acceleration: acceleration(end - velocity, second)?,
        },
    ])
}

impl WallMotion for Tabulated {
    fn state(&self, phase: f64) -> WallState {
        let (Arc { from, displacement, velocity, acceleration }, _) = self.arc(phase);
        let wait = phase - from;
        let displacement = displacement + (velocity + 0.5 * acceleration * wait) * wait;
        WallState::new(displacement.clamp(self.reach.0, self.reach.1), velocity + acceleration * wait)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let (Arc { acceleration, .. }, until) = self.arc(phase);
        AccelerationBounds::new(until, acceleration, acceleration)
    }

    fn reach(&self) -> (f64, f64) {
        self.reach
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let rows = self.rows.iter();
        Some(rows.fold(Fingerprint::of("Tabulated"), |table, row| table.number(row.0).number(row.1)))
    }
}

crate::gate::from_file! {
    Tabulated { rows: Vec<(f64, f64)> } => Self::new(rows)
}
