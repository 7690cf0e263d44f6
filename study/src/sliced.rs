//! The run of a value in slices, which the observer sees as a single run. A driving and a companion may take
//! part: the driving is saved with the value, the companion is not.

use std::path::Path;

use granular_edmd::Disk;
use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::observable::{Collision, Observer, ObserverError, SampleTimes, Snapshot, Verdict};
use granular_edmd::simulation::{Driving, Limits, RunEnd, RunError, Simulation};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::ExperimentError;

/// A [`Driving`] that a study saves and restores together with an unfinished value.
///
/// Every driving that serde writes and reads implements this trait. A field that serde skips is not saved: no
/// state may stand in it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a driving that can be saved",
    note = "implement `simulation::Driving`, and derive `Serialize` and `Deserialize`"
)]
pub trait SavedDriving: Driving + Send {
    /// Returns the driving as bytes.
    ///
    /// # Errors
    /// If serde cannot write it.
    fn save(&self) -> Result<Vec<u8>, ExperimentError>;

    /// Restores the state of a saved driving.
    ///
    /// # Errors
    /// If the bytes were saved by another [`Driving`].
    fn load(&mut self, bytes: &[u8]) -> Result<(), ExperimentError>;
}

impl<D: Driving + Serialize + DeserializeOwned + Send> SavedDriving for D {
    fn save(&self) -> Result<Vec<u8>, ExperimentError> {
        postcard::to_stdvec(self).map_err(ExperimentError::new)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), ExperimentError> {
        *self = postcard::from_bytes(bytes).map_err(ExperimentError::new)?;
        Ok(())
    }
}

/// The start of a value, or of the remainder of an interrupted value, for which a
/// [companion](super::Experiment::companion) is made.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Start<'a> {
    /// Folder of the study.
    pub folder: &'a Path,
    /// Index of the ramp.
    pub ramp: usize,
    /// Index of the value in the ramp.
    pub value: usize,
    /// Seed of the ramp.
    pub seed: u64,
    /// Absolute time from which the run starts or continues.
    pub time: f64,
    /// True if the value continues from a saved state. A value whose process was killed before the first save
    /// starts anew, and files of its companion may exist already.
    pub is_resumed: bool,
}

/// The companion and the driving beside the observer.
#[derive(Default)]
pub(super) struct Riders {
    pub(super) driving: Option<Box<dyn SavedDriving>>,
    pub(super) companion: Option<Box<dyn Observer>>,
    /// True if the companion has seen the start of a run and not yet its end.
    pub(super) is_under_way: bool,
}

impl Riders {
    /// Returns the driving as bytes.
    pub(super) fn saved(&self) -> Result<Option<Vec<u8>>, ExperimentError> {
        self.driving.as_ref().map(|driving| driving.save()).transpose()
    }
}

/// Runs until a limit.
///
/// `is_under_way` is true if an earlier slice has begun the run. The observer sees one start and one end,
/// however many slices there are, and an end and a start at each kick of a driving. So does the companion,
/// which each process makes anew.
pub(super) fn run<R: CollisionRule, B: Boundary, O: Observer>(
    simulation: &mut Simulation<R, B>,
    limits: &Limits<'_>,
    riders: &mut Riders,
    observer: &mut O,
    is_under_way: &mut bool,
) -> Result<RunEnd, RunError> {
    let mut driving = riders.driving.as_deref_mut();
    let kicks = driving.as_mut().map(|driving| {
        let times = driving.times();
        times.start_at(simulation.time());
        *times
    });
    let mut sliced = Sliced { observer, is_under_way, kicks };
    let ended = match &mut riders.companion {
        None => run_to(simulation, limits, driving, &mut sliced),
        Some(companion) => {
            let mut other = Sliced { observer: companion, is_under_way: &mut riders.is_under_way, kicks };
            // A single additional event loop serves all companions.
            let both: &mut dyn Observer = &mut (&mut sliced, &mut other);
            let ended = run_to(simulation, limits, driving, both);
            other.end(ended, &simulation.snapshot())
        }
    };
    sliced.end(ended, &simulation.snapshot())
}

fn run_to<R: CollisionRule, B: Boundary, O: Observer + ?Sized>(
    simulation: &mut Simulation<R, B>,
    limits: &Limits<'_>,
    driving: Option<&mut (dyn SavedDriving + 'static)>,
    observer: &mut O,
) -> Result<RunEnd, RunError> {
    match driving {
        Some(driving) => simulation.run_driven(limits, driving, observer),
        None => simulation.run(limits, observer),
    }
}

/// A wrapper that hides from its observer that a run is cut into slices.
struct Sliced<'a, O> {
    observer: &'a mut O,
    is_under_way: &'a mut bool,
    /// The clock of the driving, with the kicks that the observer has not yet seen.
    kicks: Option<SampleTimes>,
}

impl<O: Observer> Sliced<'_, O> {
    /// Reports the end of the run to the observer, unless a slice has merely used up its wall-clock time.
    fn end(self, ended: Result<RunEnd, RunError>, moment: &Snapshot<'_>) -> Result<RunEnd, RunError> {
        if matches!(ended, Ok(RunEnd::WallClock)) || !std::mem::take(self.is_under_way) {
            return ended;
        }
        self.observer.on_end(moment);
        // At this point, a verdict to stop has no effect. A failure must still be reported, as after any run.
        match self.observer.verdict().err().filter(|_| ended.is_ok()) {
            Some(source) => Err(RunError::Observer { time: moment.time(), source }),
            None => ended,
        }
    }
}

impl<O: Observer> Observer for Sliced<'_, O> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        if !std::mem::replace(self.is_under_way, true) {
            self.observer.on_start(start)?;
        }
        Ok(())
    }

    fn on_end(&mut self, moment: &Snapshot<'_>) {
        // The run reaches the time of a kick up to a rounding.
        let is_due = |kicks: &&mut SampleTimes| {
            let next = kicks.upcoming();
            moment.time() >= next - 8.0 * f64::EPSILON * next.abs()
        };
        if let Some(kicks) = self.kicks.as_mut().filter(is_due) {
            kicks.advance_past(kicks.upcoming());
            *self.is_under_way = false;
            self.observer.on_end(moment);
        }
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.observer.on_collision(collision);
    }

    #[inline]
    fn next_sample(&self) -> f64 {
        self.observer.next_sample()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.observer.on_sample(snapshot);
    }

    fn on_insert(&mut self, disk: &Disk, time: f64) {
        self.observer.on_insert(disk, time);
    }

    fn on_remove(&mut self, disk: &Disk, time: f64) {
        self.observer.on_remove(disk, time);
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        self.observer.verdict()
    }
}
