//! Overlaps among disks.

use crate::Disk;
use crate::boundary::{Domain, Squares};

/// The overlaps found so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Overlap {
    /// Indices of the two disks that overlap most, in units of the sum of their radii.
    pub(super) pair: [usize; 2],
    pub(super) depth: f64,
    /// Depth in units of the sum of the radii.
    pub(super) share: f64,
    /// Number of all overlaps.
    pub(super) count: usize,
    /// True if all overlaps are counted. Disks on one heap overlap too many times for that.
    pub(super) is_counted: bool,
}

/// Largest number of overlaps per disk that are counted. Disks that overlap little have three each at most.
const MOST: usize = 8;

/// Returns the deepest overlap beyond this share of the sum of radii, if there is one.
///
/// Each disk looks among those before it. As long as these overlap little, a square holds only a few of them.
pub(super) fn deepest(disks: &[Disk], domain: Option<&Domain>, least: f64) -> Option<Overlap> {
    const PLANE: Domain = Domain::new(f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY);
    let domain = domain.unwrap_or(&PLANE);
    let mut squares = Squares::new(domain, disks.iter().map(Disk::radius));
    let mut found: Option<Overlap> = None;
    for (index, disk) in disks.iter().enumerate() {
        let mut near: Vec<usize> = squares.near(disk.position(), disk.radius()).collect();
        near.sort_unstable();
        near.dedup();
        for other in near {
            let there = disks[other].position();
            let distances = domain.images().map(|shift| (disk.position() + shift).distance(there));
            let contact = disk.radius() + disks[other].radius();
            let depth = contact - distances.fold(f64::INFINITY, f64::min);
            if depth <= least * contact {
                continue;
            }
            let share = depth / contact;
            let count = found.map_or(1, |found| found.count + 1);
            let is_counted = count <= MOST * disks.len();
            let here = Overlap { pair: [index, other], depth, share, count, is_counted };
            let deepest = found.filter(|found| found.share >= share).unwrap_or(here);
            found = Some(Overlap { count, is_counted, ..deepest });
            if !is_counted {
                return found;
            }
        }
        squares.add(disk.position(), disk.radius(), index);
    }
    found
}
