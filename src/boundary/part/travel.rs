//! Motions of the parts of a container, and flights in the frame of a moving part.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::boundary::Region;
use crate::boundary::brick::{Brick, Path};
use crate::boundary::domain::direction;
use crate::wall::{Motion, Stroke};
use crate::{Fingerprint, Flight};

/// Number of pieces into which a turn is divided. On each piece, a flight in the turning frame counts as a
/// parabola with an error.
const PIECES: f64 = 16.0;

/// The motion of a part: along a direction, about a point, both, or neither.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(in crate::boundary) struct Travel {
    pub(super) along: Option<Along>,
    pub(super) turning: Option<Turning>,
}

/// A motion along a direction, which is a unit vector.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(super) struct Along {
    pub(super) direction: DVec2,
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::wall::motion_or_piston"))]
    pub(super) motion: Motion,
}

/// The rotation of a part about a point, which moves with the part.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(in crate::boundary) struct Turning {
    pub(in crate::boundary) about: DVec2,
    pub(in crate::boundary) angular_velocity: f64,
    /// True if all bricks are circles about the point, so that only the surface velocity shows the rotation.
    /// Files do not hold this flag.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(super) is_round: bool,
}

/// The phases of both motions of a part. Each phase is the time minus whole periods of the motion.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::boundary) struct Phase {
    along: f64,
    turning: f64,
}

impl Phase {
    /// Returns the phase at a later time.
    pub(in crate::boundary) fn after(self, time: f64) -> Self {
        Self { along: time + self.along, turning: time + self.turning }
    }

    /// Returns the phase relative to another one.
    pub(super) fn since(self, start: Self) -> Self {
        Self { along: self.along - start.along, turning: self.turning - start.turning }
    }

    /// Returns the larger magnitude of the two phases.
    pub(in crate::boundary) fn size(self) -> f64 {
        self.along.abs().max(self.turning.abs())
    }
}

/// A flight in the frame of a part, from one time to a later one.
pub(in crate::boundary) struct Look {
    pub(in crate::boundary) path: Path,
    pub(in crate::boundary) until: f64,
}

/// The position of a part at a time: the part is turned about the origin by the angle of a unit vector, then
/// shifted.
#[derive(Debug, Clone, Copy)]
pub(in crate::boundary) struct Pose {
    turn: DVec2,
    shift: DVec2,
}

impl Pose {
    /// Transforms a point from the frame at rest to the frame of the part.
    pub(in crate::boundary) fn inward(&self, place: DVec2) -> DVec2 {
        unturned(self.turn, place - self.shift)
    }

    /// Transforms a point from the frame of the part to the frame at rest.
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

impl Along {
    /// Returns the displacement at a phase.
    fn shift(&self, phase: f64) -> DVec2 {
        self.direction * self.motion.state(phase).displacement
    }

    /// Returns the path in the frame that moves along a direction, with the acceleration in the middle of its
    /// bounds.
    fn look(&self, path: &Path, phase: f64, time: f64) -> Look {
        let (state, bounds) = (self.motion.state(time + phase), self.motion.acceleration(time + phase));
        // The true acceleration differs from the middle by at most half of the range. The disk therefore
        // grows less than with any other choice.
        let middle = bounds.min + 0.5 * (bounds.max - bounds.min);
        let path = Path {
            place: path.place - self.direction * state.displacement,
            velocity: path.velocity - self.direction * state.velocity,
            acceleration: path.acceleration - self.direction * middle,
            spread: 0.5 * (bounds.max - bounds.min),
            ..*path
        };
        Look { path, until: bounds.until - phase }
    }
}

impl Turning {
    fn period(&self) -> f64 {
        TAU / self.angular_velocity.abs()
    }

    /// Returns the path in the frame that turns. The errors of both frames add.
    fn look(&self, look: &Look, phase: f64, time: f64, longest: f64) -> Look {
        let Self { about, angular_velocity, .. } = *self;
        let turn = direction(angular_velocity * (time + phase));
        let wait = longest.min(TAU / (PIECES * angular_velocity.abs())).min((look.until - time).max(0.0));
        let Path { place, velocity, acceleration, spread, .. } = look.path;
        let turned = turning_path(place - about, velocity, acceleration, angular_velocity, wait);
        let path = Path {
            place: about + unturned(turn, turned.place),
            velocity: unturned(turn, turned.velocity),
            acceleration: unturned(turn, turned.acceleration),
            spread: turned.spread + spread,
            ..look.path
        };
        Look { path, until: time + wait }
    }
}

impl Travel {
    pub(in crate::boundary) fn is_at_rest(&self) -> bool {
        self.along.is_none() && self.frame().is_none()
    }

