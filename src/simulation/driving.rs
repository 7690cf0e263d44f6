//! Driving in the bulk: changes of all disks at set times, between which the run continues as usual.
//!
//! | driving | change |
//! |---|---|
//! | [`WhiteNoise`] | random kicks, which conserve the total momentum |
//! | [`Rescaling`] | all velocities and spins, by one factor, to a temperature |
//!
//! A custom driving implements [`Driving`]. The event loop does not know about drivings.

mod noise;
mod rescaling;

pub use noise::WhiteNoise;
pub use rescaling::Rescaling;

use std::time::Instant;

use super::limits::rounded_up;
use super::{Limits, RunEnd, RunError, Simulation};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::{Observer, SampleTimes};
use crate::scheduler::EventScheduler;
use crate::{Disk, ParameterError};

/// A driving in the bulk: a change of all disks at set times.
///
/// It is lent to a run, as observers are, and keeps its clock and its random numbers. With the feature
/// `serde`, write it with the state (`Checkpoint::write_with`): a run that is resumed between two kicks then
/// has the bits of an uninterrupted run.
///
/// # Contract
/// A driving guarantees:
/// 1. A kick changes velocities and angular velocities, and nothing else: it neither moves, turns, renames,
///    reorders nor resizes disks, nor changes their masses, kinds or images. A driving that also moves disks
///    must leave them inside the walls and without overlaps, and must declare this to the check.
/// 2. A kick treats disks alike wherever they are in the list, and works without disks, too. If a driving
///    remembers something about a disk, it identifies the disk by its [id](crate::Disk::id), since sinks and
///    inlets change the order.
/// 3. The same driving gives the same kicks to the same disks, to the bit: its random numbers are its own.
/// 4. The clock advances: after a kick, it returns a later time, and returns the same time at each call until
///    the next kick. A run that is cut into pieces has the same kicks.
/// 5. If it promises to conserve momentum, the total momentum stays the same, up to rounding.
///
/// The engine refuses disks that overlap, a change of their number, and a clock that stands still.
///
/// ```
/// use granular_edmd::observable::SampleTimes;
/// use granular_edmd::prelude::*;
/// use granular_edmd::simulation::Driving;
///
/// /// Takes away a tenth of every disk's spin per unit of time.
/// struct Bearings(SampleTimes);
///
/// impl Driving for Bearings {
///     fn times(&mut self) -> &mut SampleTimes {
///         &mut self.0
///     }
///     fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
///         for disk in disks {
///             *disk = disk.with_angular_velocity(0.9 * disk.angular_velocity())?;
///         }
///         Ok(())
///     }
/// }
///
/// let disk = Disk::new(DVec2::new(2.0, 2.0), 0.5)?.with_angular_velocity(1.0)?;
/// let mut run = Simulation::builder(Elastic, Container::periodic(8.0, 8.0)?).disks([disk]).build()?;
/// let mut bearings = Bearings(SampleTimes::every(1.0)?);
/// run.run_driven(&Limits::until(2.5), &mut bearings, &mut ())?;
/// assert!((run.disks()[0].angular_velocity() - 0.81).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Driving {
    /// Returns the clock of the kicks.
    fn times(&mut self) -> &mut SampleTimes;

    /// Changes the disks at a kick.
    ///
    /// # Errors
    /// If the kick is not possible.
    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError>;
}

impl<R: CollisionRule, B: Boundary, S: EventScheduler> Simulation<R, B, S> {
    /// Runs up to the first of the `limits`, as [`Self::run`] does, with kicks at the times of `driving`.
    ///
    /// A kick comes after all events and samples of its time, even at the end of the run. [Two
    /// clocks](SampleTimes#two-clocks) may differ by a rounding there. The bits do not depend on how a run is
    /// cut into pieces.
    ///
    /// The observer watches a run from each kick to the next, with `on_start` and `on_end`, and thus sees the
    /// velocities on both sides of a kick. The observer gets the same samples as in a single run.
    ///
    /// # Errors
    /// The errors of [`Self::run`], and the errors of kicks: [`RunError::Driving`].
    pub fn run_driven<D: Driving + ?Sized, O: Observer + ?Sized>(
        &mut self,
        limits: &Limits<'_>,
        driving: &mut D,
        observer: &mut O,
    ) -> Result<RunEnd, RunError> {
        self.engine.check_end(limits.end()).map_err(|error| *error)?;
        let (start, before) = (Instant::now(), self.counters().collisions());
        driving.times().start_at(self.time());
        loop {
            let next = driving.times().upcoming();
            let left = limits.rest(self.counters().collisions() - before, start.elapsed());
            let failed = |time, source| RunError::Driving { time, source: Box::new(source) };
            if next.is_nan() {
                let error =
                    ParameterError::new("time of the next kick", "a number that is not too late", next);
                return Err(failed(self.time(), error.into()));
            }
            if next > rounded_up(limits.end(), next) {
                return self.run(&left, observer);
            }
            let end = self.run(&left.ending_at(next), observer)?;
            if end != RunEnd::Time {
                return Ok(end);
            }
            let mut disks = self.disks();
            let kicked = driving.kick(&mut disks).map_err(Into::into);
            kicked.and_then(|()| self.replace_disks(&disks)).map_err(|error| failed(self.time(), error))?;
            driving.times().advance_past(next);
            let following = driving.times().upcoming();
            if following <= next {
                let error =
                    ParameterError::new("time of the next kick", "after that of the last kick", following);
                return Err(failed(self.time(), error.into()));
            }
        }
    }
}

/// Returns the kinetic energy of disks.
fn energy_of(disks: &[Disk]) -> f64 {
    disks.iter().map(|disk| disk.translational_energy() + disk.rotational_energy()).sum()
}

/// Returns the velocity of the center of mass; 0 without disks.
pub(crate) fn drift_of(disks: &[Disk]) -> glam::DVec2 {
    let mass: f64 = disks.iter().map(Disk::mass).sum();
    let momentum: glam::DVec2 = disks.iter().map(|disk| disk.mass() * disk.velocity()).sum();
    if mass > 0.0 { momentum / mass } else { momentum }
}
