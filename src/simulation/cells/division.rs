//! The division of disks into classes of similar size, each with cells that suit it.

use super::cost::{Group, area, cost};
use super::layout::SizeClass;

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
