//! Classes of disks of similar size, each with cells of a suitable size.

use crate::boundary::Domain;

/// Disks of similar size.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct SizeClass {
    /// The largest diameter.
    pub(in crate::simulation) largest: f64,
    /// The smallest diameter.
    pub(in crate::simulation) smallest: f64,
    /// Number of disks.
    pub(in crate::simulation) count: usize,
}

impl SizeClass {
    /// Returns the class for which cells are made if there are no disks. Any cells for which the domain has
    /// room will do, even where it is periodic.
    pub(super) fn of_nobody(domain: &Domain) -> Self {
        let any = 0.125 * domain.width().min(domain.height());
        Self { largest: any, smallest: any, count: 0 }
    }

    /// Returns the union of this class and a class of larger disks.
    pub(super) fn with(&self, larger: &Self) -> Self {
        Self { largest: larger.largest, smallest: self.smallest, count: self.count + larger.count }
    }
}

/// Returns one class of all disks, or `None` if there are no disks.
pub(super) fn together(classes: &[SizeClass]) -> Option<SizeClass> {
    classes.iter().copied().reduce(|together, class| together.with(&class))
}

/// Returns the number of disks in all classes.
pub(super) fn count(classes: &[SizeClass]) -> usize {
    classes.iter().map(|class| class.count).sum()
}

/// Returns the class of disks of this diameter.
pub(super) fn class_of(classes: &[SizeClass], diameter: f64) -> u8 {
    classes.partition_point(|class| class.largest < diameter) as u8
}
