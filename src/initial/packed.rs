//! Disks packed at random.

mod enclosure;

use std::f64::consts::PI;

use enclosure::Enclosure;
use glam::DVec2;

use super::{PlacementError, countable};
use crate::boundary::{Boundary, Domain, Probe, Squares};
use crate::collision::Elastic;
use crate::initial::{scattered_mix, with_maxwellian_velocities};
use crate::observable::{Collision, stop_when};
use crate::quantity::accept;
use crate::random::{Stream, derived_seed};
use crate::{Disk, ParameterError, Simulation};

/// Number of growth steps with too little change after which the disks count as jammed.
const PATIENCE: usize = 100;

/// Fraction of the missing area that must be gained in these steps.
const LEAST_GAIN: f64 = 0.05;

/// Relative amount by which disks are enlarged while they are packed, so that no two overlap after rounding.
const APART: f64 = 1e-9;

/// Returns these disks, of any mix of radii, packed at random below the height `below` (or the lid, if that
/// is lower). If the ends are periodic and the period is not higher than `below`, disks also lie across the
/// edge.
///
/// The disks start small at random positions, and move and collide without loss. Step by step, each of them
/// grows into the room that it finds, until it has its full radius. Disks of two sizes reach an area fraction
/// of 0.8 and more without order. Equal disks crystallize above 0.7, as they do in any packing: they form
/// crystal grains with boundaries between them. The returned disks have the order, radii, masses and
/// velocities of the given ones.
///
/// The disks are packed in the interior of the boundary, in which walls must not move. If a container has a
/// piston that falls fast, add the piston after the disks are packed. To pack disks around a disk that is
/// already placed, put that disk into the container as a
/// [peg](crate::boundary::Container::with_pegs).
///
/// Source: similar to B. D. Lubachevsky and F. H. Stillinger, J. Stat. Phys. **60**, 561 (1990), where
/// all disks grow at the same rate all the time.
///
/// # Errors
/// If the height is not finite and above the bottom of the interior, there are more than 2²⁸ disks, or the
/// disks find no room, or they jam. The error of a jam names the area fraction of the disks in the rectangle
/// of the interior below the height. Also if a periodic boundary is too narrow for the engine, if the
/// boundary breaks its contract, or if it has a piston that falls among the disks.
///
/// ```
/// use std::f64::consts::PI;
/// use granular_edmd::boundary::Container;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::initial::{self, Radii};
/// use granular_edmd::Disk;
///
/// // Two sizes around an intruder, at the area fraction 0.8.
/// let container = Container::open(24.0)?;
/// let intruder = Disk::new(DVec2::new(12.0, 6.0), 3.0)?;
/// let disks = initial::disks_from_radii(Radii::two_sizes(0.5, 0.7, 0.5)?.draw(300, 1), 1.0)?;
/// let area: f64 = disks.iter().chain([&intruder]).map(|disk| PI * disk.radius() * disk.radius()).sum();
/// let height = area / (0.8 * container.width());
/// let around = container.with_pegs([intruder])?;
/// let packed = initial::packed_mix(&around, disks, height, 1)?;
/// assert!(packed.iter().all(|disk| disk.position().y + disk.radius() <= height));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn packed_mix<B: Boundary + ?Sized>(
    boundary: &B,
    disks: Vec<Disk>,
    below: f64,
    seed: u64,
) -> Result<Vec<Disk>, PlacementError> {
    countable(disks.len())?;
    if disks.is_empty() {
        return Ok(disks);
    }
    let room = Enclosure::new(boundary, below)?;
    let area = room.domain().width() * room.domain().height();
    accept(area > 0.0, "area of the room for the disks", "positive", area)?;
    let wider = disks.iter().map(|disk| disk.with_radius(disk.radius() * (1.0 + APART)));
    let wider = wider.collect::<Result<Vec<_>, _>>()?;
    let seed = derived_seed(seed, Stream::Packing, 0);
    let packing = grown(&room, &wider, area, seed).map_err(|error| match error {
        // A heavy piston hardly moves while disks are packed, so a moving piston is reported only if the
        // packing fails.
        PlacementError::Run { ref reason } => {
            room.check_walls(reason).map_or_else(PlacementError::from, |()| error)
        }
        error => with_full_radius(error, &disks),
    })?;
    let packed = disks.iter().zip(&packing.grown).map(|(disk, grown)| disk.with_position(grown.position()));
    Ok(packed.collect::<Result<_, _>>()?)
}

/// Replaces the initial radius in an error, relative to the largest, by the full radius of the disk that
/// finds no room.
fn with_full_radius(error: PlacementError, disks: &[Disk]) -> PlacementError {
    let PlacementError::NoRoom { count, placed, radius: share, interior } = error else { return error };
    let largest = disks.iter().map(Disk::radius).fold(0.0, f64::max);
    let off = |radius: &f64| (radius / largest - share).abs();
    let radius = disks.iter().map(Disk::radius).min_by(|a, b| off(a).total_cmp(&off(b)));
    PlacementError::NoRoom { count, placed, radius: radius.unwrap_or(largest), interior }
}

/// Moves and grows the disks alternately until all have reached their radii, or are jammed. `area` is the
/// free area of `room`.
fn grown<'a, B: Boundary + ?Sized>(
    room: &Enclosure<B>,
    disks: &'a [Disk],
    area: f64,
    seed: u64,
) -> Result<Packing<'a>, PlacementError> {
    let wanted = disks.iter().map(|disk| PI * disk.radius() * disk.radius()).sum::<f64>() / area;
    accept(wanted < 1.0, "area fraction of the disks", "less than 1", wanted)?;
    let mut packing = Packing::begin(room, disks, wanted, seed)?;
    let (mut steps, mut before) = (0, f64::INFINITY);
    while !packing.is_done() {
        packing.stir(room)?;
        packing.grow(room)?;
        steps += 1;
        if steps % PATIENCE == 0 {
            let missing = packing.missing();
            if missing > (1.0 - LEAST_GAIN) * before {
                return Err(PlacementError::Jammed { reached: (1.0 - missing) * wanted, wanted });
            }
            before = missing;
        }
    }
    Ok(packing)
}

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
struct Packing<'a> {
    /// The disks with their full radii.
    full: &'a [Disk],
    /// The disks in their present states.
    grown: Vec<Disk>,
}

impl<'a> Packing<'a> {
    /// Shrinks the disks until there is room for them, and places them at random.
    fn begin<B: Boundary + ?Sized>(
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
    fn is_done(&self) -> bool {
        self.grown.iter().zip(self.full).all(|(disk, full)| disk.radius() >= full.radius())
    }

    /// Returns the share of the disks' area that is missing.
    fn missing(&self) -> f64 {
        let largest = largest(self.full);
        let area = |disk: &Disk| (disk.radius() / largest) * (disk.radius() / largest);
        1.0 - self.grown.iter().map(area).sum::<f64>() / self.full.iter().map(area).sum::<f64>()
    }

    /// Moves the disks for a while, with collisions.
    fn stir<B: Boundary + ?Sized>(&mut self, room: &Enclosure<B>) -> Result<(), PlacementError> {
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
    fn grow<B: Boundary + ?Sized>(&mut self, room: &Enclosure<B>) -> Result<(), ParameterError> {
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
                self.grown[index] = disk.with_radius(radius)?;
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

fn largest(disks: &[Disk]) -> f64 {
    disks.iter().map(Disk::radius).fold(0.0, f64::max)
}
