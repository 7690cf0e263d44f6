//! Driving in the bulk: changes of all disks at set times, between which the run continues as usual.
//!
//! | driving | change |
//! |---|---|
//! | [`WhiteNoise`] | random kicks, which conserve the total momentum |
//! | [`Rescaling`] | all velocities and spins, by one factor, to a temperature |
//!
//! A custom driving implements [`Driving`]. The event loop does not know about drivings.

use std::time::Instant;

use glam::DVec2;

use super::limits::rounded_up;
use super::{Limits, RunEnd, RunError, Simulation};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::disk::LEAST_THERMAL;
use crate::observable::{Observer, SampleTimes};
use crate::quantity::{accept, non_negative, positive};
use crate::random::{Stream, derived_seed, generator_at, normal};
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
///    must leave them inside the walls and without overlaps.
/// 2. A kick treats disks alike wherever they are in the list, and works without disks, too. If a driving
///    remembers something about a disk, it identifies the disk by its [id](crate::Disk::id), since sinks and
///    inlets change the order.
/// 3. The same driving gives the same kicks to the same disks, to the bit: its random numbers are its own.
/// 4. The clock advances: after a kick, it returns a later time, and returns the same time at each call until
///    the next kick. A run that is cut into pieces has the same kicks.
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
        let mut last = f64::NEG_INFINITY;
        loop {
            let next = driving.times().upcoming();
            let left = limits.rest(self.counters().collisions() - before, start.elapsed());
            let failed = |time, source| RunError::Driving { time, source: Box::new(source) };
            if next.is_nan() || next <= last {
                let requirement = "not too late, and after that of the last kick";
                let error = ParameterError::new("time of the next kick", requirement, next);
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
            last = next;
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

/// White noise: at each time of a clock, every disk gets a random kick, and the total momentum is conserved.
///
/// Each component of each velocity gains a normal variable of variance $`\xi_0^2 t`$ in a time $`t`$. The
/// mean of all kicks, weighted by mass, is then subtracted. Thus the temperature of $`N`$ equal disks of mass
/// $`m`$ grows at the rate
///
/// ```math
/// \dot T = m\,\xi_0^2\left(1-\tfrac1N\right),
/// ```
///
/// and, with [rotational noise](Self::with_rotational_noise), $`\dot T_r = I\,\xi_r^2`$. The noise is white
/// if the kicks are more frequent than collisions. At each kick, all events are predicted anew, so a kick
/// takes about as long as one collision per disk.
///
/// The random numbers of a kick follow from the seed and the time of the kick. A noise that is made anew with
/// the same seed therefore goes on, instead of repeating its kicks. A second noise of one run needs another
/// seed or [stream](Self::with_stream).
///
/// ```
/// use granular_edmd::observable::{EnergyChange, SampleTimes};
/// use granular_edmd::prelude::*;
/// use granular_edmd::simulation::WhiteNoise;
///
/// let container = Container::periodic(20.0, 20.0)?;
/// let disks = initial::lattice(&container, 100, 0.5)?;
/// let mut run = Simulation::builder(Smooth::from_restitution(0.9)?, container).disks(disks).build()?;
/// let mut noise = WhiteNoise::new(0.1, SampleTimes::every(0.1)?, 7)?;
/// let mut lost = EnergyChange::default();
/// run.run_driven(&Limits::until(20.0), &mut noise, &mut lost)?;
/// // The present energy is what the kicks added, less what collisions dissipated.
/// let lost = lost.disks().sum();
/// let energy: f64 = run.disks().iter().map(Disk::translational_energy).sum();
/// assert!((noise.energy() + lost - energy).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Source: D. R. M. Williams and F. C. MacKintosh, Phys. Rev. E 54, R9 (1996); T. P. C. van Noije and M. H.
/// Ernst, Granular Matter 1, 57 (1998).
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct WhiteNoise {
    noise: f64,
    rotational_noise: f64,
    times: SampleTimes,
    seed: u64,
    /// Time of the latest kick, and the number of kicks at this time.
    latest: (f64, u64),
    energy: f64,
}

impl WhiteNoise {
    /// Creates noise of this strength $`\xi_0^2`$, the variance that a component of a velocity gains per unit
    /// of time.
    ///
    /// # Errors
    /// If the strength is negative or not finite.
    pub fn new(noise: f64, times: SampleTimes, seed: u64) -> Result<Self, ParameterError> {
        let (noise, times) = (non_negative("noise", noise)?, times.equally_spaced()?);
        Ok(Self { noise, rotational_noise: 0.0, times, seed, latest: (0.0, 0), energy: 0.0 })
    }

    /// Returns the same noise, which also kicks the spins: $`\xi_r^2`$ is the variance that an angular
    /// velocity gains per unit of time.
    ///
    /// # Errors
    /// If the strength is negative or not finite.
    pub fn with_rotational_noise(self, noise: f64) -> Result<Self, ParameterError> {
        Ok(Self { rotational_noise: non_negative("rotational noise", noise)?, ..self })
    }

    /// Returns the same noise with the random numbers of the stream with this number, for a second noise of
    /// the same seed.
    #[must_use]
    pub const fn with_stream(self, number: u64) -> Self {
        Self { seed: derived_seed(self.seed, Stream::Noise, number), ..self }
    }

    /// Returns the kinetic energy that all kicks have added so far.
    pub const fn energy(&self) -> f64 {
        self.energy
    }
}

impl Driving for WhiteNoise {
    fn times(&mut self) -> &mut SampleTimes {
        &mut self.times
    }

    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        let before = energy_of(disks);
        let [speed, spin] =
            [self.noise, self.rotational_noise].map(|noise| (noise * self.times.interval()).sqrt());
        let (drift, time) = (drift_of(disks), self.times.upcoming());
        // A caller without a run may kick several times while the clock stands still.
        let earlier = if time == self.latest.0 { self.latest.1 } else { 0 };
        self.latest = (time, earlier + 1);
        let mut random = generator_at(self.seed, Stream::Noise, earlier, time);
        for disk in &mut *disks {
            let kick = DVec2::new(normal(&mut random), normal(&mut random));
            let turn = if spin > 0.0 { spin * normal(&mut random) } else { 0.0 };
            *disk = disk.with_velocity(disk.velocity() + speed * kick)?;
            *disk = disk.with_angular_velocity(disk.angular_velocity() + turn)?;
        }
        let gained = drift_of(disks) - drift;
        for disk in &mut *disks {
            *disk = disk.with_velocity(disk.velocity() - gained)?;
        }
        self.energy += energy_of(disks) - before;
        Ok(())
    }
}

crate::gate::from_file! {
    WhiteNoise {
        noise: f64, rotational_noise: f64, times: SampleTimes, seed: u64, latest: (f64, u64), energy: f64
    } => {
        let noise = Self::new(noise, times, seed)?.with_rotational_noise(rotational_noise)?;
        Ok(Self { latest, energy: crate::quantity::finite("energy of the kicks", energy)?, ..noise })
    }
}

/// Rescaling: at each time of a clock, all velocities about their mean, and all spins, are multiplied by one
/// factor, so that the translational temperature is $`T = \tfrac12\langle m v'^2\rangle`$.
///
/// Under a rule without a speed scale, this changes nothing but the unit of time: a rescaled gas has the same
/// $`T_r/T`$ and cumulants as a gas that cools, but never becomes slow.
///
/// ```
/// use granular_edmd::observable::{SampleTimes, Temperatures};
/// use granular_edmd::prelude::*;
/// use granular_edmd::simulation::Rescaling;
///
/// let container = Container::periodic(20.0, 20.0)?;
/// let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 100, 0.5)?, 1.0, 1)?;
/// let disks = initial::without_drift(disks)?;
/// let mut run = Simulation::builder(Smooth::from_restitution(0.8)?, container).disks(disks).build()?;
/// let mut rescaling = Rescaling::new(2.0, SampleTimes::every(0.5)?)?;
/// run.run_driven(&Limits::until(50.0), &mut rescaling, &mut ())?;
/// assert!((run.measure(&Temperatures).translational() - 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rescaling {
    temperature: f64,
    times: SampleTimes,
    energy: f64,
}

