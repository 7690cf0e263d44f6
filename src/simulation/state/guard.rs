//! The pace of the disks: the length of an epoch, and the guard against runs that hardly progress.

use super::Bodies;
use crate::Gravity;
use crate::simulation::Counters;
use glam::DVec2;

/// Number of diameters that a typical disk moves, or falls, in an epoch.
const DIAMETERS: f64 = 64.0;

/// Factor by which a disk may be faster than a typical one before it decides how often the epoch moves.
const FASTER: f64 = 16.0;

/// Largest number of typical diameters that any disk moves in an epoch.
pub(in crate::simulation) const FARTHEST: f64 = FASTER * DIAMETERS;

impl Bodies {
    /// Returns the length of an epoch. A typical disk moves, or falls, tens of diameters in it, and no disk
    /// moves more than [`FASTER`] times as far.
    pub(in crate::simulation) fn epoch_length(&self) -> f64 {
        let squares = || self.particles.iter().map(|particle| particle.trajectory.velocity.length_squared());
        let typical = (squares().sum::<f64>() / self.len() as f64).sqrt();
        self.epoch_length_at(typical.max(squares().fold(0.0, f64::max).sqrt() / FASTER))
    }

    /// Returns the length of an epoch under another gravity.
    pub(in crate::simulation) fn epoch_length_under(&mut self, gravity: Gravity) -> f64 {
        let own = std::mem::replace(&mut self.gravity, gravity);
        let length = self.epoch_length();
        self.gravity = own;
        length
    }

    /// Returns whether a disk of this velocity moves no farther in an epoch of this length than is allowed.
    ///
    /// A collision can make a disk faster than all disks were when the epoch began. Its position at the epoch
    /// would be so far away that it would lack digits.
    #[inline]
    pub(in crate::simulation) fn keeps_pace(&self, velocity: DVec2, epoch_length: f64) -> bool {
        let most = FARTHEST * self.typical_diameter;
        (velocity * epoch_length).length_squared() <= most * most
    }

    /// Returns the length of an epoch that also suits a disk of this velocity.
    pub(in crate::simulation) fn epoch_length_for(&self, velocity: DVec2) -> f64 {
        self.epoch_length_at(velocity.length() / FASTER)
    }

    /// Returns the length of an epoch for this speed. It is a power of two, so that epochs add up without
    /// rounding, between 2⁻⁹⁰⁰ and 2¹⁰²⁰.
    ///
    /// Searches look two epochs ahead, which must be a finite time. Up to the last finite time, there are
    /// then sixteen epochs at most, however slow the disks are.
    fn epoch_length_at(&self, speed: f64) -> f64 {
        let way = DIAMETERS * self.typical_diameter;
        let length = way / (speed + (self.gravity.strength() * way).sqrt());
        // The length is NaN without disks. It is infinite if all disks are at rest without gravity; no search
        // for a wall then needs a horizon.
        if length > 0.0 { libm::scalbn(1.0, libm::ilogb(length).clamp(-900, 1020)) } else { 1.0 }
    }
}

/// Number of events in a window. Progress is judged at its end.
const WINDOW: u64 = 200_000;

/// Number of additional events in a window for each disk. On a lattice, all disks may have an event at the
/// same time.
const WINDOW_PER_DISK: u64 = 20;

/// Number of additional events that the guard counts for a search that ended at its horizon. A search may
/// take this number of steps, each about as long as an event, so the guard bounds the time that searches
/// take, too.
pub(in crate::simulation) const EVENTS_PER_HORIZON: u64 = 255;

/// Largest number of events in an epoch that counts as progress: this number, and [`MOST_EVENTS_PER_DISK`]
/// more for each disk.
///
/// A typical disk moves, or falls, tens of diameters in an epoch. The bounds are far above the rates of dense
/// flows, and of packings with up to about 1e4 collisions for each diameter that a disk moves. They are far
/// below the rates of matter that comes to rest without a remedy. At the bounds, an epoch of a thousand disks
/// still takes minutes and not days.
const MOST_EVENTS: f64 = (1_u64 << 27) as f64;
const MOST_EVENTS_PER_DISK: f64 = (1_u64 << 22) as f64;

/// The start of the present window of events.
///
/// Windows follow each other without a gap, by numbers of events alone. A run therefore stalls at the same
/// event, however the caller cuts it into pieces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::simulation) struct Guard {
    /// Time offset of the window's first event.
    pub(in crate::simulation) since: f64,
    /// Number of all events before the window.
    pub(in crate::simulation) before: u64,
    /// Number of windows in a row in which time hardly advanced.
    pub(in crate::simulation) slow: u32,
    /// Number of consecutive windows, up to the last one, in which time advanced as much as in the window
    /// before.
    pub(in crate::simulation) alike: u32,
    /// Simulated time that the last window covered.
    pub(in crate::simulation) elapsed: f64,
}

/// Relative difference of two windows that are alike.
const ALIKE: f64 = 0.05;

/// A window in which time has hardly advanced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::simulation) struct Standstill {
    pub(in crate::simulation) events: u64,
    pub(in crate::simulation) elapsed: f64,
}

/// Returns the default of the least progress, in simulated time per event, for a run of `disks` disks.
pub(in crate::simulation) fn least_progress(epoch_length: f64, disks: usize) -> f64 {
    epoch_length / (MOST_EVENTS + MOST_EVENTS_PER_DISK * disks as f64)
}

/// Returns the number of events that the guard and the checks of the limits count.
pub(in crate::simulation) fn effort(counters: &Counters) -> u64 {
    counters.events().saturating_add(EVENTS_PER_HORIZON.saturating_mul(counters.horizons))
}

impl Guard {
    /// Returns the number of events until the end of the window; 0 at its end.
    pub(in crate::simulation) fn left(&self, events: u64, disks: usize) -> u64 {
        let window = WINDOW + WINDOW_PER_DISK * disks as u64;
        window.saturating_sub(events.saturating_sub(self.before))
    }

    /// Ends the window before the event at this time offset, after `events` events in all. Returns the window
    /// as a standstill if time has advanced in it by less than `least_progress` for each event. In either
    /// case a new window begins, so that a caller who removes the cause can continue.
    pub(in crate::simulation) fn end_window(
        &mut self,
        offset: f64,
        events: u64,
        least_progress: f64,
    ) -> Option<Standstill> {
        let last = *self;
        let standstill =
            Standstill { events: events.saturating_sub(last.before), elapsed: offset - last.since };
        let is_slow = standstill.elapsed < least_progress * standstill.events as f64;
        let elapsed = standstill.elapsed;
        let is_alike = (elapsed - last.elapsed).abs() <= ALIKE * elapsed.max(last.elapsed);
        let (slow, alike) =
            (last.slow.saturating_add(1), if is_alike { last.alike.saturating_add(1) } else { 0 });
        let (slow, alike) = if is_slow { (slow, alike) } else { (0, 0) };
        *self = Self { since: offset, before: events, slow, alike, elapsed };
        is_slow.then_some(standstill)
    }

    /// Converts the offset to an epoch that is later by this time.
    pub(in crate::simulation) fn shift(&mut self, by: f64) {
        self.since -= by;
    }
}
