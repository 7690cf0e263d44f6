//! The obvious scheduler.

use super::EventScheduler;

/// Looks through all times for the earliest: slow, and plainly right. The oracle for all other schedulers.
#[derive(Debug, Clone, Default)]
pub struct LinearScan {
    due: Vec<f64>,
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
        let mut first = (usize::MAX, f64::INFINITY);
        for (disk, &due) in self.due.iter().enumerate() {
            if due < first.1 || first.0 == usize::MAX {
                first = (disk, due);
            }
        }
        first
    }
}
