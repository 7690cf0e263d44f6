//! How often, with whom, and how.

use super::{Collision, Observer, Partner};
use crate::collision::Regime;

/// Counts of collisions by partner and regime, and their rates.
///
/// ```
/// use granular_edmd::observable::CollisionCounts;
/// let counts = CollisionCounts::since(0.0);
/// assert_eq!(counts.disks() + counts.walls(), 0);
/// assert_eq!(counts.rate_per_disk(1000, 10.0), 0.0);
/// ```
#[derive(Debug, Clone, Default)]
pub struct CollisionCounts {
    start: f64,
    disks: u64,
    walls: Vec<u64>,
    sticking: u64,
    sliding: u64,
    contact_duration: u64,
}

impl CollisionCounts {
    /// Counts that start at this time.
    pub fn since(start: f64) -> Self {
        Self { start, ..Self::default() }
    }

    /// Collisions of two disks.
    pub const fn disks(&self) -> u64 {
        self.disks
    }

    /// Collisions with any wall.
    pub fn walls(&self) -> u64 {
        self.walls.iter().sum()
    }

    /// Collisions with the wall of this index.
    pub fn wall(&self, wall: usize) -> u64 {
        self.walls.get(wall).copied().unwrap_or(0)
    }

    /// Collisions in this regime, with disks and walls.
    pub fn regime(&self, regime: Regime) -> u64 {
        match regime {
            Regime::Sticking => self.sticking,
            Regime::Sliding => self.sliding,
            Regime::ContactDuration => self.contact_duration,
            Regime::Unspecified => {
                self.disks + self.walls() - self.sticking - self.sliding - self.contact_duration
            }
        }
    }

    /// Disk–disk collisions per disk and time until `now`: each counts for both partners.
    pub fn rate_per_disk(&self, disks: usize, now: f64) -> f64 {
        2.0 * self.disks as f64 / (disks as f64 * (now - self.start))
    }

    fn count_partner(&mut self, partner: Partner) {
        match partner {
            Partner::Disk(_) => self.disks += 1,
            Partner::Wall(wall) => {
                if wall >= self.walls.len() {
                    self.walls.resize(wall + 1, 0);
                }
                self.walls[wall] += 1;
            }
        }
    }
}

impl Observer for CollisionCounts {
    fn on_collision(&mut self, collision: &Collision) {
        self.count_partner(collision.partner);
        match collision.impulse.regime() {
            Regime::Sticking => self.sticking += 1,
            Regime::Sliding => self.sliding += 1,
            Regime::ContactDuration => self.contact_duration += 1,
            Regime::Unspecified => {}
        }
    }
}
