//! The path of a disk relative to a brick, and the times at which the disk is beside the brick.

use glam::DVec2;

use crate::Flight;

/// The path of a disk's center relative to a brick, from a given time on.
///
/// The center is known up to an error that grows with time. To allow for it, the disk grows: its radius is
/// `radius + widening·t + ½·spread·t²`. The grown disk touches no later than the actual disk.
#[derive(Debug, Clone, Copy)]
pub(in crate::boundary) struct Path {
    pub(in crate::boundary) place: DVec2,
    pub(in crate::boundary) velocity: DVec2,
    pub(in crate::boundary) acceleration: DVec2,
    pub(in crate::boundary) radius: f64,
    pub(in crate::boundary) widening: f64,
    pub(in crate::boundary) spread: f64,
}

impl Path {
    /// Returns the path of a flight from a time on.
    pub(in crate::boundary) fn of(flight: &Flight, from: f64) -> Self {
        let (place, velocity) = (flight.position(from), flight.velocity(from));
        let (acceleration, radius) = (flight.acceleration(), flight.radius());
        Self { place, velocity, acceleration, radius, widening: 0.0, spread: 0.0 }
    }

    /// Returns the position of the center after this time.
    pub(super) fn at(&self, time: f64) -> DVec2 {
        self.place + (self.velocity + 0.5 * time * self.acceleration) * time
    }

    /// Returns the same path, from a later time on.
    pub(super) fn later(&self, time: f64) -> Self {
        Self {
            place: self.at(time),
            velocity: self.velocity + self.acceleration * time,
            radius: self.radius + self.growth(time),
            widening: self.widening + self.spread * time,
            ..*self
        }
    }

    /// Returns the same path for a disk that shrinks from `radius` as fast as the disk on this path grows.
    pub(super) fn shrinking(&self, radius: f64) -> Self {
        Self { radius: 2.0 * radius - self.radius, widening: -self.widening, spread: -self.spread, ..*self }
    }

    /// Returns the growth of the disk in this time.
    pub(super) fn growth(&self, time: f64) -> f64 {
        (self.widening + 0.5 * self.spread * time) * time
    }

    /// Returns the largest distance of the path from its chord in this time, plus the growth of the disk.
    pub(super) fn sagitta(&self, time: f64) -> f64 {
        0.125 * self.acceleration.length() * time * time + self.growth(time)
    }

    /// Returns the distance from a point along a direction, as a function of time.
    pub(super) fn along(&self, place: DVec2, direction: DVec2) -> Parabola {
        Parabola {
            value: (self.place - place).dot(direction),
            rate: self.velocity.dot(direction),
            acceleration: self.acceleration.dot(direction),
        }
    }
}

/// A quantity that changes with constant acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parabola {
    pub(super) value: f64,
    pub(super) rate: f64,
    pub(super) acceleration: f64,
}

impl Parabola {
    pub(super) fn at(&self, time: f64) -> f64 {
        self.value + (self.rate + 0.5 * self.acceleration * time) * time
    }

    /// Returns the same quantity, larger by a constant and by the growth of the disk on its path.
    pub(super) fn widened(&self, by: f64, path: &Path) -> Self {
        Self {
            value: self.value + by,
            rate: self.rate + path.widening,
            acceleration: self.acceleration + path.spread,
        }
    }

    pub(super) fn negated(&self) -> Self {
        Self { value: -self.value, rate: -self.rate, acceleration: -self.acceleration }
    }

    /// Returns the zeros, in no particular order. A zero that does not exist is infinite or not a number.
    fn zeros(&self) -> [f64; 2] {
        let discriminant = self.rate * self.rate - 2.0 * self.acceleration * self.value;
        // The sum adds numbers of equal sign, so nothing cancels.
        let sum = -(self.rate + discriminant.sqrt().copysign(self.rate));
        [sum / self.acceleration, 2.0 * self.value / sum]
    }
}

/// The condition that a disk is beside a brick, not beyond its ends. It holds if both quantities are at least
/// 0; for some bricks, one of them is enough.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    pub(super) quantities: [Parabola; 2],
    pub(super) one_is_enough: bool,
}

impl Beside {
    /// Returns whether the condition holds at this time.
    pub(super) fn holds(&self, time: f64) -> bool {
        let [first, second] = self.quantities.map(|quantity| quantity.at(time) >= 0.0);
        if self.one_is_enough { first || second } else { first && second }
    }

    /// Returns the intervals of time, from 0 to `wait`, in which the condition holds.
    pub(super) fn stretches(&self, wait: f64) -> impl Iterator<Item = (f64, f64)> {
        let [first, second] = self.quantities.map(|quantity| quantity.zeros());
        // Between neighboring marks, no quantity changes its sign. A zero that is not a number or is outside
        // the interval is replaced by the end of the interval, where it is harmless.
        let inside = |time: f64| if time > 0.0 && time < wait { time } else { wait };
        let mut marks = [0.0, inside(first[0]), inside(first[1]), inside(second[0]), inside(second[1]), wait];
        marks.sort_by(f64::total_cmp);
        let beside = *self;
        (1..marks.len())
            .map(move |k| (marks[k - 1], marks[k]))
            .filter(move |&(from, to)| (from < to || wait == 0.0) && beside.holds(from + 0.5 * (to - from)))
    }
}
