//! Checks of the surface at a touch: its normal, velocity and radius are derivatives of the gap.

use glam::DVec2;

use super::trial::{PART, Trial};
use crate::boundary::{Boundary, Response, Surface, Touch};
use crate::collision::laws::hostile_contacts;
use crate::error::require;
use crate::{Fingerprint, Violation};

/// Distance that the disk is moved for the gradient of the gap, and largest reach of a gap, both relative to
/// the radius.
const NEAR: f64 = 1e-5;
const REACH: f64 = 0.1;

/// Steps by which the disk is moved for the curvature of the wall, relative to the radius.
const STEPS: [f64; 3] = [REACH, 0.03, 0.01];

/// Smallest displacement of the point of contact, as a fraction of the step, for which the point does not
/// count as a tip.
const TIP: f64 = 0.02;

/// Number of contacts in which the rules of walls are compared.
const CONTACTS: usize = 5;

/// Largest errors: of the squared length of a normal; of slopes, speeds and curvatures; of turning and of the
/// surface of another wall at the same place.
const UNIT: f64 = 1e-9;
const EXACT: f64 = 5e-8;
const SAME: f64 = 1e-6;

/// Checks the surface that a disk touches at this position.
pub(super) fn check_surface(trial: &Trial<'_>, touch: Touch, place: DVec2) -> Result<(), Violation> {
    let Touch { wall, time, .. } = touch;
    let surface = trial.boundary.surface(wall, place, time);
    let [words, again] = [0, 1].map(|_| in_words(&trial.boundary.surface(wall, place, time), CONTACTS));
    require!(PART, "repeatable", again == words; "the surface {words} is {again} when asked for again");
    let Surface { normal, velocity, radius, mass, angular_velocity, .. } = surface;
    let is_unit = (normal.length_squared() - 1.0).abs() <= UNIT;
    require!(PART, "unit normal", is_unit; "the normal {normal:?} of wall {wall} at {place:?}, time {time:?}");
    let is_finite = velocity.is_finite() && angular_velocity.is_finite();
    require!(PART, "finite velocity", is_finite;
        "wall {wall} moves at {velocity:?} and turns at {angular_velocity:?} at {time:?}");
    let is_possible = radius != 0.0 && !radius.is_nan() && mass > 0.0;
    require!(PART, "surface", is_possible; "wall {wall} has the radius {radius:?} and the mass {mass:?}");
    let nearest = trial.gap().nearest(place, REACH * trial.radius, time).map_or(wall, |(wall, _)| wall);
    // Where two walls meet, the gap is that of another wall.
    if nearest == wall || nearest < trial.wall_count && is_same(trial, touch, nearest, place) {
        let around = Around { trial, wall, place, time };
        around.check_slopes(&surface)?;
        around.check_radius(&surface)?;
        around.check_turning(&surface)?;
    }
    Ok(())
}

/// Returns whether another wall has the same surface at a place, as the next brick of a corner.
pub(super) fn is_same(
    trial: &Trial<'_>,
    Touch { wall, time, .. }: Touch,
    other: usize,
    place: DVec2,
) -> bool {
    let [one, two] = [wall, other].map(|wall| trial.boundary.surface(wall, place, time));
    let speeds = one.velocity.length() + trial.speed;
    one.normal.distance(two.normal) <= SAME && one.velocity.distance(two.velocity) <= SAME * speeds
}

/// The surroundings of a touch.
struct Around<'a, 'b> {
    trial: &'a Trial<'b>,
    wall: usize,
    place: DVec2,
    time: f64,
}

impl Around<'_, '_> {
    /// Returns the gap of a disk that is displaced by `moved`.
    fn gap(&self, moved: DVec2, later: f64) -> f64 {
        self.trial.gap().at(self.place + moved, REACH * self.trial.radius, self.time + later)
    }

