//! Disks packed at random.

mod enclosure;
mod packing;

use std::f64::consts::PI;

use super::{PlacementError, countable};
use crate::Disk;
use crate::boundary::Boundary;
use crate::quantity::accept;
use crate::random::{Stream, derived_seed};
use enclosure::Enclosure;
use packing::Packing;

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
    let wider = |disk: &Disk| {
        Disk::new(disk.position(), disk.radius() * (1.0 + APART)).map(|wide| wide.with_kind(disk.kind()))
    };
    let wider = disks.iter().map(wider).collect::<Result<Vec<_>, _>>()?;
    let seed = derived_seed(seed, Stream::Packing, 0);
    let packing = grown(&room, &wider, area, seed).map_err(|error| match error {
        // A heavy piston hardly moves while disks are packed, so a moving piston is reported only if the
        // packing fails.
        PlacementError::Run { ref reason } => {
            room.check_walls(reason).map_or_else(PlacementError::from, |()| error)
        }
        error => with_full_radius(error, &disks),
    })?;
    let packed = disks.iter().zip(packing.places()).map(|(disk, place)| disk.with_position(place));
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
