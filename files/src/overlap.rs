//! Overlaps among disks.

use std::collections::HashMap;

use granular_edmd::glam::DVec2;

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;

/// Disks of similar size, in squares a little wider than the largest disk.
///
/// With squares for one size only, a single giant would make every disk a neighbor of every other.
struct Class {
    side: f64,
    /// The disks in each square, by the column and row of the square. Both are whole floating-point numbers,
    /// which do not overflow; the keys are their bits.
    squares: HashMap<[u64; 2], Vec<usize>>,
}

impl Class {
    /// Creates the class whose largest disk has this radius. The excess over a diameter covers rounding.
    fn new(radius: f64) -> Self {
        Self { side: 2.001 * radius, squares: HashMap::new() }
    }

    /// Returns whether the class has room for a disk of this radius. The disks of the class are at least as
    /// large.
    fn takes(&self, radius: f64) -> bool {
        8.0 * radius > self.side
    }

    fn square(&self, place: DVec2) -> DVec2 {
        (place / self.side).floor()
    }

    /// Returns the disks in the square of a position and in the eight squares around it.
    fn near(&self, place: DVec2) -> impl Iterator<Item = usize> {
        let middle = self.square(place);
        let squares =
            (0..9).map(move |n| key(middle + DVec2::new(f64::from(n % 3 - 1), f64::from(n / 3 - 1))));
        squares.filter_map(|key| self.squares.get(&key)).flatten().copied()
    }
}

/// Returns the numbers of a square as a key. Adding 0 turns −0 into 0.
fn key(square: DVec2) -> [u64; 2] {
    [(square.x + 0.0).to_bits(), (square.y + 0.0).to_bits()]
}

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
    /// True if all overlaps are counted. If very many disks lie at one place, there are too many overlaps to
    /// count.
    pub(super) is_counted: bool,
}

/// Largest number of overlaps per disk that are counted. Disks that overlap only a little have at most three
/// each.
const MOST: usize = 8;

/// Returns the displacements of the nearest periodic images of a box, the first of which is zero.
fn images(periods: DVec2) -> Vec<DVec2> {
    let [columns, rows] =
        periods.to_array().map(|period| if period > 0.0 { vec![0.0, -period, period] } else { vec![0.0] });
    columns.iter().flat_map(|&x| rows.iter().map(move |&y| DVec2::new(x, y))).collect()
}

/// Returns the deepest overlap beyond this share of the sum of radii, or `None` if all are smaller.
///
/// The disks are taken in the order of their sizes, the largest first, and each is compared with the disks
/// before it. As long as these overlap little, a square holds only a few of them.
pub(super) fn deepest(disks: &[Disk], domain: Option<&Domain>, least: f64) -> Option<Overlap> {
    let shifts = images(domain.map_or(DVec2::ZERO, Domain::periods));
    let mut order: Vec<usize> = (0..disks.len()).collect();
    order.sort_by(|&a, &b| disks[b].radius().total_cmp(&disks[a].radius()));
    let mut classes: Vec<Class> = Vec::new();
    let mut found: Option<Overlap> = None;
    for index in order {
        let disk = &disks[index];
        for (class, shift) in classes.iter().flat_map(|class| shifts.iter().map(move |shift| (class, shift)))
        {
            let place = disk.position() + shift;
            if *shift != DVec2::ZERO && !domain.is_some_and(|domain| domain.contains(place, class.side)) {
                continue;
            }
            for other in class.near(place).filter(|&other| other != index) {
                let contact = disk.radius() + disks[other].radius();
                let depth = contact - place.distance(disks[other].position());
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
        }
        if !classes.last().is_some_and(|class| class.takes(disk.radius())) {
            classes.push(Class::new(disk.radius()));
        }
        if let Some(class) = classes.last_mut() {
            let key = key(class.square(disk.position()));
            class.squares.entry(key).or_default().push(index);
        }
    }
    found
}
