//! The results of a study and its progress: records, points and transitions; ramps, failed values, and the
//! time that it takes.

use std::ops::Range;

use granular_edmd::statistics::Estimate;

use super::experiment::record::{Contents, Leg, Record};
use super::folder::remove;
use super::plan::ramp::{Bracket, Seen};
use super::store::{Entry, Head};
use super::{Experiment, Study, StudyError};

/// A value at a point of the grid, with the records of its repeats, which have the same parameters and
/// different seeds.
///
/// ```
/// # use granular_edmd_study::vibrated_box::{Base, VibratedBox};
/// # use granular_edmd_study::{Control, Plan, Protocol, Study};
/// # let base = Base::Thermal { temperature: 1.0, slip: false };
/// # let plan = Plan::new(VibratedBox::new(10, 10.0, base).with_gravity(0.1), Protocol::new(10, 20, 1)?, 1)?;
/// # let plan = plan.with_repeats(3)?;
/// # let folder = std::env::temp_dir().join(format!("granular-edmd-point-{}", std::process::id()));
/// # let study = Study::create(&folder, &plan)?;
/// # study.run(&Control::default())?;
/// for point in study.points() {
///     let point = point?;
///     let height = point.mean(|sample| sample.height);
///     println!("{height}, as from {:.1} independent samples", height.independent_samples());
///     assert_eq!((point.records().len(), height.samples()), (3, 60));
/// }
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Point<E: Experiment> {
    /// The records of the finished repeats, at least one.
    records: Vec<Record<E>>,
}

impl<E: Experiment> Point<E> {
    /// Returns the direction from which the ramp came to the value; `None` without a ramp.
    pub fn leg(&self) -> Option<Leg> {
        self.records[0].leg()
    }

    /// Returns the experiment, with the parameters of this value.
    pub fn experiment(&self) -> &E {
        self.records[0].experiment()
    }

    /// Returns the records of the finished repeats.
    pub fn records(&self) -> &[Record<E>] {
        &self.records
    }

    /// Returns the mean of a quantity over the samples of all repeats, by [`Estimate::over_repeats`].
    pub fn mean(&self, quantity: impl Fn(&E::Sample) -> f64) -> Estimate {
        Estimate::over_repeats(self.records.iter().map(|record| record.mean(&quantity)))
    }

    /// Returns the mean over all repeats of the column of this name, or `None` if no column of this name has
    /// an error.
    pub fn estimate(&self, column: &str) -> Option<Estimate> {
        let repeats = self.records.iter().map(|record| record.estimate(column));
        repeats.collect::<Option<Vec<_>>>().map(Estimate::over_repeats)
    }
}

impl<E: Experiment> Study<E> {
    /// Returns the record of a value, or `None` if the value is not finished.
    ///
    /// # Errors
    /// If there is no such ramp, or if the record cannot be read, is damaged, or comes from another study or
    /// other code.
    pub fn record(&self, ramp: usize, value: usize) -> Result<Option<Record<E>>, StudyError> {
        self.check_ramp(ramp)?;
        if self.store.find(ramp, value).is_none() {
            self.store.refresh_block(self.store.block_of(ramp))?;
        }
        match (self.known_record(ramp, value)?, self.store.damage(self.store.block_of(ramp))) {
            (None, Some(error)) => Err(error),
            (found, _) => Ok(found),
        }
    }

    /// Returns the record of a value, or `None` if the value was not finished when the store was last read.
    pub(super) fn known_record(&self, ramp: usize, value: usize) -> Result<Option<Record<E>>, StudyError> {
        self.store.find(ramp, value).map(|entry| self.read(&entry)).transpose()
    }

    /// Reads a record of the store.
    pub(super) fn read(&self, entry: &Entry) -> Result<Record<E>, StudyError> {
        let record = self.read_unproven(entry)?;
        // Code that the study has accepted may differ from this program.
        let is_ours = self.is_ours(&record.contents.origin);
        match record.changed_part().filter(|_| is_ours) {
            Some(part) => Err(StudyError::changed(&self.store.log_of(entry.head().ramp), part)),
            None => Ok(record),
        }
    }

