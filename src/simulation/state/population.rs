//! The disks of a run: their constant properties (radius, mass, inertia, kind), their ids, and disks that
//! come and go.

use super::{Bodies, Particle, Spin, Trajectory};
use crate::collision::Material;
use crate::disk::LARGEST_ID;
use crate::quantity::accept;
use crate::{Disk, Kind, ParameterError};

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
        // The ids that a list would have anyway need no list.
        if self.ids.iter().zip(1_u64..).all(|(&id, number)| id == number) {
            self.ids = Vec::new();
        }
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
}

/// Ratio of the largest to the median diameter beyond which the largest diameter sets the length of epochs.
const LARGEST_RATIO: f64 = 1024.0;

/// The properties of all disks: a single set if all disks are equal, so that it stays in the cache.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Properties {
    Same {
        /// A disk at rest at the origin.
        model: Disk,
        material: Material,
    },
    Each {
        /// The radii, stored apart from the rest since every prediction needs them.
        radii: Vec<f64>,
        /// The diameter, if all disks have the same one.
        common_diameter: Option<f64>,
        others: Vec<Others>,
    },
}

/// The properties of a disk besides its radius.
///
/// A [`Material`] would take twice the memory. The divisions that compute a `Material` from these numbers
/// cost less than loading one would.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Others {
    mass: f64,
    inertia_factor: f64,
    kind: Kind,
}

impl Others {
    const fn of(disk: &Disk) -> Self {
        Self { mass: disk.mass(), inertia_factor: disk.inertia_factor(), kind: disk.kind() }
    }

    #[inline]
    const fn model(&self, radius: f64) -> Disk {
        Disk::at_rest(radius, self.mass, self.inertia_factor, self.kind)
    }
}

impl Properties {
    pub(super) fn of(disks: &[Disk]) -> Self {
        match disks.split_first() {
            Some((first, rest)) if rest.iter().all(|disk| is_alike(disk, first)) => {
                let model = Others::of(first).model(first.radius());
                Self::Same { model, material: Material::of(&model) }
            }
            _ => {
                let radii: Vec<f64> = disks.iter().map(Disk::radius).collect();
                let is_common = radii.windows(2).all(|pair| pair[0] == pair[1]);
                let common_diameter = radii.first().filter(|_| is_common).map(|radius| 2.0 * radius);
                Self::Each { radii, common_diameter, others: disks.iter().map(Others::of).collect() }
            }
        }
    }

    /// Adds a disk after `count` others. The time grows with the number of disks only for the first disk that
    /// differs from the others.
    pub(super) fn push(&mut self, count: usize, disk: &Disk) {
        if let Self::Same { model, .. } = *self {
            if is_alike(disk, &model) {
                return;
            }
            let (radius, others) = (model.radius(), Others::of(&model));
            *self = Self::Each {
                radii: vec![radius; count],
                common_diameter: Some(2.0 * radius),
                others: vec![others; count],
            };
        }
        if let Self::Each { radii, common_diameter, others } = self {
            *common_diameter = common_diameter.filter(|&diameter| diameter == 2.0 * disk.radius());
            radii.push(disk.radius());
            others.push(Others::of(disk));
        }
    }

    /// Removes a disk. The last one takes its index.
    pub(super) fn swap_remove(&mut self, disk: usize) {
        if let Self::Each { radii, others, .. } = self {
            radii.swap_remove(disk);
            others.swap_remove(disk);
        }
    }

    /// Returns the median diameter, which does not depend on the order of the disks; 0 without disks.
    ///
    /// If there is a disk more than [`LARGEST_RATIO`] times as large, the result is the diameter of the
    /// largest disk divided by that ratio. A domain with room for such a disk is so large that positions have
    /// few digits after the decimal point, so fine dust would gain nothing from shorter epochs.
    pub(super) fn typical_diameter(&self) -> f64 {
        match self {
            Self::Same { model, .. } => 2.0 * model.radius(),
            Self::Each { radii, .. } if radii.is_empty() => 0.0,
            Self::Each { radii, .. } => {
                let mut radii = radii.clone();
                let middle = radii.len() / 2;
                let (_, median, larger) = radii.select_nth_unstable_by(middle, f64::total_cmp);
                larger.iter().fold(2.0 * *median, |most, radius| most.max(2.0 * radius / LARGEST_RATIO))
            }
        }
    }

    /// Returns whether there are properties for this number of disks.
    #[cfg(feature = "serde")]
    pub(super) fn suits(&self, count: usize) -> bool {
        match self {
            Self::Same { .. } => true,
            Self::Each { radii, others, .. } => [radii.len(), others.len()] == [count; 2],
        }
    }

