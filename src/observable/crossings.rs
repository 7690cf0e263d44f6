//! The crossings of a line by the centers of disks.

use std::collections::BTreeMap;

use glam::DVec2;

use super::sample_times::Stretch;
use super::table::table;
use super::{Collision, Observer, ObserverError, Partner, SampleTimes, Snapshot, Verdict, contract};
use crate::quantity::accept;
use crate::statistics::{Estimate, block_average};
use crate::{Disk, ParameterError};

/// An observer that counts how often centers of disks cross a segment, by direction, over intervals of time:
/// the flux through the throat of a silo, or through any line of a gas. The segment does not affect the
/// disks.
///
/// A crossing is *forward* if it goes from the right to the left of the direction from `start` to `end`:
/// upward through a line from left to right. Disks fly on parabolas between two collisions, so each crossing
/// is found exactly, even if a disk turns back between two samples. A center on the line counts as on the
/// left, so a disk that turns back there has crossed the line twice or not at all. An interval counts only if
/// it was watched from its start to its end. In an [`OfKind`](super::OfKind), only disks of one kind count. A
/// run ends with an error if disks change other than by the collisions that the observer receives, as in a
/// [`BetweenKinds`](super::BetweenKinds), which hides other collisions.
///
/// A disk that a wall [absorbs](crate::boundary::Part::absorbing_centers) at the segment has not crossed it:
/// count such disks with [`Arrivals`](super::Arrivals).
///
/// ```
/// use granular_edmd::observable::{Crossings, SampleTimes};
/// use granular_edmd::prelude::*;
///
/// // A disk is thrown up through a line of height 4, comes down again, and bounces up.
/// let disk = Disk::new(DVec2::new(2.0, 3.5), 0.5)?.with_velocity(DVec2::new(0.0, 2.0))?;
/// let mut run = Simulation::builder(Elastic, Container::open(4.0)?).disks([disk]).gravity(1.0).build()?;
/// let line = [DVec2::new(0.0, 4.0), DVec2::new(4.0, 4.0)];
/// let mut crossings = Crossings::new(line, SampleTimes::every(6.0)?)?;
/// run.run_until(12.0, &mut crossings)?;
/// assert_eq!((crossings.forward(), crossings.backward()), (&[1, 1][..], &[1, 1][..]));
/// assert_eq!(crossings.flux()?.mean(), 0.0);
/// assert_eq!(crossings.rates()?.map(|rate| rate.mean()), [1.0 / 6.0; 2]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Crossings {
    line: [DVec2; 2],
    stretch: Stretch,
    pull: DVec2,
    periods: DVec2,
    /// The flight of each disk by its id.
    flights: BTreeMap<u64, Free>,
    present: [u64; 2],
    times: Vec<f64>,
    forward: Vec<u64>,
    backward: Vec<u64>,
    /// The reason why the crossings of this run cannot be found.
    #[cfg_attr(feature = "serde", serde(skip))]
    fault: Option<ParameterError>,
}

/// Rounding of velocities, relative to the speeds of a flight.
const ROUNDING: f64 = 1e-6;

/// Distance from the line within which a removed disk is on the line, relative to lengths.
const ON_LINE: f64 = 1e-9;

/// The free flight of a center since `time`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
struct Free {
    time: f64,
    position: DVec2,
    velocity: DVec2,
}

impl Crossings {
    /// Creates a counter of crossings of the segment between two points, over the intervals between these
    /// times.
    ///
    /// In a periodic domain, the images of the segment count, too.
    ///
    /// # Errors
    /// If a coordinate is not finite, or both points are the same.
    pub fn new(line: [DVec2; 2], times: SampleTimes) -> Result<Self, ParameterError> {
        let length = (line[1] - line[0]).length();
        accept(length.is_finite() && length > 0.0, "length of a line", "finite and positive", length)?;
        Ok(Self {
            line,
            stretch: Stretch::new(times),
            pull: DVec2::ZERO,
            periods: DVec2::ZERO,
            flights: BTreeMap::new(),
            present: [0; 2],
            times: Vec::new(),
            forward: Vec::new(),
            backward: Vec::new(),
            fault: None,
        })
    }

    /// Returns the ends of the intervals.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the number of forward crossings in each interval.
    pub fn forward(&self) -> &[u64] {
        &self.forward
    }

    /// Returns the number of backward crossings in each interval.
    pub fn backward(&self) -> &[u64] {
        &self.backward
    }

