//! A grid of squares, which finds the disks near a position.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::DVec2;

use super::Domain;
use crate::Disk;

/// Factor by which disks reach further than their radii, so that rounding hides no neighbor.
const MARGIN: f64 = 1.0 + 1e-9;

/// Squares for finding the disks near a position.
///
/// A disk is entered in all squares that it reaches. A disk that is entered with radius 0 is in one square,
/// so it is found only once.
pub(crate) struct Squares {
    domain: Domain,
    columns: Axis,
    rows: Axis,
    disks: HashMap<(i64, i64), Vec<usize>, BuildHasherDefault<Mixer>>,
}

impl Squares {
    /// Makes empty squares for disks of these radii.
    ///
    /// Their side is the root of the mean square of the diameters, so there are a few entries for each disk,
    /// and a few disks in each square, for any mix of radii.
    pub(crate) fn new(domain: &Domain, radii: impl ExactSizeIterator<Item = f64>) -> Self {
        let count = radii.len().max(1) as f64;
        let squares: f64 = radii.map(|radius| 4.0 * radius * radius).sum();
        Self::with_side(domain, if squares > 0.0 { (squares / count).sqrt() } else { 1.0 })
    }

    /// Makes empty squares of about this side.
    pub(crate) fn with_side(domain: &Domain, side: f64) -> Self {
        let Domain { left, right, bottom, top, .. } = *domain;
        let columns = Axis::new(domain.periodic_sides.then_some((left, right)), side);
        let rows = Axis::new(domain.periodic_ends.then_some((bottom, top)), side);
        Self { domain: *domain, columns, rows, disks: HashMap::default() }
    }

    /// Returns the squares that a disk reaches.
    fn squares(&self, site: DVec2, radius: f64) -> impl Iterator<Item = (i64, i64)> + use<> {
        let reach = DVec2::splat(radius * MARGIN);
        let (low, high) = (site - reach, site + reach);
        let (columns, rows) = (self.columns.between(low.x, high.x), self.rows.between(low.y, high.y));
        columns.flat_map(move |column| rows.clone().map(move |row| (column, row)))
    }

    /// Adds a disk of this index and radius.
    pub(crate) fn add(&mut self, site: DVec2, radius: f64, disk: usize) {
        for square in self.squares(site, radius) {
            self.disks.entry(square).or_default().push(disk);
        }
    }

    /// Returns all disks that may overlap a disk of this radius, and some others. A disk may appear several
    /// times, but one that was entered with radius 0 appears only once.
    pub(crate) fn near(&self, site: DVec2, radius: f64) -> impl Iterator<Item = usize> {
        self.squares(site, radius).filter_map(|square| self.disks.get(&square)).flatten().copied()
    }

    /// Returns whether a disk of this radius at this position overlaps none of the placed disks.
    pub(crate) fn is_free(&self, site: DVec2, radius: f64, placed: &[Disk]) -> bool {
        self.near(site, radius).all(|other| {
            let contact = radius + placed[other].radius();
            self.domain.separation(site, placed[other].position()).length_squared() > contact * contact
        })
    }
}

/// A hash of the column and row of a square, faster than the standard hash. It need not resist attacks: the
/// positions come from the program itself.
#[derive(Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_i64(i64::from(byte));
        }
    }

    fn write_i64(&mut self, number: i64) {
        // The factor comes from Fibonacci hashing: 2⁶⁴ over the golden ratio.
        self.0 = (self.0.rotate_left(32) ^ number as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }

    fn finish(&self) -> u64 {
        // The table uses the low bits, and only a few of these depend on all bits of the number.
        self.0 ^ (self.0 >> 32)
    }
}

/// The columns, or the rows, of the squares.
struct Axis {
    origin: f64,
    size: f64,
    /// Number of squares after which a periodic axis begins anew.
    count: Option<i64>,
}

impl Axis {
    /// Divides an axis into intervals of about this size. A periodic axis begins anew after its upper end.
    fn new(period: Option<(f64, f64)>, size: f64) -> Self {
        let Some((low, high)) = period else { return Self { origin: 0.0, size, count: None } };
        let count = ((high - low) / size).floor().max(1.0);
        Self { origin: low, size: (high - low) / count, count: Some(count as i64) }
    }

    /// Returns the intervals between two positions, each of them once.
    fn between(&self, low: f64, high: f64) -> impl Iterator<Item = i64> + Clone + use<> {
        let index = |place: f64| ((place - self.origin) / self.size).floor() as i64;
        let (first, last, count) = (index(low), index(high), self.count);
        let last = count.map_or(last, |count| last.min(first.saturating_add(count - 1)));
        (first..=last).map(move |index| count.map_or(index, |count| index.rem_euclid(count)))
    }
}
