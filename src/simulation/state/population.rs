//! Insertion and removal of disks.

use super::Bodies;
use super::bodies::{Particle, Spin, Trajectory};
use super::properties::Properties;
use crate::Disk;

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
