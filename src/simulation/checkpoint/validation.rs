//! Checks that the contents of a checkpoint are a state from which the engine can continue.
//!
//! A checksum reveals accidents but not intent: anyone can compute it anew over any numbers. Therefore, all
//! numbers must pass the bounds of the constructors, and all events must be at possible places and times. A
//! run that continues from such contents may be unphysical, but it neither panics nor hangs.

use std::collections::HashMap;

use super::{CheckpointError, Saved};
use crate::disk::{LARGEST, MOST_DISKS};
use crate::simulation::Counters;
use crate::simulation::cells::{
    CELLS_PER_DISK, Cells, FEWEST, Grid, Layout, Layouts, Place, SPARE_CELLS, SPARE_DISKS, SizeClass,
};
use crate::simulation::state::{Bodies, Clock, Exit, Forecast, Guard, Spin, Trajectory};
use glam::DVec2;

/// Number of events that no run reaches.
const MOST_COUNTED: u64 = 1 << 60;

/// Allowance for rounding, in sizes of a cell, of the grid or of a disk. It is much more than rounding needs.
const SLACK: f64 = 1e-3;

/// Number of epochs ahead within which a touch with a wall, or the horizon of its search, must lie. It is
/// large, since a collision may have made epochs shorter after the search.
const MOST_EPOCHS: f64 = 1e6;

/// The message about cells that do not suit the domain or the disks.
pub(super) const MISFIT: &str = "its neighbor cells do not fit the domain or the disks";

pub(super) fn check(valid: bool, what: &'static str) -> Result<(), CheckpointError> {
    if valid { Ok(()) } else { Err(CheckpointError::Inconsistent(what.to_owned())) }
}

/// Checks everything that does not depend on the cells.
pub(super) fn check_numbers(saved: &Saved, walls: usize) -> Result<(), CheckpointError> {
    let count = saved.trajectories.len();
    let lengths = [saved.spins.len(), saved.forecasts.len(), saved.places.len()];
    check(lengths.iter().all(|&length| length == count), "its parts differ in length")?;
    check([0, count].contains(&saved.images.len()), "the number of images is not the number of disks")?;
    check(saved.identities.suits(count), "its ids do not fit the number of disks")?;
    check([1, count].contains(&saved.models.len()), "its models do not fit the number of disks")?;
    let diameter = saved.typical_diameter;
    let is_diameter = if count == 0 { diameter >= 0.0 } else { diameter > 0.0 };
    check(is_diameter && diameter <= LARGEST, "its typical diameter is beyond all bounds")?;
    let Clock { origin, now, epoch_length, guard, tally, .. } = saved.clock;
    let times = [origin, now, epoch_length];
    check(times.iter().all(|time| time.is_finite()), "a time is not finite")?;
    check(is_bounded(saved.gravity), "its gravity is beyond all bounds")?;
    check(is_epoch_length(epoch_length) && now >= 0.0, "its epoch is out of order")?;
    check(saved.trajectories.iter().all(is_trajectory), "a trajectory is beyond all bounds")?;
    check(saved.spins.iter().all(|spin| is_spin(spin, now)), "a rotation is beyond all bounds")?;
    check(are_forecasts(saved, walls), "an event names no disk or wall, or is overdue")?;
    check(are_counted(&saved.counters) && is_guard(&guard), "its counters are impossibly large")?;
    let Counters { cell_crossings, disk_collisions, .. } = saved.counters;
    let forward = tally.cell_crossings <= cell_crossings && tally.collisions <= disk_collisions;
    check(forward, "its counters run backwards")
}

/// Checks that all disks are in their proper cells, and that their events are at possible times and places.
/// The cells are still empty.
pub(super) fn check_places(saved: &Saved, cells: &Cells, bodies: &Bodies) -> Result<(), CheckpointError> {
    let now = saved.clock.now;
    let disks = || saved.forecasts.iter().zip(&saved.places).enumerate();
    let is_placed = |(disk, (_, &place))| is_cell(&cells.grid_of(disk).layout, place);
    check(disks().all(is_placed), MISFIT)?;
    let inside = |(disk, (_, &place))| holds(cells.grid_of(disk), place, bodies.position(disk, now));
    check(disks().all(inside), "a disk is outside its neighbor cell")?;
    // The cells at walls extend to infinity, so they do not keep disks in the domain. Rounding needs much
    // less than a radius.
    let within = |disk| saved.domain.contains(bodies.position(disk, now), bodies.radius(disk));
    check((0..saved.places.len()).all(within), "a disk is outside the domain")?;
    check(has_room(saved, cells, bodies), "the disks of a cell overlap")?;
    let ends = |(disk, (forecast, &place))| {
        ends_where_it_can(saved, cells.grid_of(disk), bodies, disk, forecast, place)
    };
    check(disks().all(ends), "a cell exit is not at the edge of the cell of its disk")?;
    let meets = |(disk, (forecast, _))| meets_its_partner(saved, bodies, disk, forecast);
    check(disks().all(meets), "a disk collides with one that it does not touch")
}

