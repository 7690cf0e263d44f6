//! The ids of disks, which stay unchanged while indices change.

use crate::disk::LARGEST_ID;
use crate::quantity::accept;
use crate::{Disk, ParameterError};

/// The id of each disk. Ids count from 1, and no id is used twice.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(in crate::simulation) struct Identities {
    /// Empty as long as the ids are 1, 2, 3, …: most runs need no memory for them.
    ids: Vec<u64>,
    /// The largest id so far, including the ids of removed disks.
    last: u64,
}

impl Identities {
    pub(super) fn new(disks: &[Disk]) -> Self {
        let mut identities = Self::default();
        identities.reserve(disks);
        (0..).zip(disks).for_each(|(place, disk)| identities.push(place, disk.id()));
        identities
    }

    pub(super) fn of(&self, disk: usize) -> u64 {
        self.ids.get(disk).copied().unwrap_or(disk as u64 + 1)
    }

    /// Checks that the new ids for disks without an id will not be too large.
    pub(in crate::simulation) fn check_room(&self, disks: &[Disk]) -> Result<(), ParameterError> {
        let last = disks.iter().map(Disk::id).fold(self.last, u64::max);
        let new = disks.iter().filter(|disk| disk.id() == 0).count() as u64;
        let requirement = "so small that new disks get one of at most 2^53";
        accept(new == 0 || last + new <= LARGEST_ID, "largest id so far", requirement, last as f64).map(drop)
    }

    /// Makes sure that new disks get none of these disks' ids.
    pub(super) fn reserve(&mut self, disks: &[Disk]) {
        self.last = disks.iter().map(Disk::id).fold(self.last, u64::max);
    }

    /// Adds a disk after `count` others. A disk without an id gets an id above all ids given so far.
    pub(super) fn push(&mut self, count: usize, id: u64) {
        let id = if id == 0 { self.last + 1 } else { id };
        self.last = self.last.max(id);
        if !self.ids.is_empty() || id != count as u64 + 1 {
            self.list(count);
            self.ids.push(id);
        }
    }

    /// Removes a disk. The last of these `count` disks takes its index.
    pub(super) fn swap_remove(&mut self, count: usize, disk: usize) {
        self.list(count);
        self.ids.swap_remove(disk);
    }

    /// Removes the disks for which `leaves` is true.
    pub(super) fn remove(&mut self, leaves: &[bool]) {
        self.list(leaves.len());
        let mut leaves = leaves.iter();
        self.ids.retain(|_| leaves.next() == Some(&false));
        self.forget_the_obvious();
    }

    /// Returns whether these are the ids of `count` disks.
    #[cfg(feature = "serde")]
    pub(in crate::simulation) fn suits(&self, count: usize) -> bool {
        [0, count].contains(&self.ids.len())
    }

    fn list(&mut self, count: usize) {
        if self.ids.is_empty() {
            self.ids = (1..=count as u64).collect();
        }
    }

    fn forget_the_obvious(&mut self) {
        if self.ids.iter().zip(1_u64..).all(|(&id, number)| id == number) {
            self.ids = Vec::new();
        }
    }
}
