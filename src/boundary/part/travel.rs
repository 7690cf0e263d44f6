//! Motions of the parts of a vessel, and flights in the frame of a moving part.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::boundary::Region;
use crate::boundary::brick::{Brick, Path};
use crate::boundary::vector::direction;
use crate::wall::Motion;
use crate::{Fingerprint, Flight};

/// Number of pieces of a turn. On each piece, a flight in the turning frame counts as a parabola with an
/// error.
const PIECES: f64 = 16.0;

/// The motion of a part.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, rename_all = "snake_case"))]
pub(in crate::boundary) enum Travel {
    /// The part stays where it is.
    Rest,
    /// The part moves along a direction, which is a unit vector.
    Along { direction: DVec2, motion: Motion },
    /// The part turns about a point.
    Turning { about: DVec2, angular_velocity: f64 },
    /// The part turns about a point, and all its bricks are circles about that point, so only its surface
    /// moves.
    Spinning { about: DVec2, angular_velocity: f64 },
}

/// A flight in the frame of a part, from one moment to a later one.
pub(in crate::boundary) struct Look {
    pub(in crate::boundary) path: Path,
    pub(in crate::boundary) until: f64,
}

/// The place of a part at a time: the part is turned about the origin by the angle of a unit vector, then
/// shifted.
#[derive(Debug, Clone, Copy)]
pub(in crate::boundary) struct Pose {
    turn: DVec2,
    shift: DVec2,
}

impl Pose {
    /// Transforms a place from the frame at rest to the frame of the part.
    pub(in crate::boundary) fn inward(&self, place: DVec2) -> DVec2 {
        unturned(self.turn, place - self.shift)
    }

    /// Transforms a place from the frame of the part to the frame at rest.
    pub(in crate::boundary) fn outward(&self, place: DVec2) -> DVec2 {
        self.turn.rotate(place) + self.shift
    }

    /// Transforms a direction from the frame of the part to the frame at rest.
    pub(in crate::boundary) fn direction_outward(&self, direction: DVec2) -> DVec2 {
        self.turn.rotate(direction)
    }
}

fn unturned(turn: DVec2, vector: DVec2) -> DVec2 {
    DVec2::new(turn.x, -turn.y).rotate(vector)
}

impl Travel {
    pub(in crate::boundary) fn is_at_rest(&self) -> bool {
        matches!(self, Self::Rest | Self::Spinning { .. })
    }

    /// Returns the phase of the motion at a time origin: the origin less whole periods.
    pub(in crate::boundary) fn phase(&self, origin: f64) -> f64 {
        match self {
            Self::Rest | Self::Spinning { .. } => 0.0,
            Self::Along { motion, .. } => motion.phase(origin),
            Self::Turning { angular_velocity, .. } => origin % (TAU / angular_velocity),
        }
    }

    /// Returns the place of the part at a phase.
    pub(in crate::boundary) fn pose(&self, phase: f64) -> Pose {
        match self {
            Self::Rest | Self::Spinning { .. } => Pose { turn: DVec2::X, shift: DVec2::ZERO },
            Self::Along { direction, motion } => {
                Pose { turn: DVec2::X, shift: *direction * motion.state(phase).displacement }
            }
            Self::Turning { about, angular_velocity } => {
                let turn = direction(angular_velocity * phase);
                Pose { turn, shift: *about - turn.rotate(*about) }
            }
        }
    }

    /// Returns the velocity of the part at a place, at a phase.
    pub(in crate::boundary) fn velocity(&self, place: DVec2, phase: f64) -> DVec2 {
        match self {
            Self::Rest => DVec2::ZERO,
            Self::Along { direction, motion } => *direction * motion.state(phase).velocity,
            Self::Turning { about, angular_velocity } | Self::Spinning { about, angular_velocity } => {
                *angular_velocity * (place - *about).perp()
            }
        }
    }

    /// Describes a flight in the frame of the part, from a time on and for at most `longest`. The phase is
    /// that of time 0.
    pub(in crate::boundary) fn look(&self, flight: &Flight, phase: f64, time: f64, longest: f64) -> Look {
        let (place, velocity, pull) = (flight.position(time), flight.velocity(time), flight.acceleration());
        match self {
            Self::Rest | Self::Spinning { .. } => {
                Look { path: Path::exact(place, velocity, pull, flight.radius()), until: f64::INFINITY }
            }
            Self::Along { direction, motion } => {
                let (state, bounds) = (motion.state(time + phase), motion.acceleration(time + phase));
                let middle = bounds.min + 0.5 * (bounds.max - bounds.min);
                let path = Path {
                    place: place - *direction * state.displacement,
                    velocity: velocity - *direction * state.velocity,
                    acceleration: pull - *direction * middle,
                    radius: flight.radius(),
                    widening: 0.0,
                    spread: 0.5 * (bounds.max - bounds.min),
                };
                Look { path, until: bounds.until - phase }
            }
            Self::Turning { about, angular_velocity } => {
                let turn = direction(angular_velocity * (time + phase));
                let wait = longest.min(TAU / (PIECES * angular_velocity.abs()));
                let path = turning_path(place - *about, velocity, pull, *angular_velocity, wait);
                let path = Path {
                    place: *about + unturned(turn, path.place),
                    velocity: unturned(turn, path.velocity),
                    acceleration: unturned(turn, path.acceleration),
                    radius: flight.radius(),
                    ..path
                };
                Look { path, until: time + wait }
            }
        }
    }

