//! An observer.

use granular_edmd::observable::{Collision, Observer, ObserverError, Partner, SampleTimes, Snapshot};

/// The hardest impact on each wall within each interval of time.
#[derive(Debug, Clone, PartialEq)]
pub struct HardestImpacts {
    times: SampleTimes,
    present: Vec<f64>,
    /// The impacts: one row for each interval, one number for each wall.
    pub hardest: Vec<Vec<f64>>,
}

impl HardestImpacts {
    pub const fn new(times: SampleTimes) -> Self {
        Self { times, present: Vec::new(), hardest: Vec::new() }
    }
}

impl Observer for HardestImpacts {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.times.start_at(start.time());
        self.present.resize(start.wall_count(), 0.0);
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        if let Partner::Wall(wall) = collision.partner {
            // Single steps have no start that would tell the number of walls.
            self.present.resize(self.present.len().max(wall + 1), 0.0);
            self.present[wall] = self.present[wall].max(collision.impulse.normal());
        }
    }

    fn next_sample(&self) -> f64 {
        self.times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        let walls = self.present.len();
        self.hardest.push(std::mem::replace(&mut self.present, vec![0.0; walls]));
        self.times.advance_past(snapshot.time());
    }
}
