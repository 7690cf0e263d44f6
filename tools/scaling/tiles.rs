//! A settled state of any size: boxes of the paper's width side by side.
//!
//! Settling a million disks from a lattice takes an hour. A thousand disks settle quickly, and snapshots of
//! them at different times, side by side, are a settled state of a wide box. Every second snapshot is
//! mirrored, so that the flow continues across the seam.

use std::cmp::Ordering;

use granular_edmd::Disk;
use granular_edmd::glam::DVec2;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_xoshiro::Xoshiro256PlusPlus;

use benches::Outcome;
use benches::state::{Run, State, WIDTH, oscillate};

/// The numbering of disks, which decides how far apart neighbors are in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Numbering {
    /// Numbers by narrow columns from left to right. Neighbors in space have near numbers.
    ByPlace,
    /// Numbers at random, as after a long time in which the disks have mixed.
    Mixed,
}

impl Numbering {
    pub(crate) const ALL: [Self; 2] = [Self::ByPlace, Self::Mixed];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::ByPlace => "by place",
            Self::Mixed => "mixed",
        }
    }
}

/// Snapshots of one settled box, an oscillation apart.
pub(crate) struct Tiles {
    snapshots: Vec<Vec<Disk>>,
}

impl Tiles {
    /// Settles one box in this state, and takes `count` snapshots of it.
    pub(crate) fn settled(state: &State, settle: u32, count: usize) -> Outcome<Self> {
        let mut run = state.settled(1, settle)?;
        let snapshots = (0..count).map(|_| next(&mut run)).collect::<Outcome<_>>()?;
        Ok(Self { snapshots })
    }

    /// Returns the disks of `boxes` boxes side by side.
    pub(crate) fn disks(&self, boxes: usize, numbering: Numbering) -> Outcome<Vec<Disk>> {
        let mut disks = Vec::new();
        for (place, snapshot) in self.snapshots.iter().take(boxes).enumerate() {
            for disk in snapshot {
                disks.push(placed(disk, place)?);
            }
        }
        match numbering {
            Numbering::ByPlace => disks.sort_by(by_place),
            Numbering::Mixed => disks.shuffle(&mut Xoshiro256PlusPlus::seed_from_u64(1)),
        }
        Ok(disks)
    }
}

/// Compares two disks by their places. Columns are a diameter wide.
fn by_place(one: &Disk, other: &Disk) -> Ordering {
    let place = |disk: &Disk| (disk.position().x.floor(), disk.position().y);
    place(one).partial_cmp(&place(other)).unwrap_or(Ordering::Equal)
}

fn next(run: &mut Run) -> Outcome<Vec<Disk>> {
    oscillate(run, 1)?;
    Ok(run.disks())
}

/// Returns a disk of the box at this place in the row, with an id yet to be given.
fn placed(disk: &Disk, place: usize) -> Outcome<Disk> {
    let disk = disk.with_id(0)?;
    let (position, velocity, spin) = (disk.position(), disk.velocity(), disk.angular_velocity());
    let left = WIDTH * place as f64;
    if place.is_multiple_of(2) {
        return Ok(disk.with_position(DVec2::new(left + position.x, position.y))?);
    }
    let mirrored = disk.with_position(DVec2::new(left + WIDTH - position.x, position.y))?;
    Ok(mirrored.with_velocity(DVec2::new(-velocity.x, velocity.y))?.with_angular_velocity(-spin)?)
}
