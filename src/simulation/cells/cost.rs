//! The cost of the events of a mixture, for a given division of its disks into classes.
//!
//! The cost decides only which layout is chosen, never what happens in a run. It needs to rank layouts, so a
//! factor of two here or there does no harm. It must depend on the radii alone: a resumed run divides its
//! disks into classes anew, and must find the same ones.

use super::layout::SizeClass;
use super::layout::{CellSize, FREE_PATHS, SPARE_SMALL_CELLS};

/// Assumed area fraction. It is fixed, so that the classes depend on the disks alone.
const AREA_FRACTION: f64 = 0.4;

/// Assumed largest number of cells per disk.
const CELLS_PER_DISK: f64 = 2.0;

/// Costs in units of the prediction of one pair: reading a cell (`LOOK`), changing a cell (`CHANGE`), a loop
/// over the cells of another class (`LOOP`), and an event without its searches (`EVENT`).
///
/// A loop is this expensive because the processor can hardly predict its length.
const LOOK: f64 = 1.0;
const CHANGE: f64 = 4.0;
const LOOP: f64 = 30.0;
const EVENT: f64 = 20.0;

/// A group of disks, with its rate of collisions and its speed. All disks are taken to have the same energy,
/// and masses in proportion to their areas.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    pub(super) class: SizeClass,
    /// Collisions of all its disks per unit of time.
    collisions: f64,
    /// Sum of the speeds of all its disks.
    speed: f64,
}

impl Group {
    /// Returns one group for each of these classes.
    pub(super) fn of_each(classes: &[SizeClass]) -> Vec<Self> {
        let area = area(classes);
        let group = |&class: &SizeClass| {
            let (count, speed) = (class.count as f64, 1.0 / class.largest);
            let collisions_with = |other: &SizeClass| {
                let relative = (speed * speed + 1.0 / (other.largest * other.largest)).sqrt();
                count * other.count as f64 / area * (class.largest + other.largest) * relative
            };
            let collisions = classes.iter().map(collisions_with).sum();
            Self { class, collisions, speed: count * speed }
        };
        classes.iter().map(group).collect()
    }

    /// Returns the union of this group and a group of larger disks.
    pub(super) fn with(&self, larger: &Self) -> Self {
        let class = self.class.with(&larger.class);
        let (collisions, speed) = (self.collisions + larger.collisions, self.speed + larger.speed);
        Self { class, collisions, speed }
    }
}

/// Returns the area of a system of these disks at the assumed area fraction.
pub(super) fn area(classes: &[SizeClass]) -> f64 {
    let square = |class: &SizeClass| class.count as f64 * class.largest * class.largest;
    0.25 * std::f64::consts::PI / AREA_FRACTION * classes.iter().map(square).sum::<f64>()
}

/// A group with its cells.
struct Gridded {
    group: Group,
    density: f64,
    /// Width of a home.
    home: f64,
    /// Width of a cell.
    cell: f64,
}

impl Gridded {
    fn new(groups: &[Group], index: usize, area: f64) -> Self {
        let group = groups[index];
        let SizeClass { largest, count, .. } = group.class;
        let pitch = CellSize::Small.pitch();
        let most = CELLS_PER_DISK * count as f64 + SPARE_SMALL_CELLS;
        let home = (pitch * largest).max((area / most).sqrt());
        let meetings = |other: &Group| other.class.count as f64 * (largest + other.class.largest);
        let free_path = area / groups.iter().map(meetings).sum::<f64>();
        let suitable = (FREE_PATHS * pitch * free_path).max(pitch * groups[0].class.largest);
        let cell = if index == 0 { home } else { suitable.min(home) };
        Self { group, density: count as f64 / area, home, cell }
    }

    /// Returns the width of the square of a smaller group's homes that a disk of this group searches, and the
    /// width of the hole in that square.
    fn reach(&self, smaller: &Self) -> (f64, f64) {
        let width = self.group.class.largest + smaller.group.class.largest + self.cell + smaller.home;
        let touching = self.group.class.smallest + smaller.group.class.smallest;
        let hole = touching * std::f64::consts::FRAC_1_SQRT_2 - self.cell - smaller.home;
        (width, hole.max(0.0))
    }

    /// Returns the number of disks of this group that visit each home of a smaller group.
    fn visitors(&self, smaller: &Self) -> f64 {
        let (width, hole) = self.reach(smaller);
        (width * width - hole * hole) * self.density
    }

    /// Returns the cost of a search in the disk's own group.
    fn among_equals(&self) -> f64 {
        let width = 2.0 * self.group.class.largest + self.cell + self.home;
        let homes = (width / self.home) * (width / self.home);
        homes * LOOK + homes * self.home * self.home * self.density
    }

    /// Returns the costs of a search in a smaller group, after a collision and after a cell crossing.
    fn below(&self, smaller: &Self) -> (f64, f64) {
        let (width, hole) = self.reach(smaller);
        let (homes, disks) = (1.0 / (smaller.home * smaller.home), smaller.density);
        let (all, fresh) = (width * width - hole * hole, (width + hole) * self.cell);
        (LOOP + all * (LOOK * homes + disks), LOOP + fresh * ((LOOK + 2.0 * CHANGE) * homes + disks))
    }

    /// Returns the cost of all events of this group per unit of time.
    fn cost(&self, smaller: &[Self], larger: &[Self]) -> f64 {
        let visitors: f64 = larger.iter().map(|other| other.visitors(self)).sum();
        let common = EVENT + self.among_equals() + LOOK + visitors;
        let (around, ahead) = smaller
            .iter()
            .map(|other| self.below(other))
            .fold((common, common), |sum, cost| (sum.0 + cost.0, sum.1 + cost.1));
        self.group.collisions * around + self.group.speed / self.cell * ahead
    }
}

/// Returns the cost of all events per unit of time, for disks in these groups and a system of this area.
pub(super) fn cost(groups: &[Group], area: f64) -> f64 {
    let all: Vec<Gridded> = (0..groups.len()).map(|index| Gridded::new(groups, index, area)).collect();
    all.iter().enumerate().map(|(index, group)| group.cost(&all[..index], &all[index + 1..])).sum()
}