    /// Returns the period of the motion, if there is one.
    pub(in crate::boundary) fn period(&self) -> Option<f64> {
        match self {
            Self::Rest | Self::Spinning { .. } => None,
            Self::Along { motion, .. } => motion.period(),
            Self::Turning { angular_velocity, .. } => Some(TAU / angular_velocity.abs()),
        }
    }

    /// Returns the distance between the ends of the motion's reach; 0 for a part that does not move along a
    /// direction.
    pub(in crate::boundary) fn stroke(&self) -> f64 {
        if let Self::Along { motion, .. } = self { motion.reach().1 - motion.reach().0 } else { 0.0 }
    }

    /// Returns how long it takes, at most `wait`, until a disk on this path in the frame at rest enters the
    /// strip that a brick of the part sweeps: all places at which the disk touches the brick at some phase.
    pub(in crate::boundary) fn wait_to_enter_strip(
        &self,
        brick: &Brick,
        path: &Path,
        wait: f64,
    ) -> Option<f64> {
        match self {
            Self::Rest | Self::Spinning { .. } => Some(0.0),
            Self::Along { direction, motion } => {
                let (low, high) = motion.reach();
                let path = Path { place: path.place - *direction * (low + 0.5 * (high - low)), ..*path };
                brick.wait_to_enter_strip(&path, 0.5 * (high - low) * *direction, wait)
            }
            Self::Turning { about, .. } => brick.wait_to_enter_ring(path, *about, wait),
        }
    }

    /// Tells whether a brick of the part comes within `reach` of a region at any time.
    pub(in crate::boundary) fn may_reach(&self, brick: &Brick, region: &Region, reach: f64) -> bool {
        match self {
            Self::Rest | Self::Spinning { .. } => brick.is_near(region, reach),
            Self::Along { motion, .. } => {
                let (low, high) = motion.reach();
                brick.is_near(region, reach + low.abs().max(high.abs()))
            }
            Self::Turning { about, .. } => {
                let (nearest, farthest) = brick.distances(*about);
                let from = about.clamp(region.min, region.max).distance(*about);
                let to = (region.min - *about).abs().max((region.max - *about).abs()).length();
                from <= farthest + reach && to >= nearest - reach
            }
        }
    }

    /// Returns a rectangle that holds a brick of the part at all times. Its edges may be infinite.
    pub(in crate::boundary) fn bounds(&self, brick: &Brick) -> (DVec2, DVec2) {
        let (low, high) = brick.bounds();
        match self {
            Self::Rest | Self::Spinning { .. } => (low, high),
            Self::Along { direction, motion } => {
                let (back, on) = motion.reach();
                let (back, on) = (*direction * back, *direction * on);
                (low + back.min(on), high + back.max(on))
            }
            Self::Turning { about, .. } => {
                let (_, farthest) = brick.distances(*about);
                (*about - farthest, *about + farthest)
            }
        }
    }

    pub(in crate::boundary) fn fingerprint(&self) -> Option<Fingerprint> {
        let turning = |name: &str, about: DVec2, angular_velocity: f64| {
            Fingerprint::of(name).number(about.x).number(about.y).number(angular_velocity)
        };
        Some(match self {
            Self::Rest => Fingerprint::of("Rest"),
            Self::Along { direction, motion } => {
                let along = Fingerprint::of("Along").number(direction.x).number(direction.y);
                along.part(motion.fingerprint()?)
            }
            Self::Turning { about, angular_velocity } => turning("Turning", *about, *angular_velocity),
            Self::Spinning { about, angular_velocity } => turning("Spinning", *about, *angular_velocity),
        })
    }
}

/// Returns a path in the frame that turns about the origin, with the error that it can have in this time. Its
/// components refer to axes that do not turn.
///
/// The third derivative of the path there is $`-3\omega a_\perp - 3\omega^2 v + \omega^3 r_\perp`$. A bound
/// of it, times a third of the time, is an acceleration that bounds the error.
fn turning_path(place: DVec2, velocity: DVec2, pull: DVec2, angular_velocity: f64, wait: f64) -> Path {
    let turning = angular_velocity;
    let acceleration = pull - 2.0 * turning * velocity.perp() - turning * turning * place;
    let fall = pull.length() * wait;
    let speed = velocity.length() + fall;
    let distance = place.length() + speed * wait;
    let rate = turning.abs();
    let jerk = rate * (3.0 * pull.length() + rate * (3.0 * speed + rate * distance));
    let velocity = velocity - turning * place.perp();
    Path { place, velocity, acceleration, radius: 0.0, widening: 0.0, spread: jerk * wait / 3.0 }
}
