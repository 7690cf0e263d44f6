//! Disks that move and grow.

use glam::DVec2;

use super::Enclosure;
use crate::boundary::Squares;
use crate::boundary::{Boundary, Domain, Probe};
use crate::collision::Elastic;
use crate::initial::{PlacementError, scattered_mix, with_maxwellian_velocities};
use crate::observable::{Collision, stop_when};
use crate::{Disk, ParameterError, Simulation};

/// Area fraction at which the disks begin to grow. It is so low that random positions are found fast, for any
/// mix of radii.
const START: f64 = 0.35;

/// Factor by which the radii shrink for the next attempt, if obstacles leave less room than the area
/// suggests.
const SMALLER: f64 = 0.7;

/// Number of attempts to find random positions.
const ATTEMPTS: i32 = 8;

/// Number of collisions per disk between two steps of growth. With fewer collisions, packing is faster, but
/// jams at a lower density.
const COLLISIONS: usize = 4;

/// Longest time between two steps, in which a disk of the largest size moves by about its radius.
const LONGEST: f64 = 1.0;

/// Smallest mass, in units of the largest disk's mass.
const LEAST_MASS: f64 = 1e-20;

/// Fraction of a gap into which a disk may grow, so that it touches nothing.
const SHARE: f64 = 0.99;

/// Disks that are growing to their full radii.
pub(super) struct Packing<'a> {
    /// The disks with their full radii.
    full: &'a [Disk],
    /// The disks in their present states.
    grown: Vec<Disk>,
}

impl<'a> Packing<'a> {
    /// Shrinks the disks until there is room for them, and places them at random.
    pub(super) fn begin<B: Boundary + ?Sized>(
        room: &Enclosure<B>,
        full: &'a [Disk],
        fraction: f64,
        seed: u64,
    ) -> Result<Self, PlacementError> {
        let mut scale = (START / fraction).sqrt().min(1.0);
        for _ in 1..ATTEMPTS {
            match placed(room, full, scale, seed) {
                Err(PlacementError::NoRoom { .. }) => scale *= SMALLER,
                other => return Ok(Self { full, grown: other? }),
            }
        }
        Ok(Self { full, grown: placed(room, full, scale, seed)? })
    }

    /// Returns whether all disks have their full radii.
    pub(super) fn is_done(&self) -> bool {
        self.grown.iter().zip(self.full).all(|(disk, full)| disk.radius() >= full.radius())
    }

    /// Returns the share of the disks' area that is missing.
    pub(super) fn missing(&self) -> f64 {
        let largest = largest(self.full);
        let area = |disk: &Disk| (disk.radius() / largest) * (disk.radius() / largest);
        1.0 - self.grown.iter().map(area).sum::<f64>() / self.full.iter().map(area).sum::<f64>()
    }

    /// Returns the present positions of the disks.
    pub(super) fn places(&self) -> impl Iterator<Item = DVec2> {
        self.grown.iter().map(Disk::position)
    }

    /// Moves the disks for a while, with collisions.
    pub(super) fn stir<B: Boundary + ?Sized>(&mut self, room: &Enclosure<B>) -> Result<(), PlacementError> {
        let disks = self.grown.iter().copied();
        let mut run = Simulation::builder(Elastic, room.clone()).disks(disks).build()?;
        let mut left = COLLISIONS * self.grown.len();
        let mut enough = stop_when(|_: &Collision| {
            left -= 1;
            left == 0
        });
        // The run goes on for a while: a single disk that stops at each fourth collision is always at a wall.
        let ended =
            run.run_until(LONGEST, &mut enough).and_then(|_| run.run_until(1.1 * run.time(), &mut ()));
        ended.map_err(|error| PlacementError::Run { reason: error.to_string() })?;
        self.grown = run.disks();
        Ok(())
    }

    /// Grows each disk into the room around it.
    pub(super) fn grow<B: Boundary + ?Sized>(&mut self, room: &Enclosure<B>) -> Result<(), ParameterError> {
        let domain = room.domain();
        let mut squares = Squares::new(&domain, self.full.iter().map(Disk::radius));
        for (index, (disk, full)) in self.grown.iter().zip(self.full).enumerate() {
            // Disks are entered with their full radii. Two that do not overlap even then never hinder each
            // other.
            squares.add(disk.position(), full.radius(), index);
        }
        for index in 0..self.grown.len() {
            let disk = self.grown[index];
            let radius = self.free_radius(index, &domain, &squares);
            let radius = radius.min(radius_inside(room, &disk, radius));
            // Disks that grow later see this disk as it is now, so that no two grow into the same gap.
            if radius > disk.radius() {
                self.grown[index] = resized(&disk, radius)?;
            }
        }
        Ok(())
    }

    /// Returns the radius to which a disk may grow so that its neighbors keep room to grow, too; at most its
    /// full radius.
    fn free_radius(&self, index: usize, domain: &Domain, squares: &Squares) -> f64 {
        let (disk, full) = (&self.grown[index], self.full[index].radius());
        let most = |other: usize| {
            let (neighbor, neighbor_full) = (&self.grown[other], self.full[other].radius());
            let is_growing = neighbor.radius() < neighbor_full;
            let share = if is_growing { full / (full + neighbor_full) } else { 1.0 };
            let distance = domain.separation(disk.position(), neighbor.position()).length();
            disk.radius() + SHARE * share * (distance - disk.radius() - neighbor.radius())
        };
        if disk.radius() >= full {
            return full;
        }
        squares.near(disk.position(), full).filter(|&other| other != index).map(most).fold(full, f64::min)
    }
}

/// Returns the disks in motion at random positions, with their radii multiplied by this factor. An error has
/// the radius relative to the largest.
fn placed<B: Boundary + ?Sized>(
    room: &Enclosure<B>,
    full: &[Disk],
    scale: f64,
    seed: u64,
) -> Result<Vec<Disk>, PlacementError> {
    let largest = largest(full);
    let small = |disk: &Disk| {
        let mass = (disk.radius() / largest) * (disk.radius() / largest);
        let small = Disk::new(DVec2::ZERO, scale * disk.radius())?;
        small.with_kind(disk.kind()).with_mass(mass.max(LEAST_MASS))
    };
    let disks = full.iter().map(small).collect::<Result<Vec<_>, _>>()?;
    let disks = scattered_mix(room, disks, room.domain().top, seed).map_err(|error| match error {
        PlacementError::NoPosition { count, placed, radius, interior } => {
            PlacementError::NoRoom { count, placed, radius: radius / (scale * largest), interior }
        }
        error => error,
    })?;
    // At this temperature, a disk of the largest size moves by about its radius in a unit of time.
    Ok(with_maxwellian_velocities(disks, largest * largest, seed)?)
}

/// Returns a radius of at most `radius` with which this disk overlaps no wall; 0 if there is no such radius.
fn radius_inside<B: Boundary + ?Sized>(room: &Enclosure<B>, disk: &Disk, radius: f64) -> f64 {
    let probe = Probe::of(disk, 0.0).with_radius(radius);
    let Some(overlap) = room.overlap(&probe) else { return radius };
    let free = radius - overlap.depth / SHARE;
    if room.overlap(&probe.with_radius(free)).is_none() { free } else { 0.0 }
}

fn resized(disk: &Disk, radius: f64) -> Result<Disk, ParameterError> {
    let resized = Disk::new(disk.position(), radius)?.with_kind(disk.kind());
    resized.with_velocity(disk.velocity())?.with_mass(disk.mass())
}

fn largest(disks: &[Disk]) -> f64 {
    disks.iter().map(Disk::radius).fold(0.0, f64::max)
}
