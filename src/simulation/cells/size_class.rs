//! Classes of disks by their size: each has cells that suit it.

/// Smallest diameter in a class, in terms of its largest.
const WIDTH: f64 = 0.5;

/// Returns the largest diameter of each class, the smallest class first; none without disks.
///
/// Each class reaches from the largest disk that is not yet in one down to [`WIDTH`] times it, so a mixture of two sizes has
/// two classes whatever the sizes are.
pub(super) fn classes(diameters: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut diameters: Vec<f64> = diameters.collect();
    diameters.sort_unstable_by(|a, b| b.total_cmp(a));
    let mut classes: Vec<f64> = Vec::new();
    for diameter in diameters {
        if classes.last().is_none_or(|&largest| diameter <= WIDTH * largest) {
            classes.push(diameter);
        }
    }
    classes.reverse();
    classes
}

/// Returns the class of disks of this diameter.
pub(super) fn class_of(classes: &[f64], diameter: f64) -> u8 {
    classes.partition_point(|&largest| largest < diameter) as u8
}

#[cfg(test)]
mod tests {
    use super::{class_of, classes};

    #[test]
    fn classes_reach_from_the_largest_disk_down_to_its_half() {
        let diameters = [1.0, 10.0, 4.9, 5.1, 1.0, 2.4, 2.5];
        let largest = classes(diameters.into_iter());
        assert_eq!(largest, [1.0, 2.4, 4.9, 10.0]);
        assert_eq!(diameters.map(|diameter| class_of(&largest, diameter)), [0, 3, 2, 3, 0, 1, 2]);
        assert_eq!(classes([3.0; 5].into_iter()), [3.0]);
        assert!(classes(std::iter::empty()).is_empty());
    }
}
