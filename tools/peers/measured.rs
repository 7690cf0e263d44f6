//! What is asked of another event-driven program, and what it answers.

use granular_edmd::Disk;

/// The start of another program.
pub(crate) struct Start {
    pub(crate) side: f64,
    pub(crate) disks: Vec<Disk>,
    /// Time of a stretch at the temperature 1.
    pub(crate) time: f64,
}

/// What a stretch of a program took.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Speed {
    /// Time on the processor of a collision.
    pub(crate) nanoseconds: f64,
    /// Collisions of a disk in the time σ√(m/T).
    pub(crate) rate: f64,
}

/// The speed of another program, and PA/(NT) of its disks.
pub(crate) type Measured = (Speed, f64);
