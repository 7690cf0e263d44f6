//! Insertion and removal of disks.

use super::Bodies;
use super::bodies::{Particle, Spin, Trajectory};
use super::properties::Properties;
use crate::Disk;

impl Bodies {
    /// Adds disks as they are at this time offset.
    pub(in crate::simulation) fn insert(&mut self, disks: &[Disk], offset: f64) {
        self.identities.insert(self.len(), disks);
        let models = (0..self.len()).map(|disk| self.properties.model(disk)).chain(disks.iter().copied());
        self.properties = Properties::of(&models.collect::<Vec<_>>());
        self.typical_diameter = self.properties.typical_diameter();
        if !self.images.is_empty() || disks.iter().any(|disk| disk.image() != [0; 2]) {
            self.images.resize(self.len(), [0; 2]);
            self.images.extend(disks.iter().map(Disk::image));
        }
        let (fallen, gained) = self.fall(offset);
        for disk in disks {
            let velocity = disk.velocity() - gained;
            let position = disk.position() - fallen - velocity * offset;
            self.particles.push(Particle::new(Trajectory { position, velocity }));
            let spin = Spin::of(disk);
            self.spins.push(Spin { angle: spin.angle - spin.angular_velocity * offset, ..spin });
        }
    }

    /// Removes the disks for which `leaves` is true. The others stay in their order.
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
