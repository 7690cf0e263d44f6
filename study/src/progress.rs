//! The progress of a study: its ramps, failed values, and the time that it takes.

use super::folder::remove;
use super::store::Head;
use super::{Experiment, Study, StudyError};

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
    /// Returns the progress of a ramp.
    ///
    /// # Errors
    /// If there is no such ramp, or the folder cannot be read.
    pub fn status(&self, ramp: usize) -> Result<RampStatus, StudyError> {
        self.check_ramp(ramp)?;
        Ok(self.all_status()?[ramp])
    }

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
