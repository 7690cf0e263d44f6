//! Checks that the contents of a checkpoint fit together.
//!
//! The seal of a file reveals accidents. The numbers behind it were written by a run, so only lengths and
//! indices are checked: a difference between the saved run and the given boundary must be an error, and must
//! not be a panic or a request for all memory. A file that was forged on purpose may continue unphysically.

use super::{CheckpointError, Saved};
use crate::simulation::cells::{CELLS_PER_DISK, Cells, Layout, Layouts, SPARE_CELLS, SPARE_DISKS};
use crate::simulation::state::Exit;

pub(super) fn check(valid: bool, what: &'static str) -> Result<(), CheckpointError> {
    if valid { Ok(()) } else { Err(CheckpointError::Inconsistent(what.to_owned())) }
}

/// Checks everything that does not depend on the cells.
pub(super) fn check_lengths(saved: &Saved, walls: usize) -> Result<(), CheckpointError> {
    let count = saved.trajectories.len();
    let lengths = [saved.spins.len(), saved.forecasts.len(), saved.places.len()];
    check(lengths.iter().all(|&length| length == count), "its parts differ in length")?;
    check([0, count].contains(&saved.images.len()), "the number of images is not the number of disks")?;
    check(saved.identities.suits(count), "its ids do not fit the number of disks")?;
    check([1, count].contains(&saved.models.len()), "its models do not fit the number of disks")?;
    let times = [saved.clock.origin, saved.clock.now, saved.clock.epoch_length];
    check(times.iter().all(|time| time.is_finite()) && times[2] > 0.0, "a time is not finite")?;
    let mut forecasts = saved.forecasts.iter();
    let are_walls = forecasts.all(|event| event.exit != Exit::Wall || usize::from(event.wall) < walls);
    check(are_walls, "an event names no wall")
}

/// Checks that the grids have a class for each disk, and no more cells than the disks need.
pub(super) fn check_layouts(
    saved: &Saved,
    mut diameters: impl Iterator<Item = f64>,
) -> Result<(), CheckpointError> {
    let Layouts { smallest, larger, classes } = &saved.layouts;
    let disks = 2 * saved.places.len() + SPARE_DISKS;
    let most = 2.0 * (CELLS_PER_DISK * disks as f64 + SPARE_CELLS);
    let suits = |Layout { columns, rows, .. }: Layout| {
        columns.min(rows) > 0 && f64::from(columns) * f64::from(rows) <= most
    };
    let suits_all = suits(*smallest) && larger.iter().all(|layer| layer.homes().is_some_and(suits));
    let largest = classes.last().map_or(0.0, |class| class.largest);
    let have_a_class = classes.len() == larger.len() + 1 && diameters.all(|diameter| diameter <= largest);
    check(suits_all && have_a_class, "its neighbor cells do not fit the disks")
}

/// Checks that each disk is in a cell of its grid.
pub(super) fn check_places(saved: &Saved, cells: &Cells) -> Result<(), CheckpointError> {
    let are_cells = saved.places.iter().enumerate().all(|(disk, place)| {
        let Layout { columns, rows, .. } = cells.grid_of(disk).layout;
        (1..=columns).contains(&place.column) && (1..=rows).contains(&place.row)
    });
    check(are_cells, "a disk is outside the neighbor cells")
}
