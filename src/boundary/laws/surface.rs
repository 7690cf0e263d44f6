//! Checks of the surface at a touch, against the depth of overlaps around it.

use glam::DVec2;

use super::seen::{check_name, in_words};
use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Response, Surface, Touch};
use crate::violation::require;

/// Fraction of the radius by which a disk is moved to probe a wall from afar.
const FAR: f64 = 1e-3;

/// Fraction of the radius by which a disk is moved for the gradient of the gap.
const NEAR: f64 = 1e-5;

/// Fraction of the radius by which a disk is enlarged around a touch, and the steps by which it is moved for
/// the curvature of the wall.
const WIDE: f64 = 0.1;
const STEPS: [f64; 3] = [WIDE, 0.03, 0.01];

/// Tangent of the angle by which a disk is turned about the point of its touch.
const ANGLE: f64 = 0.1;

/// Smallest displacement of the point of contact, as a fraction of the step, for which the point does not
/// count as a tip.
const TIP: f64 = 0.02;

/// Number of contacts in which the rule of a wall is compared.
const CONTACTS: usize = 5;

/// Largest errors. `UNIT` holds for the squared length of a normal, and `SLOPE` for the direction of a normal
/// if another wall is equally near. `EXACT` holds for the direction of any other normal, for speeds and for
/// curvatures.
const UNIT: f64 = 1e-9;
const SLOPE: f64 = 0.2;
const EXACT: f64 = 5e-8;
const SAME: f64 = 1e-6;

/// Checks the surface that a disk touches at this position.
pub(super) fn check_surface(trial: &Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let surface = trial.boundary.surface(wall, place, time);
    let found = || {
        let overlap = trial.depth(place, WIDE * trial.radius, time);
        format!("{} in {overlap:?}", in_words(&trial.boundary.surface(wall, place, time), CONTACTS))
    };
    let (words, again) = (found(), found());
    require!(PART, "repeatable", again == words; "the surface {words} is {again} when asked for again");
    let (normal, velocity, radius) = (surface.normal, surface.velocity, surface.radius);
    let is_unit = normal.is_finite() && (normal.length_squared() - 1.0).abs() <= UNIT;
    require!(PART, "unit normal", is_unit;
        "the normal {normal:?} of wall {wall} at {place:?}, time {time:?}");
    require!(PART, "finite velocity", velocity.is_finite();
        "the velocity {velocity:?} of wall {wall} at {time:?}");
    let masses = [surface.mass, surface.tangential_mass];
    let is_guided = masses[1] == f64::INFINITY || !matches!(surface.response, Response::Thermal(_));
    require!(PART, "surface", is_guided;
        "wall {wall} is thermal, and has the tangential mass {:?}; thermal walls are guided", masses[1]);
    let has_masses = masses.iter().all(|&mass| mass > 0.0);
    let are_possible = radius != 0.0 && !radius.is_nan() && has_masses;
    require!(PART, "surface", are_possible;
        "wall {wall} has the radius {radius:?} and the masses {masses:?}");
    check_name(trial, touch, place)?;
    let around = Around { trial, wall, place, time };
    let step = FAR * trial.radius;
    let goes_in = around.at(-step * normal, 0.0).0 - around.at(DVec2::ZERO, 0.0).0 >= (1.0 - SLOPE) * step;
    require!(PART, "normal", goes_in;
        "the normal {normal:?} does not lead out of wall {wall} at {place:?}, {time:?}");
    // Another wall with the same surface at this point, such as the next brick of a corner, is accepted.
    let deepest = around.at(DVec2::ZERO, 0.0).1;
    let other = || around.trial.boundary.surface(deepest, place, time).normal;
    let is_named = deepest == wall || deepest < around.trial.wall_count && other().distance(normal) <= SAME;
    if is_named {
        around.check_normal(&surface)?;
        around.check_velocity(&surface)?;
        around.check_radius(&surface)?;
        around.check_point(&surface)?;
        around.check_turning(&surface)?;
    }
    Ok(())
}

