//! Classes of disks by their size: each has cells that suit it.

/// Smallest diameter in a class, in terms of its largest.
const WIDTH: f64 = 0.5;

/// Disks of similar size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::simulation) struct SizeClass {
    /// The largest diameter.
    pub(in crate::simulation) largest: f64,
    /// The smallest diameter.
    pub(super) smallest: f64,
    /// Number of disks.
    pub(super) count: usize,
}

/// Returns the classes, the smallest disks first; none without disks.
///
/// Each class reaches from the largest disk that is not yet in one down to [`WIDTH`] times it, so a mixture of two sizes has
/// two classes whatever the sizes are.
pub(super) fn classes(diameters: impl Iterator<Item = f64>) -> Vec<SizeClass> {
    let mut diameters: Vec<f64> = diameters.collect();
    diameters.sort_unstable_by(|a, b| b.total_cmp(a));
    let mut classes: Vec<SizeClass> = Vec::new();
    for diameter in diameters {
        match classes.last_mut() {
            Some(class) if diameter > WIDTH * class.largest => {
                class.smallest = diameter;
                class.count += 1;
            }
            _ => classes.push(SizeClass { largest: diameter, smallest: diameter, count: 1 }),
        }
    }
    classes.reverse();
    classes
}

/// Returns the class of all disks together; `None` without disks.
pub(super) fn together(classes: &[SizeClass]) -> Option<SizeClass> {
    let (first, last) = (classes.first()?, classes.last()?);
    let count = classes.iter().map(|class| class.count).sum();
    Some(SizeClass { largest: last.largest, smallest: first.smallest, count })
}

/// Returns the class of disks of this diameter.
pub(super) fn class_of(classes: &[SizeClass], diameter: f64) -> u8 {
    classes.partition_point(|class| class.largest < diameter) as u8
}

#[cfg(test)]
mod tests {
    use super::{SizeClass, class_of, classes};

    #[test]
    fn classes_reach_from_the_largest_disk_down_to_its_half() {
        let diameters = [1.0, 10.0, 4.9, 5.1, 1.0, 2.4, 2.5];
        let all = classes(diameters.into_iter());
        let class = |largest, smallest, count| SizeClass { largest, smallest, count };
        assert_eq!(all, [class(1.0, 1.0, 2), class(2.4, 2.4, 1), class(4.9, 2.5, 2), class(10.0, 5.1, 2)]);
        assert_eq!(diameters.map(|diameter| class_of(&all, diameter)), [0, 3, 2, 3, 0, 1, 2]);
        assert_eq!(classes([3.0; 5].into_iter()), [class(3.0, 3.0, 5)]);
        assert!(classes(std::iter::empty()).is_empty());
    }
}
