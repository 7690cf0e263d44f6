//! An observer.

use granular_edmd::observable::{Collision, Observer, Partner, Snapshot};

/// The hardest impact on each wall within each interval of time.
#[derive(Debug, Clone, PartialEq)]
pub struct HardestImpacts {
    interval: f64,
    next: f64,
    present: Vec<f64>,
    /// One row an interval, one number a wall.
    pub hardest: Vec<Vec<f64>>,
}

impl HardestImpacts {
    pub fn new(walls: usize, interval: f64) -> Self {
        Self { interval, next: interval, present: vec![0.0; walls], hardest: Vec::new() }
    }
}

impl Observer for HardestImpacts {
    fn on_collision(&mut self, collision: &Collision) {
        if let Partner::Wall(wall) = collision.partner {
            self.present[wall] = self.present[wall].max(collision.impulse.normal());
        }
    }

    fn next_sample(&self) -> f64 {
        self.next
    }

    fn on_sample(&mut self, _: &Snapshot<'_>) {
        let walls = self.present.len();
        self.hardest.push(std::mem::replace(&mut self.present, vec![0.0; walls]));
        self.next += self.interval;
    }
}