    /// Returns the diameter, if all disks have the same one.
    #[inline]
    pub(super) fn common_diameter(&self) -> Option<f64> {
        match self {
            Self::Same { material, .. } => Some(2.0 * material.radius),
            Self::Each { common_diameter, .. } => *common_diameter,
        }
    }

    #[inline]
    pub(super) fn radius(&self, disk: usize) -> f64 {
        match self {
            Self::Same { material, .. } => material.radius,
            Self::Each { radii, .. } => radii[disk],
        }
    }

    /// Returns a disk with the same properties, at rest at the origin.
    #[inline]
    pub(super) fn model(&self, disk: usize) -> Disk {
        match self {
            Self::Same { model, .. } => *model,
            Self::Each { radii, others, .. } => others[disk].model(radii[disk]),
        }
    }

    #[inline]
    pub(super) fn material(&self, disk: usize) -> Material {
        match self {
            Self::Same { material, .. } => *material,
            Self::Each { radii, others, .. } => Material::of(&others[disk].model(radii[disk])),
        }
    }
}

fn is_alike(disk: &Disk, other: &Disk) -> bool {
    let numbers = |disk: &Disk| [disk.radius(), disk.mass(), disk.inertia_factor()];
    numbers(disk) == numbers(other) && disk.kind() == other.kind()
}

impl Bodies {
    /// Adds a disk in its state at this time offset. The cost does not grow with the number of disks.
    ///
    /// The typical diameter, a median, stays the same until [`Self::settle`].
    pub(in crate::simulation) fn push_disk(&mut self, disk: &Disk, offset: f64) {
        let count = self.len();
        self.identities.push(count, disk.id());
        self.properties.push(count, disk);
        if !self.images.is_empty() || disk.image() != [0; 2] {
            self.images.resize(count, [0; 2]);
            self.images.push(disk.image());
        }
        let (fallen, gained) = self.fall(offset);
        let velocity = disk.velocity() - gained;
        let position = disk.position() - fallen - velocity * offset;
        let mut particle = Particle::new(Trajectory { position, velocity });
        particle.forecast.collisions = self.fresh_count;
        self.particles.push(particle);
        let spin = Spin::of(disk);
        self.spins.push(Spin { angle: spin.angle - spin.angular_velocity * offset, ..spin });
        self.has_changed = true;
    }

    /// Adds disks in their states at this time offset.
    pub(in crate::simulation) fn insert(&mut self, disks: &[Disk], offset: f64) {
        self.identities.reserve(disks);
        for disk in disks {
            self.push_disk(disk, offset);
        }
        self.settle();
    }

    /// Removes a disk, in a time that does not grow with the number of disks. The last one takes its index.
    ///
    /// The index of the removed disk and the last index both get a count of collisions that no earlier
    /// forecast holds, so earlier forecasts with these indices are recognized as outdated.
    pub(in crate::simulation) fn swap_remove(&mut self, disk: usize) {
        let last = self.len() - 1;
        let count = |disk: usize| self.particles[disk].forecast.collisions.wrapping_add(1);
        self.fresh_count = self.fresh_count.max(count(disk)).max(count(last));
        self.particles[last].forecast.collisions = self.fresh_count;
        self.identities.swap_remove(last + 1, disk);
        self.properties.swap_remove(disk);
        if !self.images.is_empty() {
            self.images.swap_remove(disk);
        }
        self.particles.swap_remove(disk);
        self.spins.swap_remove(disk);
        self.has_changed = true;
    }

    /// Measures the typical diameter anew if disks have come or gone since the last time.
    pub(in crate::simulation) fn settle(&mut self) {
        if std::mem::take(&mut self.has_changed) {
            let models: Vec<Disk> = (0..self.len()).map(|disk| self.properties.model(disk)).collect();
            self.properties = Properties::of(&models);
            self.typical_diameter = self.properties.typical_diameter();
        }
    }

    /// Removes the disks for which `leaves` is true. The others keep their order.
    pub(in crate::simulation) fn remove(&mut self, leaves: &[bool]) {
        let models = (0..self.len()).map(|disk| self.properties.model(disk)).collect::<Vec<_>>();
        self.properties = Properties::of(&staying(&models, leaves));
        self.typical_diameter = self.properties.typical_diameter();
        self.images = staying(&self.images, leaves);
        self.particles = staying(&self.particles, leaves);
        self.spins = staying(&self.spins, leaves);
        self.identities.remove(leaves);
    }
}

/// Returns the items that do not leave.
fn staying<T: Copy>(items: &[T], leaves: &[bool]) -> Vec<T> {
    items.iter().zip(leaves).filter(|(_, leaves)| !**leaves).map(|(item, _)| *item).collect()
}
