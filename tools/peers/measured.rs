//! The input of another event-driven program, and its results.

use granular_edmd::Disk;

/// The initial state for another program.
pub(crate) struct Start {
    pub(crate) side: f64,
    pub(crate) disks: Vec<Disk>,
    /// Length of an interval at temperature 1.
    pub(crate) time: f64,
}

/// The speed of a program in one interval.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Speed {
    /// Processor time per collision.
    pub(crate) nanoseconds: f64,
    /// Number of collisions of a disk in the time σ√(m/T).
    pub(crate) rate: f64,
}

/// The speed of another program, and PA/(NT) of its disks.
pub(crate) type Measured = (Speed, f64);