    /// Checks that the normal is the gradient of the gap, and that the velocity along it is the rate at which
    /// the gap closes at this place.
    fn check_slopes(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { trial, wall, place, time } = self;
        let (normal, velocity, step) = (surface.normal, surface.velocity, NEAR * trial.radius);
        // A fast wall turns its curved places past the disk, even where its speed along the normal is small.
        let scale = velocity.length().max(trial.speed);
        // Far from its place at the origin, a wall that slides lacks digits, and so does a late phase.
        let far = trial.extent() + velocity.length() * time;
        let late = 0.5 * scale * (time + trial.origin);
        let along = |direction: DVec2| move |step: f64| self.gap(step * direction, 0.0);
        let is_gradient =
            has_slope(1.0, step, far, along(normal)) && has_slope(0.0, step, far, along(normal.perp()));
        require!(PART, "normal", is_gradient;
            "the normal {normal:?} of wall {wall} at {place:?}, time {time:?}, is not the gradient of the gap");
        let speed = velocity.dot(normal);
        // No query is about a time before the walls are known.
        let is_early = *time < 2.0 * step / scale;
        let rate = |step: f64| self.gap(DVec2::ZERO, step / scale);
        require!(PART, "velocity", is_early || has_slope(-speed / scale, step, far + late, rate);
            "wall {wall} has the velocity {speed:?} along its normal, but moves otherwise, at {place:?}, \
             {time:?}");
        Ok(())
    }

    /// Checks that the radius agrees with the curvature, if the wall is smooth near the touch. At a corner or
    /// a tip, the radius may have any value.
    fn check_radius(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { trial, wall, place, time } = self;
        let (Surface { normal, radius, velocity, .. }, size) = (*surface, trial.radius);
        let far = trial.extent() + velocity.length() * time;
        let bend = |step: f64| {
            let gap = |count: f64| self.gap(count * step * normal.perp(), 0.0);
            let [second, first, here] = [2.0, 1.0, 0.0].map(|count| gap(count) + gap(-count));
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
            require!(PART, "radius", is_close(1.0 / (radius + size)) || is_close(1.0 / size);
                "wall {wall} has the radius {radius:?}, but gaps around {place:?}, time {time:?}, have the \
                 curvature {narrow:?}");
            break;
        }
        Ok(())
    }

    /// Checks that the angular velocity agrees with the velocities of surface points beside the touch: their
    /// components along the normal differ by the rotation. At a kink or a tip, it is enough that one side
    /// agrees.
    fn check_turning(&self, surface: &Surface<'_>) -> Result<(), Violation> {
        let Self { trial, wall, place, time } = *self;
        let (normal, size, turning) = (surface.normal, trial.radius, surface.angular_velocity);
        let step = NEAR * size;
        let [low, here, high] = [-1.0, 0.0, 1.0].map(|count: f64| {
            let beside = place + count * step * normal.perp();
            let other = trial.boundary.surface(wall, beside, time);
            (beside - size * other.normal, other.velocity.dot(normal))
        });
        let slack = SAME * (turning.abs() + (trial.speed + here.1.abs()) / size);
        let turns =
            [(low, high), (low, here), (here, high)].into_iter().any(|((from, before), (to, after))| {
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
}

/// Returns whether a gap has this slope at 0, on both sides or on one side: the other side may lie beyond a
/// corner or beyond a change of the motion. The gap is rounded like lengths of the size `far`.
fn has_slope(slope: f64, step: f64, far: f64, gap: impl Fn(f64) -> f64) -> bool {
    let slack = EXACT + 16.0 * f64::EPSILON * far / step;
    let [low, below, here, above, high] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|count| gap(count * step));
    let slopes = [above - below, 4.0 * above - 3.0 * here - high, 3.0 * here + low - 4.0 * below];
    slopes.iter().any(|found| (0.5 * found / step - slope).abs() <= slack)
}

/// Returns all data of a surface as text; a rule is represented by a digest of its impulses in this number of
/// contacts, since the impulses would fill a page.
pub(super) fn in_words(surface: &Surface<'_>, contacts: usize) -> String {
    let Response::Rule(rule) = surface.response else { return format!("{surface:?}") };
    let impulses = hostile_contacts().take(contacts).map(|contact| rule.impulse(&contact));
    let digest = impulses.fold(Fingerprint::of("impulses"), |digest, impulse| {
        digest.number(impulse.normal()).number(impulse.tangential()).number(impulse.couple())
    });
    format!("{surface:?} with impulses of the digest {digest}")
}