    /// Returns the mean numbers of forward and of backward crossings per unit of time, with their errors.
    ///
    /// Through a line of length $`L`$ in a gas of density $`n`$ in equilibrium, both are
    /// $`nL\sqrt{T/2\pi m}`$.
    ///
    /// # Errors
    /// If no interval is complete yet, or only one.
    pub fn rates(&self) -> Result<[Estimate; 2], ParameterError> {
        let interval = self.stretch.sample_times.interval();
        let rate = |counts: &[u64]| {
            block_average(&counts.iter().map(|&count| count as f64 / interval).collect::<Vec<_>>())
        };
        Ok([rate(&self.forward)?, rate(&self.backward)?])
    }

    /// Returns the mean number of forward minus backward crossings per unit of time, with its error.
    ///
    /// In a closed system, whatever has crossed comes back, so short intervals are anticorrelated, and the
    /// error may be ten times too large.
    ///
    /// # Errors
    /// If no interval is complete yet, or only one.
    pub fn flux(&self) -> Result<Estimate, ParameterError> {
        block_average(&self.fluxes().collect::<Vec<_>>())
    }

    fn fluxes(&self) -> impl Iterator<Item = f64> {
        let counts = self.forward.iter().zip(&self.backward);
        counts.map(|(&there, &back)| (there as f64 - back as f64) / self.stretch.sample_times.interval())
    }

    /// Replaces the flight of a disk with `next`, and counts the crossings of the old flight up to the start
    /// of `next`.
    fn go_on(&mut self, id: u64, next: Free) {
        // A filter by kind passes on collisions with disks of other kinds, whose flights are not followed.
        if let Some(flight) = self.flights.get_mut(&id) {
            let flight = std::mem::replace(flight, next);
            self.count(&flight, &next, false);
        }
    }

    /// Counts the crossings of a flight up to the start of the next one. If the disk is `removed` there, a
    /// line through its last position has not been crossed.
    fn count(&mut self, flight: &Free, next: &Free, removed: bool) {
        let elapsed = next.time - flight.time;
        let turns = self.turns(flight.at(elapsed, self.pull) - next.position);
        for image in self.images(flight, elapsed) {
            let along = self.line[1] - self.line[0];
            let across = along.perp();
            // The side of the position at which one flight ends and the next one begins is computed from the
            // same numbers for both flights. Otherwise, a disk that turns back on the line could cross it in
            // one direction only.
            let [from, to] = [(flight, image), (next, image - turns)]
                .map(|(free, image)| free.position - (self.line[0] + self.periods * image));
            let gap = [from.dot(across), flight.velocity.dot(across), 0.5 * self.pull.dot(across)];
            let mut is_forward = to.dot(across) >= 0.0;
            let rate = gap[1] + 2.0 * gap[2] * elapsed;
            if removed && to.dot(across).abs() <= ON_LINE * (along.length() + to.length()) * along.length() {
                is_forward = rate < 0.0;
            }
            for (wait, is_forward) in passages(gap, elapsed, is_forward) {
                let place = (flight.at(wait, self.pull) - flight.position + from).dot(along);
                if (0.0..along.length_squared()).contains(&place) {
                    self.present[usize::from(!is_forward)] += 1;
                }
            }
        }
    }

    /// Returns a displacement in whole periods.
    fn turns(&self, displacement: DVec2) -> DVec2 {
        let turns = (displacement / self.periods).round();
        DVec2::select(self.periods.cmpgt(DVec2::ZERO), turns, DVec2::ZERO)
    }

    /// Returns the displacements, in periods, of the images of the line that a flight may cross.
    fn images(&self, flight: &Free, elapsed: f64) -> Vec<DVec2> {
        if self.periods == DVec2::ZERO {
            return vec![DVec2::ZERO];
        }
        let reach = (flight.velocity.abs() + 0.5 * self.pull.abs() * elapsed) * elapsed;
        let reach = reach + ON_LINE * self.periods;
        let (low, high) = (self.line[0].min(self.line[1]), self.line[0].max(self.line[1]));
        let range = |period: f64, from: f64, to: f64| {
            let ends = if period > 0.0 { [(from / period).ceil(), (to / period).floor()] } else { [0.0; 2] };
            ends[0] as i64..=ends[1] as i64
        };
        let (from, to) = (flight.position - reach - high, flight.position + reach - low);
        let columns = range(self.periods.x, from.x, to.x);
        let rows = |column: i64| range(self.periods.y, from.y, to.y).map(move |row| (column, row));
        columns.flat_map(rows).map(|(column, row)| DVec2::new(column as f64, row as f64)).collect()
    }

    /// Counts the crossings of all flights up to a snapshot, and begins new flights with its disks.
    fn look(&mut self, snapshot: &Snapshot<'_>) {
        for disk in snapshot.disks() {
            let next = Free::of(disk, snapshot.time());
            if self.flights.get(&disk.id()).is_some_and(|flight| !flight.leads_to(&next, self.pull)) {
                let name = "time by which disks have changed otherwise than in the collisions shown";
                self.fault = Some(ParameterError::new(name, "never, for crossings", next.time));
            }
            self.go_on(disk.id(), next);
        }
    }
}

