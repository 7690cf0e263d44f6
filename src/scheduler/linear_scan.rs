//! The obvious scheduler.

use super::{EventScheduler, NOTHING_DUE};

/// Looks through all times for the earliest at each call: slow, and plainly right. The oracle of all other
/// schedulers.
#[derive(Debug, Clone, Default)]
pub struct LinearScan {
    due: Vec<f64>,
}

impl LinearScan {
    /// Makes a scheduler of no disks.
    pub const fn new() -> Self {
        Self { due: Vec::new() }
    }
}

impl EventScheduler for LinearScan {
    fn reset(&mut self, due: &[f64]) {
        self.due.clear();
        self.due.extend_from_slice(due);
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.due[disk] = due;
    }

    fn earliest(&self) -> (usize, f64) {
        let mut first = NOTHING_DUE;
        for (disk, &due) in self.due.iter().enumerate() {
            // An infinite time is not before that of NOTHING_DUE, but its disk exists.
            if due < first.1 || first.0 == usize::MAX {
                first = (disk, due);
            }
        }
        first
    }
}