impl Rescaling {
    /// Creates a rescaling to this translational temperature.
    ///
    /// # Errors
    /// If the temperature is not finite and positive.
    pub fn new(temperature: f64, times: SampleTimes) -> Result<Self, ParameterError> {
        Ok(Self { temperature: positive("temperature", temperature)?, times, energy: 0.0 })
    }

    /// Returns the kinetic energy that all rescalings have added so far.
    pub const fn energy(&self) -> f64 {
        self.energy
    }
}

impl Driving for Rescaling {
    fn times(&mut self) -> &mut SampleTimes {
        &mut self.times
    }

    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        if disks.is_empty() {
            return Ok(());
        }
        let (before, drift) = (energy_of(disks), drift_of(disks));
        let about = |mean: DVec2| -> f64 {
            disks.iter().map(|disk| disk.mass() * (disk.velocity() - mean).length_squared()).sum()
        };
        let (squares, whole) = (about(drift), about(DVec2::ZERO));
        let present = 0.5 * squares / disks.len() as f64;
        let is_known = present > 0.0 && squares > LEAST_THERMAL * LEAST_THERMAL * whole;
        let requirement = "positive, and above the rounding of velocities";
        accept(is_known, "temperature before a rescaling", requirement, present)?;
        let factor = (self.temperature / present).sqrt();
        for disk in &mut *disks {
            let velocity = drift + factor * (disk.velocity() - drift);
            *disk = disk.with_velocity(velocity)?;
            *disk = disk.with_angular_velocity(factor * disk.angular_velocity())?;
        }
        self.energy += energy_of(disks) - before;
        Ok(())
    }
}

crate::gate::from_file! {
    Rescaling { temperature: f64, times: SampleTimes, energy: f64 } => {
        let energy = crate::quantity::finite("energy of the rescalings", energy)?;
        Ok(Self { energy, ..Self::new(temperature, times)? })
    }
}