/// Returns whether the cells suit the domain, and disks of these diameters.
pub(super) fn are_layouts(saved: &Saved, diameters: impl ExactSizeIterator<Item = f64>) -> bool {
    let Layouts { smallest, larger, classes } = &saved.layouts;
    let suits_all = |least: f64| {
        suits(saved, smallest, least)
            && larger.iter().zip(&classes[1..]).all(|(layer, class)| {
                layer.homes().is_some_and(|homes| suits(saved, &homes, class.largest))
                    && layer.is_narrow_enough(&saved.domain, smallest, least, class.largest)
            })
    };
    are_classes(classes, larger.len() + 1, diameters) && suits_all(classes[0].largest)
}

/// Returns whether these are `number` classes in order, and each disk has one of them. There cannot be far
/// more or far fewer disks than in the classes, since new cells would have been made.
fn are_classes(classes: &[SizeClass], number: usize, diameters: impl ExactSizeIterator<Item = f64>) -> bool {
    let are_sizes = classes
        .iter()
        .all(|class| class.smallest > 0.0 && class.smallest <= class.largest && class.largest <= LARGEST);
    let are_ordered = classes.windows(2).all(|pair| pair[0].largest < pair[1].smallest);
    let (now, before) =
        (diameters.len(), classes.iter().fold(0, |sum: usize, class| sum.saturating_add(class.count)));
    let are_as_many = now <= 2 * before.min(MOST_DISKS) + SPARE_DISKS && before <= 2 * now + SPARE_DISKS;
    let mut diameters = diameters;
    let have_a_class = diameters.all(|diameter| {
        let class = classes.iter().find(|class| diameter <= class.largest);
        class.is_some_and(|class| number == 1 || diameter >= class.smallest)
    });
    classes.len() == number && are_sizes && are_ordered && are_as_many && have_a_class
}

/// Returns whether the cells suit the domain and disks of at most this diameter.
fn suits(saved: &Saved, layout: &Layout, diameter: f64) -> bool {
    let Layout { columns, rows, pitch, .. } = *layout;
    let disks = 2 * saved.places.len() + SPARE_DISKS;
    let most = 2.0 * (CELLS_PER_DISK * disks as f64 + SPARE_CELLS);
    let covers = |count: u32, pitch: f64, length: f64| {
        length.is_infinite() || (f64::from(count) * pitch / length - 1.0).abs() < SLACK
    };
    let wide = |count: u32, pitch: f64| count == 1 || pitch > diameter;
    columns.min(rows) > 0
        && f64::from(columns) * f64::from(rows) <= most
        && (f64::from(columns) >= FEWEST || !saved.domain.periodic_sides)
        && (f64::from(rows) >= FEWEST || !saved.domain.periodic_ends)
        && covers(columns, pitch.x, saved.domain.width())
        && covers(rows, pitch.y, saved.domain.height())
        && wide(columns, pitch.x)
        && wide(rows, pitch.y)
        && pitch.is_finite()
}

/// Returns whether a place belongs to a cell of the domain, not to the ring around the cells.
fn is_cell(layout: &Layout, place: Place) -> bool {
    (1..=layout.columns).contains(&place.column) && (1..=layout.rows).contains(&place.row)
}

/// Returns whether the length is a power of two. Other lengths would not add up without rounding.
fn is_epoch_length(length: f64) -> bool {
    const FRACTION: u64 = (1 << 52) - 1;
    length.is_normal() && length > 0.0 && length.to_bits() & FRACTION == 0
}

fn is_bounded(vector: DVec2) -> bool {
    vector.x.abs() <= LARGEST && vector.y.abs() <= LARGEST
}

fn is_trajectory(trajectory: &Trajectory) -> bool {
    is_bounded(trajectory.position) && is_bounded(trajectory.velocity)
}

/// Returns whether a rotation is bounded, and its last collision is not in the future.
fn is_spin(spin: &Spin, now: f64) -> bool {
    spin.angle.is_finite() && spin.angular_velocity.abs() <= LARGEST && spin.last_collision <= now
}

fn is_guard(guard: &Guard) -> bool {
    guard.since.is_finite() && guard.before <= MOST_COUNTED
}

