//! Checks of the surface at a touch: its normal, velocity and radius are derivatives of the gap.

use glam::DVec2;

use super::meeting::Meeting;
use super::trial::{PART, Trial};
use crate::Violation;
use crate::boundary::{Boundary, Surface, Touch};
use crate::error::require;

/// Distance that the disk is moved for the gradient of the gap, and largest reach of a gap, both relative to
/// the radius.
const NEAR: f64 = 1e-5;
const REACH: f64 = 0.1;

/// Steps by which the disk is moved for the curvature of the wall, relative to the radius.
const STEPS: [f64; 3] = [REACH, 0.03, 0.01];

/// Smallest displacement of the point of contact, as a fraction of the step, for which the point does not
/// count as a tip.
const TIP: f64 = 0.02;

/// Largest errors: of slopes, speeds and curvatures; of turning.
const EXACT: f64 = 5e-8;
const TURNING: f64 = 1e-6;

/// Checks the surface that a disk touches. A number that is NaN or infinite, and a normal that is no unit
/// vector, contradict the gap.
pub(super) fn check_surface(trial: &Trial<'_>, meeting: &Meeting) -> Result<(), Violation> {
    let Meeting { touch: Touch { wall, time, .. }, place, surface, .. } = meeting;
    let Surface { radius, mass, .. } = surface;
    let is_possible = *radius != 0.0 && !radius.is_nan() && *mass > 0.0;
    require!(PART, "surface", is_possible; "wall {wall} has the radius {radius:?} and the mass {mass:?}");
    let nearest = trial.gap().nearest(*place, REACH * trial.radius, *time);
    // Two walls may meet here: the gap then belongs to another wall.
    if nearest.is_none_or(|(nearest, _)| meeting.is_with(trial, nearest)) {
        check_slopes(trial, meeting)?;
        check_radius(trial, meeting)?;
        check_turning(trial, meeting)?;
    }
    Ok(())
}

/// Returns the gap of a disk that is displaced by `moved`.
fn gap(trial: &Trial<'_>, Meeting { touch, place, .. }: &Meeting, moved: DVec2, later: f64) -> f64 {
    trial.gap().at(place + moved, REACH * trial.radius, touch.time + later)
}

/// Checks that the normal is the gradient of the gap, and that the velocity along it is the rate at which the
/// gap closes at this place.
fn check_slopes(trial: &Trial<'_>, meeting: &Meeting) -> Result<(), Violation> {
    let Meeting { touch: Touch { wall, time, .. }, place, surface, .. } = meeting;
    let (Surface { normal, velocity, .. }, step) = (*surface, NEAR * trial.radius);
    // A fast wall turns its curved places past the disk, even where its speed along the normal is small.
    let scale = velocity.length().max(trial.speed);
    // Far from its place at the origin, a wall that slides lacks digits, and so does a late phase.
    let far = trial.extent() + velocity.length() * time;
    let late = 0.5 * scale * (time + trial.origin);
    let along = |direction: DVec2| move |step: f64| gap(trial, meeting, step * direction, 0.0);
    let is_gradient =
        has_slope(1.0, step, far, along(normal)) && has_slope(0.0, step, far, along(normal.perp()));
    require!(PART, "normal", is_gradient;
        "the normal {normal:?} of wall {wall} at {place:?}, time {time:?}, is not the gradient of the gap");
    let speed = velocity.dot(normal);
    // No query is about a time before the walls are known.
    let is_early = *time < 2.0 * step / scale;
    let rate = |step: f64| gap(trial, meeting, DVec2::ZERO, step / scale);
    require!(PART, "velocity", is_early || has_slope(-speed / scale, step, far + late, rate);
        "wall {wall} has the velocity {speed:?} along its normal, but moves otherwise, at {place:?}, {time:?}");
    Ok(())
}

/// Checks that the radius agrees with the curvature, if the wall is smooth near the touch. At a corner or a
/// tip, the radius may have any value.
fn check_radius(trial: &Trial<'_>, meeting: &Meeting) -> Result<(), Violation> {
    let Meeting { touch: Touch { wall, time, .. }, place, surface, .. } = meeting;
    let (Surface { normal, radius, velocity, .. }, size) = (*surface, trial.radius);
    let far = trial.extent() + velocity.length() * time;
    let bend = |step: f64| {
        let gap = |count: f64| gap(trial, meeting, count * step * normal.perp(), 0.0);
        let [second, first, here] = [2.0, 1.0, 0.0].map(|count| gap(count) + gap(-count));
        (16.0 * first - second - 15.0 * here) / (12.0 * step * step)
    };
    // On a wall that is more curved than the disk, only small steps see the wall as smooth.
    for widest in STEPS.map(|step| step * size) {
        let [wide, narrow, least] = [1.0, 0.5, 0.25].map(|share| bend(share * widest));
        let slack = EXACT / size + 256.0 * f64::EPSILON * far / (widest * widest);
        // Near the end of a tip, two of the steps may agree by chance.
        let is_smooth = (wide - narrow).abs() <= slack && (narrow - least).abs() <= 4.0 * slack;
        let is_close = |expected: f64| (narrow - expected).abs() <= slack;
        let is_known = is_close(1.0 / (radius + size)) || is_close(1.0 / size);
        require!(PART, "radius", is_known || !is_smooth;
            "wall {wall} has the radius {radius:?}, but gaps around {place:?}, time {time:?}, have the curvature \
             {narrow:?}");
    }
    Ok(())
}

/// Checks that the angular velocity agrees with the velocities of surface points beside the touch: their
/// components along the normal differ by the rotation. At a kink or a tip, it is enough that one side agrees.
fn check_turning(trial: &Trial<'_>, meeting: &Meeting) -> Result<(), Violation> {
    let Meeting { touch: Touch { wall, time, .. }, place, surface, .. } = meeting;
    let (Surface { normal, angular_velocity: turning, .. }, size) = (*surface, trial.radius);
    let step = NEAR * size;
    let [low, here, high] = [-1.0, 0.0, 1.0].map(|count: f64| {
        let beside = place + count * step * normal.perp();
        let other = trial.boundary.surface(*wall, beside, *time);
        (beside - size * other.normal, other.velocity.dot(normal))
    });
    let slack = TURNING * (turning.abs() + (trial.speed + here.1.abs()) / size);
    let turns = [(low, high), (low, here), (here, high)].into_iter().any(|((from, before), (to, after))| {
        // On a small roller, the point of the touch moves by less than the disk.
        let along = (to - from).dot(normal.perp());
        along < TIP * step || ((before - after) / along - turning).abs() <= slack * (step / along).max(1.0)
    });
    require!(PART, "angular velocity", turns;
        "wall {wall} has the angular velocity {turning:?}, but its velocities around {place:?}, {time:?}, turn \
         it otherwise");
    Ok(())
}

/// Returns whether a gap has this slope at 0, on both sides or on one side: the other side may lie beyond a
/// corner or beyond a change of the motion. The gap is rounded like lengths of the size `far`.
fn has_slope(slope: f64, step: f64, far: f64, gap: impl Fn(f64) -> f64) -> bool {
    let slack = EXACT + 16.0 * f64::EPSILON * far / step;
    let [low, below, here, above, high] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|count| gap(count * step));
    let slopes = [above - below, 4.0 * above - 3.0 * here - high, 3.0 * here + low - 4.0 * below];
    slopes.iter().any(|found| (0.5 * found / step - slope).abs() <= slack)
}
