//! Values of single disks, identified by the ids of the disks.

use crate::Disk;
use crate::disk::numbered;

/// A value for each disk of a snapshot.
///
/// Values at two times are matched by the ids of the disks. Only disks with a value at both times count, so
/// disks may be inserted, removed or sorted in between.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::{InnerProduct, PerDisk};
/// use granular_edmd::Disk;
///
/// let at_rest = Disk::new(DVec2::ZERO, 0.5)?;
/// let disk = |id: u64, speed: f64| at_rest.with_velocity(DVec2::X * speed)?.with_id(id);
/// let before = PerDisk::of(&[disk(1, 2.0)?, disk(2, 3.0)?], |disk| disk.velocity().x);
/// let after = PerDisk::of(&[disk(7, 9.0)?, disk(2, 5.0)?], |disk| disk.velocity().x);
/// assert_eq!(before.inner_product(&after), 15.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "Vec<(u64, T)>"))]
// Ids and values, in the order of the ids.
pub struct PerDisk<T>(Vec<(u64, T)>);

impl<T> PerDisk<T> {
    /// Evaluates a quantity of each disk.
    ///
    /// If some of them have no id, all are identified by their index in the list.
    pub fn of(disks: &[Disk], quantity: impl Fn(&Disk) -> T) -> Self {
        numbered(disks).map(|(id, disk)| (id, quantity(disk))).collect::<Vec<_>>().into()
    }

    /// Iterates over the ids and values, in the order of the ids.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (u64, &T)> {
        self.0.iter().map(|(id, value)| (*id, value))
    }

    /// Returns whether there is a value for the disk with this id.
    pub(super) fn has(&self, id: u64) -> bool {
        self.0.binary_search_by_key(&id, |(id, _)| *id).is_ok()
    }

    /// Returns the mean of a function of a disk's two values, over the disks that have both, or NaN if no
    /// disk has both.
    pub fn mean_with(&self, other: &Self, function: impl Fn(&T, &T) -> f64) -> f64 {
        let (mut sum, mut count) = (0.0, 0);
        let mut others = other.0.iter().peekable();
        for (id, value) in &self.0 {
            while others.next_if(|(other, _)| other < id).is_some() {}
            if let Some((_, of_other)) = others.next_if(|(other, _)| other == id) {
                sum += function(value, of_other);
                count += 1;
            }
        }
        sum / f64::from(count)
    }
}

impl<T> From<Vec<(u64, T)>> for PerDisk<T> {
    /// Creates the values from ids and values in any order.
    fn from(mut entries: Vec<(u64, T)>) -> Self {
        // While the disks of a run stay the same, their ids are in order already.
        entries.sort_by_key(|(id, _)| *id);
        Self(entries)
    }
}