fn are_counted(counters: &Counters) -> bool {
    let Counters { disk_collisions, wall_collisions, contact_duration_collisions, .. } = *counters;
    let Counters { cell_crossings, repredictions, horizons, cell_resizes, removals, insertions, .. } =
        *counters;
    let physics =
        [disk_collisions, wall_collisions, contact_duration_collisions, counters.least_rebound_collisions];
    let bookkeeping = [cell_crossings, repredictions, horizons, cell_resizes, removals, insertions];
    physics.iter().chain(&bookkeeping).chain([&counters.wall_jumps]).all(|&count| count <= MOST_COUNTED)
        && [
            counters.max_overlap,
            counters.max_wall_overlap,
            counters.farthest_jump,
            counters.longest_contact,
            counters.energy_of_rebounds,
        ]
        .iter()
        .all(|&way| way >= 0.0)
}

fn are_forecasts(saved: &Saved, walls: usize) -> bool {
    let count = saved.forecasts.len();
    saved.forecasts.iter().enumerate().all(|(disk, forecast)| {
        let Forecast { collision_due, exit_due, partner, partner_collisions, collisions, exit, wall } =
            *forecast;
        let is_alone = collision_due == f64::INFINITY;
        // After the removal of a partner, a forecast may name another index, even the disk's own.
        let is_old = partner as usize >= count || partner_collisions != collisions;
        (is_alone || partner as usize != disk || is_old)
            && (exit != Exit::Wall || usize::from(wall) < walls)
            && collision_due >= saved.clock.now
            && exit_due >= saved.clock.now
    })
}

/// Returns whether a disk at this position belongs in this cell.
fn holds(grid: &Grid, place: Place, position: DVec2) -> bool {
    let (region, slack) = (grid.region(place), SLACK * grid.layout.pitch);
    position.is_finite()
        && position.cmpge(region.min - slack).all()
        && position.cmple(region.max + slack).all()
}

/// Returns whether there is room for the disks in their cells without overlaps.
fn has_room(saved: &Saved, cells: &Cells, bodies: &Bodies) -> bool {
    let domain = &saved.domain;
    let mut taken: HashMap<(u8, usize), (f64, f64)> = HashMap::new();
    saved.places.iter().enumerate().all(|(disk, &place)| {
        let radius = bodies.radius(disk);
        let grid = cells.grid_of(disk);
        let (area, largest) = taken.entry((cells.class(disk), grid.index(place))).or_default();
        *area += std::f64::consts::PI * radius * radius;
        *largest = largest.max(radius);
        let region = grid.region(place);
        let low = region.min.max(DVec2::new(domain.left, domain.bottom)) - *largest;
        let size = region.max.min(DVec2::new(domain.right, domain.top)) + *largest - low;
        // The densest packing of equal disks has an area fraction of 0.91. Its difference from 1 leaves more
        // room than the slack of the cells needs.
        *area <= size.x * size.y
    })
}

/// Returns whether the flight of a disk in its cell ends at the edge that its forecast names, or at a wall or
/// horizon that is not too far in the future.
fn ends_where_it_can(
    saved: &Saved,
    grid: &Grid,
    bodies: &Bodies,
    disk: usize,
    forecast: &Forecast,
    place: Place,
) -> bool {
    let Forecast { exit, exit_due, .. } = *forecast;
    if !exit.is_passage() {
        return exit_due == f64::INFINITY
            || exit_due - saved.clock.now <= MOST_EPOCHS * saved.clock.epoch_length;
    }
    if exit_due == f64::INFINITY {
        return true;
    }
    let (region, pitch) = (grid.region(place), grid.layout.pitch);
    let position = bodies.position(disk, exit_due);
    let (gap, size) = match exit {
        Exit::Left => (position.x - region.min.x, pitch.x),
        Exit::Right => (position.x - region.max.x, pitch.x),
        Exit::Down => (position.y - region.min.y, pitch.y),
        _ => (position.y - region.max.y, pitch.y),
    };
    // The rows of open containers grow with the height.
    let size = size.max(SLACK * position.y.abs());
    gap.abs() <= SLACK * size && is_cell(&grid.layout, grid.neighbor(place, exit.direction()).0)
}

/// Returns whether a disk and its partner touch at the time of their predicted collision. An outdated
/// prediction passes, since the engine replaces it when its event is due.
fn meets_its_partner(saved: &Saved, bodies: &Bodies, disk: usize, forecast: &Forecast) -> bool {
    let Forecast { collision_due, partner, partner_collisions, .. } = *forecast;
    let is_soon = collision_due.is_finite()
        && collision_due - saved.clock.now <= MOST_EPOCHS * saved.clock.epoch_length;
    let partner = partner as usize;
    let is_current = saved.forecasts.get(partner).is_some_and(|other| other.collisions == partner_collisions);
    if !(is_soon && is_current) {
        return true;
    }
    let here = bodies.position(disk, collision_due);
    let distance = saved.domain.separation(bodies.position(partner, collision_due), here).length();
    let touching = bodies.radius(disk) + bodies.radius(partner);
    (distance - touching).abs() <= SLACK * touching
}
