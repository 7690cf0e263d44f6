//! The simplest scheduler.

use super::{EventScheduler, NOTHING_DUE};

/// The simplest scheduler, which searches all times for the earliest at each call.
///
/// It is slow and obviously right, so all other schedulers are tested against it.
#[derive(Debug, Clone, Default)]
pub struct LinearScan {
    due: Vec<f64>,
}

impl LinearScan {
    /// Creates a scheduler without disks.
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
            // An infinite time is not before the time of `NOTHING_DUE`, but its disk exists.
            if due < first.1 || first.0 == usize::MAX {
                first = (disk, due);
            }
        }
        first
    }
}