    /// Returns the rotation of the part's frame, or `None` if the frame does not turn.
    pub(in crate::boundary) fn frame(&self) -> Option<&Turning> {
        self.turning.as_ref().filter(|turning| !turning.is_round)
    }

    /// Returns the phases of the motions at a time origin: the origin minus whole periods.
    pub(in crate::boundary) fn phase(&self, origin: f64) -> Phase {
        Phase {
            along: self.along.as_ref().map_or(0.0, |along| along.motion.phase(origin)),
            turning: self.frame().map_or(0.0, |turning| origin % (TAU / turning.angular_velocity)),
        }
    }

    /// Returns the displacement of the part along its direction, at a phase.
    pub(in crate::boundary) fn shift(&self, phase: Phase) -> DVec2 {
        self.along.as_ref().map_or(DVec2::ZERO, |along| along.shift(phase.along))
    }

    /// Returns the displacement along the direction, and the phase of this motion reduced to a period. For a
    /// part that only turns, the phase is the time within a turn.
    pub(in crate::boundary) fn moved(&self, phase: Phase) -> Option<(DVec2, f64)> {
        let turning = || self.frame().map(|turning| phase.turning % turning.period());
        let along = self.along.as_ref().map(|along| along.motion.phase(phase.along));
        along.or_else(turning).map(|reduced| (self.shift(phase) + DVec2::ZERO, reduced))
    }

    /// Returns the piston, if the part has a mass.
    pub(in crate::boundary) fn piston(&self) -> Option<&Stroke> {
        self.along.as_ref().and_then(|along| along.motion.stroke())
    }

    /// Returns the mass that an impulse along this normal meets.
    pub(in crate::boundary) fn mass(&self, normal: DVec2) -> f64 {
        let along = self.along.as_ref().map_or(0.0, |along| along.direction.dot(normal));
        self.piston().map_or(f64::INFINITY, |piston| piston.mass() / (along * along))
    }

    /// Returns the position of the part at a phase.
    pub(in crate::boundary) fn pose(&self, phase: Phase) -> Pose {
        let shift = self.shift(phase);
        let Some(Turning { about, angular_velocity, .. }) = self.frame() else {
            return Pose { turn: DVec2::X, shift };
        };
        let turn = direction(angular_velocity * phase.turning);
        Pose { turn, shift: *about - turn.rotate(*about) + shift }
    }

    /// Returns the angular velocity of the part.
    pub(in crate::boundary) fn angular_velocity(&self) -> f64 {
        self.turning.map_or(0.0, |turning| turning.angular_velocity)
    }

    /// Returns the velocity of the part at a point, at a phase.
    pub(in crate::boundary) fn velocity(&self, place: DVec2, phase: Phase) -> DVec2 {
        let along = self.along.as_ref();
        let along = along.map(|along| along.direction * along.motion.state(phase.along).velocity);
        let arm = |about: DVec2| place - (about + self.shift(phase));
        let turning = self.turning.map(|turning| turning.angular_velocity * arm(turning.about).perp());
        along.into_iter().chain(turning).reduce(|a, b| a + b).unwrap_or(DVec2::ZERO)
    }

    /// Returns a flight in the frame of the part, from a time on and for at most `longest`. `phase` is the
    /// phase at time 0.
    pub(in crate::boundary) fn look(&self, flight: &Flight, phase: Phase, time: f64, longest: f64) -> Look {
        let path = Path::of(flight, time);
        let look = match &self.along {
            Some(along) => along.look(&path, phase.along, time),
            None => Look { path, until: f64::INFINITY },
        };
        match self.frame() {
            Some(turning) => turning.look(&look, phase.turning, time, longest),
            None => look,
        }
    }

    /// Returns the shortest period of the motions, or `None` if none of them is periodic.
    pub(in crate::boundary) fn period(&self) -> Option<f64> {
        let along = self.along.as_ref().and_then(|along| along.motion.period());
        along.into_iter().chain(self.frame().map(Turning::period)).reduce(f64::min)
    }

