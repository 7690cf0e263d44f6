//! Predictions of the time at which a disk leaves its cell.

#[cfg(target_arch = "x86_64")]
use super::vector::exits as vector;
use crate::boundary::Region;
use crate::instructions::compiled_for_each;
use crate::simulation::cells::Cells;
use crate::simulation::state::{Bodies, Exit};

compiled_for_each! {
    /// Finds when and where two disks leave their cells. Returns whether they can touch a wall there.
    #[inline(never)]
    pub(in crate::simulation) leave_cells(
        bodies: &mut Bodies, cells: &Cells, first: usize, second: usize, now: f64
    ) -> [bool; 2] = exits_of_both,
        |bodies: &mut Bodies, cells, first, second, now| if pulls_down(bodies) {
            vector::exits_of_both(bodies, cells, first, second, now)
        } else {
            exits_of_both(bodies, cells, first, second, now)
        },
        |bodies: &mut Bodies, cells, first, second, now| if pulls_down(bodies) {
            vector::exits_of_both(bodies, cells, first, second, now)
        } else {
            exits_of_both(bodies, cells, first, second, now)
        }
}

/// Returns whether the vector instructions are written for this gravity: straight down, or zero.
#[inline(always)]
#[cfg(target_arch = "x86_64")]
fn pulls_down(bodies: &Bodies) -> bool {
    bodies.gravity.rightward() == 0.0 && bodies.gravity.downward() >= 0.0
}

#[inline(always)]
fn exits_of_both(bodies: &mut Bodies, cells: &Cells, first: usize, second: usize, now: f64) -> [bool; 2] {
    [leave_cell(bodies, cells, first, now), leave_cell(bodies, cells, second, now)]
}

/// Finds when and where a disk leaves its cell. Returns whether it can touch a wall there.
#[inline(always)]
pub(in crate::simulation) fn leave_cell(bodies: &mut Bodies, cells: &Cells, disk: usize, now: f64) -> bool {
    let (region, at_wall) = cells.region(disk);
    let (due, exit) = cell_exit(bodies, disk, &region, now);
    bodies.exit(disk, due, exit);
    at_wall
}

/// Returns the offset at which a disk leaves its cell, and the edge through which it leaves.
#[inline(always)]
fn cell_exit(bodies: &Bodies, disk: usize, region: &Region, now: f64) -> (f64, Exit) {
    let (position, velocity) = (bodies.position(disk, now), bodies.velocity(disk, now));
    let rightward = velocity.x > 0.0;
    let distance = if rightward { region.max.x - position.x } else { position.x - region.min.x };
    let sideways = distance / velocity.x.abs();
    let (above, below) = (region.max.y - position.y, position.y - region.min.y);
    let (vertical, up) = exit_under_pull(above, below, velocity.y, bodies.gravity.downward());
    let (sideways, rightward) = if bodies.gravity.rightward() == 0.0 {
        (sideways, rightward)
    } else {
        let (left, right) = (position.x - region.min.x, region.max.x - position.x);
        exit_sideways(left, right, velocity.x, bodies.gravity.rightward())
    };
    // For a disk at rest that reaches no edge, the result is NaN, from 0/0 or inf/inf, which means never.
    let sideways = if sideways.is_nan() { f64::INFINITY } else { sideways };
    let level = vertical < sideways;
    // Rounding may have put the disk beyond its edge. It leaves now, and not in the past.
    let wait = if level { vertical } else { sideways }.max(0.0);
    let exit = Exit::EDGES[usize::from(level)][usize::from((level & up) | (!level & rightward))];
    (now + wait, exit)
}

/// Returns the time until a disk leaves its column, and whether it leaves to the right, for gravity to the
/// right. The function is not inlined, since gravity is vertical in most runs.
#[inline(never)]
fn exit_sideways(left: f64, right: f64, velocity: f64, gravity: f64) -> (f64, bool) {
    let (wait, leftward) = exit_under_pull(left, right, -velocity, gravity);
    (wait, !leftward)
}

/// Returns the time until a disk leaves its row, and whether it leaves through the edge above, for gravity
/// that pulls down, or up if it is negative.
#[inline(always)]
fn exit_under_pull(above: f64, below: f64, velocity: f64, gravity: f64) -> (f64, bool) {
    if gravity >= 0.0 {
        return vertical_exit(above, below, velocity, gravity);
    }
    let (wait, down) = vertical_exit(below, above, -velocity, -gravity);
    (wait, !down)
}

/// Returns the time until a disk leaves its row, and whether it leaves through the edge above, for gravity
/// that pulls down.
///
/// There are three paths: up to the edge above, up and down again through the edge below, or straight down.
/// The code selects numbers and does not branch: the path that a disk takes is a coin toss, and a
/// misprediction would cost more than all three roots. Each root has the form in which nothing cancels: a
/// distance divided by a sum of speeds if the disk goes straight to the edge, and a sum of speeds divided by
/// gravity if it turns back.
#[inline(always)]
fn vertical_exit(above: f64, below: f64, velocity: f64, gravity: f64) -> (f64, bool) {
    let (above, below) = (above.max(0.0), below.max(0.0));
    let square = velocity * velocity;
    let reserve = square - 2.0 * gravity * above;
    let reserve = if velocity > 0.0 { reserve } else { -1.0 };
    let radicand = if reserve > 0.0 { reserve } else { square + 2.0 * gravity * below };
    let sum = radicand.sqrt() + velocity.abs();
    let distance = 2.0 * if reserve > 0.0 { above } else { below };
    let turning = if velocity > 0.0 { sum } else { distance };
    let numerator = if reserve > 0.0 { distance } else { turning };
    let turning = if velocity > 0.0 { gravity } else { sum };
    let denominator = if reserve > 0.0 { sum } else { turning };
    let wait = numerator / denominator;
    (if wait.is_nan() { f64::INFINITY } else { wait }, reserve > 0.0)
}