/// Returns the times from 0 to `end` at which `c + b t + a t²` changes sides, and whether it then becomes
/// positive. Zero is on the positive side; `is_forward` is the side at the end.
fn passages([c, b, a]: [f64; 3], end: f64, is_forward: bool) -> impl Iterator<Item = (f64, bool)> {
    let discriminant = b * b - 4.0 * a * c;
    let root = discriminant.max(0.0).sqrt();
    // Both zeros are computed in forms in which nothing cancels.
    let sum = -0.5 * (b + root.copysign(b));
    let (first, second) = (sum / a, c / sum);
    let zeros = if a == 0.0 { [-c / b, f64::NAN] } else { [first.min(second), first.max(second)] };
    let zeros = zeros.map(|zero| (zero, b + 2.0 * a * zero > 0.0));
    let was_forward = c >= 0.0;
    let found = if was_forward == is_forward {
        let is_inside = |(zero, _): (f64, bool)| 0.0 < zero && zero < end;
        let are_passages = discriminant > 0.0 && zeros.into_iter().all(is_inside);
        (are_passages && zeros[0].1 != was_forward)
            .then_some(zeros)
            .map_or([None; 2], |zeros| zeros.map(Some))
    } else {
        let zero = zeros.into_iter().find(|&(zero, rises)| zero.is_finite() && rises == is_forward);
        // Because of rounding, the zero may lie just beyond an end, or vanish.
        let nearest = if c.abs() < (c + (b + a * end) * end).abs() { 0.0 } else { end };
        [Some((zero.map_or(nearest, |(zero, _)| zero.clamp(0.0, end)), is_forward)), None]
    };
    found.into_iter().flatten()
}

impl Free {
    fn of(disk: &Disk, time: f64) -> Self {
        Self { time, position: disk.position(), velocity: disk.velocity() }
    }

    /// Returns the position after a time of flight.
    fn at(&self, elapsed: f64, pull: DVec2) -> DVec2 {
        self.position + (self.velocity + 0.5 * pull * elapsed) * elapsed
    }

    /// Returns whether a disk on this flight has the velocity of the other flight when the other flight
    /// begins.
    fn leads_to(&self, other: &Self, pull: DVec2) -> bool {
        let gained = (other.time - self.time) * pull;
        let speeds = self.velocity.length() + gained.length();
        // Late times are coarse, so the speed that a disk at rest gains between two adjacent times is coarse,
        // too.
        let late = 16.0 * f64::EPSILON * (self.time.abs() + other.time.abs()) * pull.length();
        (self.velocity + gained).distance(other.velocity) <= ROUNDING * speeds + late
    }
}

impl Observer for Crossings {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        (self.pull, self.periods) = (start.gravity().acceleration(), start.domain().periods());
        let disks = start.disks().iter();
        self.flights = disks.map(|disk| (disk.id(), Free::of(disk, start.time()))).collect();
        if self.stretch.begin(start)? {
            self.present = [0; 2];
        }
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        let Collision { time, ids, velocities, position, .. } = *collision;
        self.go_on(ids[0], Free { time, position, velocity: velocities[0] });
        if let Partner::Disk(_) = collision.partner {
            let position = collision.partner_position();
            self.go_on(ids[1], Free { time, position, velocity: velocities[1] });
        }
    }

    fn next_sample(&self) -> f64 {
        self.stretch.sample_times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.look(snapshot);
        let [forward, backward] = std::mem::take(&mut self.present);
        if self.stretch.finish(snapshot.time()).is_some() {
            self.times.push(snapshot.time());
            self.forward.push(forward);
            self.backward.push(backward);
        }
    }

    fn on_insert(&mut self, disk: &Disk, time: f64) {
        self.flights.insert(disk.id(), Free::of(disk, time));
    }

    fn on_remove(&mut self, disk: &Disk, time: f64) {
        if let Some(flight) = self.flights.remove(&disk.id()) {
            self.count(&flight, &Free::of(disk, time), true);
        }
    }

    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.look(end);
        self.stretch.pause(end.time());
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        contract::verdict(&mut self.fault)
    }
}

table! {
    /// The columns are the end of each interval, the crossings in both directions, and their flux.
    Crossings, this: for (((&time, &there), &back), flux) in
        this.times.iter().zip(&this.forward).zip(&this.backward).zip(this.fluxes());
    "time" ["time"]: time,
    "forward" ["1"]: there as f64,
    "backward" ["1"]: back as f64,
    "flux" ["1/time"]: flux
}
