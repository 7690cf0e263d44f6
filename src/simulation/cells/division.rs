//! The division of disks into classes of similar size, each with cells that suit it, by the cost of events.
//!
//! The cost decides only which layout is chosen, never what happens in a run. It needs to rank layouts, so a
//! factor of two here or there does no harm. It must depend on the radii alone: a resumed run divides its
//! disks into classes anew, and must find the same ones.

use super::layout::{CellSize, FREE_PATHS, SPARE_SMALL_CELLS, SizeClass};

/// Ratio of the smallest to the largest diameter in a narrow class. It is smaller if there would otherwise be
/// very many classes.
const WIDTH: f64 = 0.7;

/// Returns the classes in the order of their sizes, smallest first. Without disks, there is no class.
///
/// With narrow classes, a search meets fewer disks that are too far away; with a small number of classes, it
/// visits fewer layers. The classes returned are the cheapest that the search finds.
pub(super) fn classes(diameters: impl Iterator<Item = f64>) -> Vec<SizeClass> {
    let narrow = narrow_classes(diameters);
    let (area, groups) = (area(&narrow), Group::of_each(&narrow));
    let cost = |bounds: &[bool]| cost(&joined(&groups, bounds), area);
    // There are too many divisions to try them all. Two searches start from the finest and from the coarsest
    // division, and the better result is taken.
    let many = cheapest_near(vec![true; groups.len().saturating_sub(1)], cost);
    let few = cheapest_near(vec![false; groups.len().saturating_sub(1)], cost);
    let (_, bounds) = if few.0 < many.0 { few } else { many };
    joined(&groups, &bounds).iter().map(|group| group.class).collect()
}

/// Joins neighboring groups that have no bound between them.
fn joined(groups: &[Group], bounds: &[bool]) -> Vec<Group> {
    let mut joined: Vec<Group> = groups.first().copied().into_iter().collect();
    for (group, &is_bound) in groups.iter().skip(1).zip(bounds) {
        match joined.last_mut().filter(|_| !is_bound) {
            Some(last) => *last = last.with(group),
            None => joined.push(*group),
        }
    }
    joined
}

/// Adds, removes or shifts one bound after another as long as this lowers the cost. Returns the lowest cost,
/// and the bounds.
fn cheapest_near(mut bounds: Vec<bool>, cost: impl Fn(&[bool]) -> f64) -> (f64, Vec<bool>) {
    let mut least = cost(&bounds);
    loop {
        // Inverting two neighboring entries together shifts a bound, or adds or removes two bounds. Without
        // such steps the search would stay in a local minimum, where every single change raises the cost.
        let changed = (0..bounds.len()).flat_map(|first| [1, 2].map(|count| changed(&bounds, first, count)));
        let costs = changed.map(|bounds| (cost(&bounds), bounds));
        match costs.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((lower, better)) if lower < least => (least, bounds) = (lower, better),
            _ => return (least, bounds),
        }
    }
}

/// Returns a copy of the bounds with `count` of them inverted, beginning at `first`.
fn changed(bounds: &[bool], first: usize, count: usize) -> Vec<bool> {
    let is_changed = |k: usize| (first..first + count).contains(&k);
    bounds.iter().enumerate().map(|(k, &is_bound)| is_bound != is_changed(k)).collect()
}

/// Returns narrow classes. Each begins with the largest disk that is not in a class yet, and reaches down to
/// a fixed fraction of its diameter.
fn narrow_classes(diameters: impl Iterator<Item = f64>) -> Vec<SizeClass> {
    let mut diameters: Vec<f64> = diameters.collect();
    diameters.sort_unstable_by(|a, b| b.total_cmp(a));
    let width = diameters.first().zip(diameters.last()).map_or(WIDTH, |ends| width(*ends.0, *ends.1));
    let mut classes: Vec<SizeClass> = Vec::new();
    for diameter in diameters {
        match classes.last_mut() {
            Some(class) if diameter > width * class.largest => {
                class.smallest = diameter;
                class.count += 1;
            }
            _ => classes.push(SizeClass { largest: diameter, smallest: diameter, count: 1 }),
        }
    }
    classes.reverse();
    classes
}

/// Returns a ratio that yields at most about 16 classes.
fn width(largest: f64, smallest: f64) -> f64 {
    let sixteenth_root = (smallest / largest).sqrt().sqrt().sqrt().sqrt();
    WIDTH.min(sixteenth_root)
}

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
struct Group {
    class: SizeClass,
    /// Collisions of all its disks per unit of time.
    collisions: f64,
    /// Sum of the speeds of all its disks.
    speed: f64,
}

impl Group {
    /// Returns one group for each of these classes.
    fn of_each(classes: &[SizeClass]) -> Vec<Self> {
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
    fn with(&self, larger: &Self) -> Self {
        let class = self.class.with(&larger.class);
        let (collisions, speed) = (self.collisions + larger.collisions, self.speed + larger.speed);
        Self { class, collisions, speed }
    }
}

/// Returns the area of a system of these disks at the assumed area fraction.
fn area(classes: &[SizeClass]) -> f64 {
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
fn cost(groups: &[Group], area: f64) -> f64 {
    let all: Vec<Gridded> = (0..groups.len()).map(|index| Gridded::new(groups, index, area)).collect();
    all.iter().enumerate().map(|(index, group)| group.cost(&all[..index], &all[index + 1..])).sum()
}

#[cfg(test)]
mod tests {
    use super::{SizeClass, classes, narrow_classes};
    use crate::simulation::cells::layout::class_of;

    #[test]
    fn classes_reach_from_the_largest_disk_down_to_a_part_of_it() {
        let diameters = [1.0, 10.0, 6.9, 7.1, 1.0, 4.9, 4.8];
        let all = narrow_classes(diameters.into_iter());
        let class = |largest, smallest, count| SizeClass { largest, smallest, count };
        assert_eq!(all, [class(1.0, 1.0, 2), class(4.8, 4.8, 1), class(6.9, 4.9, 2), class(10.0, 7.1, 2)]);
        assert_eq!(diameters.map(|diameter| class_of(&all, diameter)), [0, 3, 2, 3, 0, 2, 1]);
        assert_eq!(classes([3.0; 5].into_iter()), [class(3.0, 3.0, 5)]);
        assert!(classes(std::iter::empty()).is_empty());
        let extreme = (0..1000).map(|k| libm::scalbn(1.0, 2 * (k % 400)));
        assert!(narrow_classes(extreme).len() <= 17);
    }

    #[test]
    fn few_classes_hold_sizes_that_are_near_and_many_those_that_are_far() {
        let uniform = (0..1000).map(|k| 1.0 + 0.009 * f64::from(k));
        assert_eq!(classes(uniform).len(), 1);
        let intruder = (0..1000).map(|k| if k == 0 { 50.0 } else { 1.0 });
        assert_eq!(classes(intruder).len(), 2);
    }
}
