//! The way of a disk relative to a brick, and the times at which it is beside the brick.

use glam::DVec2;

use crate::Flight;

/// The way of a disk's center relative to a brick, from a moment on.
///
/// The center is known up to an error that grows with time. Instead of that, the disk grows: its radius is
/// `radius + widening·t + ½·spread·t²`. A grown disk touches no later than the true one.
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
    /// Creates a way that is known exactly.
    pub(in crate::boundary) const fn exact(
        place: DVec2,
        velocity: DVec2,
        acceleration: DVec2,
        radius: f64,
    ) -> Self {
        Self { place, velocity, acceleration, radius, widening: 0.0, spread: 0.0 }
    }

    /// Returns the way of a flight, from its start on.
    pub(in crate::boundary) fn of(flight: &Flight) -> Self {
        let start = flight.time();
        let (place, velocity) = (flight.position(start), flight.velocity(start));
        Self::exact(place, velocity, flight.acceleration(), flight.radius())
    }

    /// Returns the place of the center after this time.
    pub(super) fn at(&self, time: f64) -> DVec2 {
        self.place + (self.velocity + 0.5 * time * self.acceleration) * time
    }

    /// Returns the same way, seen from a later moment on.
    pub(super) fn later(&self, time: f64) -> Self {
        Self {
            place: self.at(time),
            velocity: self.velocity + self.acceleration * time,
            radius: self.radius + self.growth(time),
            widening: self.widening + self.spread * time,
            ..*self
        }
    }

    /// Returns the same way of a disk that has shrunk from this radius, and goes on to shrink, as this one
    /// has grown.
    pub(super) fn shrinking(&self, radius: f64) -> Self {
        Self { radius: 2.0 * radius - self.radius, widening: -self.widening, spread: -self.spread, ..*self }
    }

    /// Returns by how much the disk grows in this time.
    pub(super) fn growth(&self, time: f64) -> f64 {
        (self.widening + 0.5 * self.spread * time) * time
    }

    /// Returns how far the way is at most from its chord in this time, with the growth of the disk.
    pub(super) fn sagitta(&self, time: f64) -> f64 {
        0.125 * self.acceleration.length() * time * time + self.growth(time)
    }

    /// Returns the distance from a place along a direction, as it changes on the way.
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

    /// Returns the same quantity, larger by a constant and by the growth of the disk on its way.
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

    /// Returns the zeros in the order in which they are computed; they need not be numbers.
    fn zeros(&self) -> [f64; 2] {
        let discriminant = self.rate * self.rate - 2.0 * self.acceleration * self.value;
        // Numbers of equal sign are added, so that nothing cancels.
        let sum = -(self.rate + discriminant.sqrt().copysign(self.rate));
        [sum / self.acceleration, 2.0 * self.value / sum]
    }
}

/// The condition that a disk is beside a brick, not beyond its ends: both quantities are positive, or at
/// least one of them is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    pub(super) quantities: [Parabola; 2],
    pub(super) one_is_enough: bool,
}

impl Beside {
    /// Tells whether the condition holds after this time.
    pub(super) fn holds(&self, time: f64) -> bool {
        let [first, second] = self.quantities.map(|quantity| quantity.at(time) >= 0.0);
        if self.one_is_enough { first || second } else { first && second }
    }

    /// Returns the stretches of time, from 0 to `wait`, in which the condition holds.
    pub(super) fn stretches(&self, wait: f64) -> impl Iterator<Item = (f64, f64)> {
        let [first, second] = self.quantities.map(|quantity| quantity.zeros());
        // Between neighboring times of these, no quantity changes its sign. A time that is not a number or
        // beyond the stretch does no harm at its end.
        let inside = |time: f64| if time > 0.0 && time < wait { time } else { wait };
        let mut marks = [0.0, inside(first[0]), inside(first[1]), inside(second[0]), inside(second[1]), wait];
        marks.sort_by(f64::total_cmp);
        let beside = *self;
        (1..marks.len())
            .map(move |k| (marks[k - 1], marks[k]))
            .filter(move |&(from, to)| (from < to || wait == 0.0) && beside.holds(from + 0.5 * (to - from)))
    }
}