    /// Reads a record of the store without comparing the fingerprints of rule and walls, which would require
    /// making them.
    pub(super) fn read_unproven(&self, entry: &Entry) -> Result<Record<E>, StudyError> {
        let (head, contents) = (entry.head(), self.store.read::<Contents<_, _>>(entry)?);
        self.check_origin(&contents.origin, head.ramp, head.value, &self.store.log_of(head.ramp))?;
        Ok(Record { experiment: self.plan.experiment_at(head.ramp, contents.at)?, contents })
    }

    /// Iterates over all finished records, ramp by ramp, and reads them one by one.
    pub fn records(&self) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        self.records_of(Ok(0..self.plan.ramp_count()))
    }

    /// Iterates over all finished records of a ramp, and reads them one by one.
    ///
    /// If there is no such ramp, the only item is an error.
    pub fn ramp_records(&self, ramp: usize) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        self.records_of(self.check_ramp(ramp).map(|()| ramp..ramp + 1))
    }

    fn records_of(
        &self,
        ramps: Result<Range<usize>, StudyError>,
    ) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        let found = ramps.and_then(|ramps| self.store.refresh().map(|()| ramps));
        let (ramps, error) = match found {
            Ok(ramps) => (ramps, None),
            Err(error) => (0..0, Some(error)),
        };
        error.into_iter().map(Err).chain(self.store.of(ramps).map(|entry| self.read(&entry)))
    }

    /// Returns a value at a point of the grid, with all its finished repeats, if there are any.
    fn known_point(&self, index: usize, value: usize) -> Result<Option<Point<E>>, StudyError> {
        let repeats = self.plan.repeats();
        let ramps = index * repeats..(index + 1) * repeats;
        let records = ramps.filter_map(|ramp| self.known_record(ramp, value).transpose());
        let records = records.collect::<Result<Vec<_>, _>>()?;
        Ok((!records.is_empty()).then_some(Point { records }))
    }

    /// Reads, one by one, all values that have a finished repeat, at all points of the grid.
    ///
    /// Values that a refinement adds are left out, since different repeats have different ones.
    pub fn points(&self) -> impl Iterator<Item = Result<Point<E>, StudyError>> {
        let error = self.store.refresh().err();
        let values = move |index| (0..self.plan.value_count()).map(move |value| (index, value));
        let places = (0..self.plan.point_count()).flat_map(values);
        let found = places.filter_map(|(index, value)| self.known_point(index, value).transpose());
        error.into_iter().map(Err).chain(found)
    }

    /// Returns the transitions that a refined ramp has bracketed. The list is empty until all transitions are
    /// bracketed.
    ///
    /// # Errors
    /// If there is no such ramp, or if a record cannot be read, is damaged, or comes from another study or
    /// other code.
    pub fn transitions(&self, ramp: usize) -> Result<Vec<Bracket>, StudyError> {
        let seen: Vec<Seen> = self
            .ramp_records(ramp)
            .map(|record| Ok(self.plan.seen(&record?)))
            .collect::<Result<_, StudyError>>()?;
        Ok(self.plan.brackets(&seen))
    }
}

/// Progress of a ramp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RampStatus {
    /// All values of the ramp have a record.
    Done,
    /// A process is running the ramp.
    Running,
    /// Some work on the ramp is saved, but the ramp is not finished, and no process is known to be running
    /// it.
    Begun,
    /// No work on the ramp is saved, and no process is known to be running the ramp.
    Waiting,
}