/// Overlaps with a wall around a touch.
struct Around<'a, 'b> {
    trial: &'a Trial<'b>,
    wall: usize,
    place: DVec2,
    time: f64,
}

impl Around<'_, '_> {
    /// Returns the overlap of a slightly larger disk that is displaced by `moved`: its depth and its wall.
    fn at(&self, moved: DVec2, later: f64) -> (f64, usize) {
        let larger = WIDE * self.trial.radius;
        let found = self.trial.depth(self.place + moved, larger, self.time + later);
        found.map_or((-larger, self.wall), |found| (found.depth - larger, found.with))
    }

    /// Returns whether a function of a step has this slope at 0, on both sides or on one side: the other side
    /// may lie beyond a corner or beyond a change of the motion.
    fn has_slope(&self, slope: f64, step: f64, slack: f64, depth: impl Fn(f64) -> f64) -> bool {
        let slack = slack + 16.0 * f64::EPSILON * self.trial.extent() / step;
        let [low, below, here, above, high] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|count| depth(count * step));
        let slopes = [above - below, 4.0 * above - 3.0 * here - high, 3.0 * here + low - 4.0 * below];
        slopes.iter().any(|found| (0.5 * found / step - slope).abs() <= slack)
    }

    /// Returns how far a wall that slides may have come since the origin. Far from its place, it lacks
    /// digits.
    fn travel(&self, surface: &Surface<'_>) -> f64 {
        surface.velocity.length() * self.time
    }

    /// Checks that the normal is the gradient of the gap.
    fn check_normal(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { wall, place, time, .. } = self;
        let (normal, step) = (surface.normal, NEAR * self.trial.radius);
        let slack = EXACT + 16.0 * f64::EPSILON * self.travel(surface) / step;
        let along = |direction: DVec2| move |step: f64| self.at(step * direction, 0.0).0;
        let is_gradient = self.has_slope(-1.0, step, slack, along(normal))
            && self.has_slope(0.0, step, slack, along(normal.perp()));
        require!(PART, "normal", is_gradient;
            "the normal {normal:?} of wall {wall} at {place:?}, time {time:?}, is not the gradient of the \
             gap");
        Ok(())
    }

    /// Checks that the velocity along the normal is the rate at which the gap closes at this position.
    fn check_velocity(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { wall, place, time, .. } = self;
        let speed = surface.velocity.dot(surface.normal);
        // A fast wall turns its curved places past the disk, even where its speed along the normal is small.
        let scale = surface.velocity.length().max(self.trial.speed);
        let step = NEAR * self.trial.radius;
        let slack = EXACT + 8.0 * f64::EPSILON * (time + self.trial.origin) * scale / step;
        // A step is the largest distance that the wall moves. No query is about a time before the walls are
        // known.
        let depth = |step: f64| self.at(DVec2::ZERO, step / scale).0;
        let is_early = time - self.trial.earliest() < 2.0 * step / scale;
        let is_rate = is_early || self.has_slope(speed / scale, step, slack, depth);
        require!(PART, "velocity", is_rate;
            "wall {wall} has the velocity {speed:?} along its normal, but moves otherwise, at {place:?}, \
             {time:?}");
        Ok(())
    }

    /// Checks that other disks that touch the same point find the same velocity there, since it is the
    /// velocity of the material. The other disks are a larger one and, at a tip, one on another side. A belt
    /// that runs around a tip has the same speed on either side.
    fn check_point(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { wall, place, time, .. } = *self;
        let (normal, size, velocity) = (surface.normal, self.trial.radius, surface.velocity);
        let slack = EXACT * (velocity.length() + self.trial.speed);
        let larger = self.trial.boundary.surface(wall, place + 0.5 * size * normal, time);
        let is_same = larger.normal.distance(normal) > UNIT || larger.velocity.distance(velocity) <= slack;
        let other = larger.velocity;
        require!(PART, "velocity", is_same;
            "wall {wall} at {time:?} moves at {velocity:?} for a disk at {place:?}, and at {other:?} for a larger one");
        for turn in [DVec2::new(1.0, ANGLE), DVec2::new(1.0, -ANGLE)] {
            let step = turn.normalize().rotate(normal) - normal;
            let deeper = self.at(size * step, 0.0).0 - self.at(DVec2::ZERO, 0.0).0;
            if deeper.abs() > self.trial.rounding() {
                continue;
            }
            // Beyond a tip, the disk may touch the side of the wall, at another point.
            let beside = self.trial.boundary.surface(wall, place + size * step, time);
            if (size * (step + normal - beside.normal)).length() > EXACT * size {
                continue;
            }
            let other = beside.velocity;
            let is_same = (other - velocity).dot(step.normalize()).abs() <= slack;
            require!(PART, "velocity", is_same;
                "a tip of wall {wall} at {time:?} moves at {velocity:?} for a disk at {place:?}, and at {other:?} for \
                 one beside it");
        }
        Ok(())
    }

    /// Checks that the angular velocity agrees with the velocities of surface points beside the touch: their
    /// components along the normal differ by the rotation. At a kink or a tip, it is enough that one side
    /// agrees. A free drum is not checked, since its angular velocity follows from its velocity.
    fn check_turning(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { wall, place, time, .. } = *self;
        let (normal, size, turning) = (surface.normal, self.trial.radius, surface.angular_velocity);
        require!(PART, "angular velocity", turning.is_finite();
            "wall {wall} turns at {turning:?} at {place:?}, time {time:?}");
        if surface.tangential_mass.is_finite() && surface.radius.is_finite() {
            return Ok(());
        }
        let step = NEAR * size;
        let [low, here, high] = [-1.0, 0.0, 1.0].map(|count: f64| {
            let beside = place + count * step * normal.perp();
            let other = self.trial.boundary.surface(wall, beside, time);
            (beside - size * other.normal, other.velocity.dot(normal))
        });
        let slack = SAME * (turning.abs() + (self.trial.speed + here.1.abs()) / size);
        let mut pairs = [(low, high), (low, here), (here, high)].into_iter();
        let turns = pairs.any(|((from, before), (to, after))| {
            // On a small roller, the point of the touch moves by less than the disk.
            let along = (to - from).dot(normal.perp());
            along < TIP * step
                || ((before - after) / along - turning).abs() <= slack * (step / along).max(1.0)
        });
        require!(PART, "angular velocity", turns;
            "wall {wall} has the angular velocity {turning:?}, but its velocities around {place:?}, {time:?}, turn \
             it otherwise");
        Ok(())
    }

    /// Checks that the radius agrees with the curvature, if the wall is smooth near the touch. At a corner or
    /// a tip, the radius may have any value.
    fn check_radius(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { wall, place, time, .. } = self;
        let Surface { normal, radius, .. } = *surface;
        let far = self.trial.extent() + self.travel(surface);
        let size = self.trial.radius;
        let bend = |step: f64| {
            let depth = |count: f64| self.at(count * step * normal.perp(), 0.0).0;
            let [second, first, here] = [2.0, 1.0, 0.0].map(|count| depth(count) + depth(-count));
            (16.0 * first - second - 15.0 * here) / (12.0 * step * step)
        };
        // On a wall that is more curved than the disk, only small steps see the wall as smooth.
        for widest in STEPS.map(|step| step * size) {
            let [wide, narrow, least] = [1.0, 0.5, 0.25].map(|share| bend(share * widest));
            let slack = EXACT / size + 256.0 * f64::EPSILON * far / (widest * widest);
            // Near the end of a tip, two of the steps may agree by chance.
            if (wide - narrow).abs() > slack || (narrow - least).abs() > 4.0 * slack {
                continue;
            }
            let is_close = |expected: f64| (narrow - expected).abs() <= slack;
            let is_curvature = is_close(-1.0 / (radius + size)) || is_close(-1.0 / size);
            require!(PART, "radius", is_curvature;
                "wall {wall} has the radius {radius:?}, but depths around {place:?}, time {time:?}, have the \
                 curvature {narrow:?}");
            break;
        }
        Ok(())
    }
}