    /// Returns the smallest and largest displacement along the direction.
    fn reach(&self) -> (f64, f64) {
        self.along.as_ref().map_or((0.0, 0.0), |along| along.motion.reach())
    }

    /// Returns the distance between the ends of the motion's reach; 0 for a part that does not move along a
    /// direction.
    pub(in crate::boundary) fn stroke(&self) -> f64 {
        self.reach().1 - self.reach().0
    }

    /// Returns the time, at most `wait`, until the disk enters the brick's strip: all positions at which the
    /// disk touches the brick at some phase. `path` is in the frame at rest.
    pub(in crate::boundary) fn wait_to_enter_strip(
        &self,
        brick: &Brick,
        path: &Path,
        wait: f64,
    ) -> Option<f64> {
        let (mut path, mut stroke) = (*path, DVec2::ZERO);
        if let Some(Along { direction, motion }) = &self.along {
            let (low, high) = motion.reach();
            path.place -= *direction * (low + 0.5 * (high - low));
            stroke = 0.5 * (high - low) * *direction;
        }
        match self.frame() {
            Some(Turning { about, .. }) => {
                path.radius += stroke.length();
                brick.wait_to_enter_ring(&path, *about, wait)
            }
            None if self.along.is_some() => brick.wait_to_enter_strip(&path, stroke, wait),
            None => Some(0.0),
        }
    }

    /// Returns whether a brick of the part comes within `reach` of a region at any time.
    pub(in crate::boundary) fn may_reach(&self, brick: &Brick, region: &Region, reach: f64) -> bool {
        let (low, high) = self.reach();
        let reach = reach + low.abs().max(high.abs());
        let Some(Turning { about, .. }) = self.frame() else { return brick.is_near(region, reach) };
        let (nearest, farthest) = brick.distances(*about);
        let from = about.clamp(region.min, region.max).distance(*about);
        let to = (region.min - *about).abs().max((region.max - *about).abs()).length();
        from <= farthest + reach && to >= nearest - reach
    }

    /// Returns whether a brick of a part that does not turn comes within `reach` of a region while its
    /// displacement is in this range.
    pub(in crate::boundary) fn may_reach_in(
        &self,
        (low, high): (f64, f64),
        brick: &Brick,
        region: &Region,
        reach: f64,
    ) -> bool {
        let middle = self.along.as_ref().map_or(DVec2::ZERO, |along| 0.5 * (low + high) * along.direction);
        brick.is_near(&region.shifted(-middle), reach + 0.5 * (high - low))
    }

    /// Returns a rectangle that holds a brick of the part at all times.
    pub(in crate::boundary) fn bounds(&self, brick: &Brick) -> Region {
        let turned = |&Turning { about, .. }: &Turning| Region::around(about, brick.distances(about).1);
        let Region { min, max } = self.frame().map_or_else(|| brick.bounds(), turned);
        let Some(Along { direction, motion }) = &self.along else { return Region::new(min, max) };
        let (back, on) = motion.reach();
        let (back, on) = (*direction * back, *direction * on);
        Region::new(min + back.min(on), max + back.max(on))
    }

    pub(in crate::boundary) fn fingerprint(&self) -> Option<Fingerprint> {
        let turning = self.turning.map(|Turning { about, angular_velocity, is_round }| {
            let name = Fingerprint::of(if is_round { "Spinning" } else { "Turning" });
            name.number(about.x).number(about.y).number(angular_velocity)
        });
        let Some(Along { direction, motion }) = &self.along else {
            return Some(turning.unwrap_or(Fingerprint::of("Rest")));
        };
        let along = Fingerprint::of("Along").number(direction.x).number(direction.y);
        let along = along.part(motion.fingerprint()?);
        Some(turning.map_or(along, |turning| along.part(turning)))
    }
}

/// Returns a path in the frame that turns about the origin, with the largest error of this path in this time.
/// The components of the path refer to axes that do not turn.
///
/// The third derivative of the path there is $`-3\omega a_\perp - 3\omega^2 v + \omega^3 r_\perp`$. A bound
/// on it, times a third of the time, is an acceleration that bounds the error.
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