impl<E: Experiment> Study<E> {
    /// Returns the progress of all ramps.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn all_status(&self) -> Result<Vec<RampStatus>, StudyError> {
        let mut all = vec![RampStatus::Waiting; self.plan.ramp_count()];
        let (taken, unfinished) = (self.store.taken(), self.folder.unfinished()?);
        self.store.refresh()?;
        let begun = self.store.heads().map(|head| head.ramp).chain(unfinished.iter().map(|place| place[0]));
        let begun = begun.map(|ramp| (ramp, RampStatus::Begun));
        for (ramp, status) in begun.chain(taken.map(|ramp| (ramp, RampStatus::Running))) {
            if let Some(place) = all.get_mut(ramp) {
                *place = status;
            }
        }
        for (ramp, status) in all.iter_mut().enumerate().filter(|(_, status)| **status != RampStatus::Waiting)
        {
            // A ramp that was finished in between counts as finished.
            *status = if self.store.is_done(ramp) { RampStatus::Done } else { *status };
        }
        Ok(all)
    }

    /// Returns the ramp and value indices of all values that stalled, failed or reached a limit.
    ///
    /// # Errors
    /// If files cannot be read.
    pub fn failed(&self) -> Result<Vec<[usize; 2]>, StudyError> {
        self.with_mark(Head::FAILED)
    }

    /// Returns the ramp and value indices of all values whose runs have [warnings](crate::Record::warnings).
    ///
    /// # Errors
    /// If files cannot be read.
    pub fn warned(&self) -> Result<Vec<[usize; 2]>, StudyError> {
        self.with_mark(Head::WARNED)
    }

    fn with_mark(&self, mark: u32) -> Result<Vec<[usize; 2]>, StudyError> {
        self.store.refresh()?;
        let found = self.store.heads().filter(|head| head.has(mark));
        Ok(found.map(|head| [head.ramp, head.value]).collect())
    }

    /// Marks the first failed value of a finished ramp and all later values as unfinished, since a new result
    /// changes the states from which the later values start. The next run computes these values again.
    /// Returns whether there were failed values. A failed value has stalled, failed or reached a limit.
    ///
    /// The same code fails again, with the same bytes: call this for code whose changes were
    /// [accepted](Self::accept_changes), or with a longer limit of seconds. A ramp that another process is
    /// running is not changed.
    ///
    /// # Errors
    /// If there is no such ramp, the plan or the code of the study has changed, or files cannot be read or
    /// written.
    pub fn forget_failed(&self, ramp: usize) -> Result<bool, StudyError> {
        self.check_ramp(ramp)?;
        self.check_unchanged()?;
        let block = self.store.block_of(ramp);
        let Some(_claim) = self.store.claim(block)? else { return Ok(false) };
        if !self.store.is_done(ramp) {
            return Ok(false);
        }
        let heads: Vec<Head> = self.store.of(ramp..ramp + 1).map(|entry| entry.head()).collect();
        let Some(first) = heads.iter().position(|head| head.has(Head::FAILED)) else { return Ok(false) };
        remove(&self.folder.complete())?;
        for Head { value, .. } in heads.into_iter().skip(first) {
            // A process that was killed just after it had finished the value may have left this file.
            remove(&self.folder.partial(ramp, value))?;
            self.store.push(Head { ramp, value, marks: Head::VOID, seconds: f32::NAN }, &[])?;
        }
        self.store.sync(block)?;
        Ok(true)
    }

    /// Returns the seconds of one thread that the finished values took, and an estimate for the other values,
    /// which assumes that they take as long on average. The estimate is NaN before a value is finished.
    ///
    /// The first number is a lower bound: for a value that was interrupted, only the time since it was last
    /// resumed counts.
    ///
    /// # Errors
    /// If files cannot be read.
    pub fn seconds(&self) -> Result<(f64, f64), StudyError> {
        self.store.refresh()?;
        let timed = || self.store.heads().map(|head| f64::from(head.seconds)).filter(|time| !time.is_nan());
        let seconds = timed().fold(0.0, |sum, time| sum + time);
        let all = (self.plan.ramp_count() * self.plan.value_count()) as f64;
        let left = f64::max(all - self.store.heads().count() as f64, 0.0);
        Ok((seconds, left * seconds / timed().count() as f64))
    }
}
