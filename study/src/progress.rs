//! The progress of a study: its ramps, failed values, and the time that it takes.

use super::execution::session::Claims;
use super::folder::remove;
use super::store::{Entry, Head};
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
        let (taken, unfinished) = (self.claims().taken()?, self.folder.unfinished()?);
        let entries = self.store.refreshed()?;
        let begun = entries.heads().map(|head| head.ramp).chain(unfinished.iter().map(|place| place[0]));
        let begun = begun.map(|ramp| (ramp, RampStatus::Begun));
        for (ramp, status) in begun.chain(taken.into_iter().flatten().map(|ramp| (ramp, RampStatus::Running)))
        {
            if let Some(place) = all.get_mut(ramp) {
                *place = status;
            }
        }
        for (ramp, status) in all.iter_mut().enumerate().filter(|(_, status)| **status != RampStatus::Waiting)
        {
            // A ramp that was finished in between counts as finished.
            *status = if entries.is_done(ramp) { RampStatus::Done } else { *status };
        }
        Ok(all)
    }

    fn claims(&self) -> Claims {
        Claims::new(self.folder(), self.plan.ramp_count())
    }

    /// Returns the ramp and value indices of all values that stalled, failed or reached a limit.
    ///
    /// # Errors
    /// If files cannot be read.
    pub fn failed(&self) -> Result<Vec<[usize; 2]>, StudyError> {
        let entries = self.store.refreshed()?;
        let failed = entries.heads().filter(|head| head.has(Head::FAILED));
        Ok(failed.map(|head| [head.ramp, head.value]).collect())
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
        let claim = self.claims().claim(ramp)?;
        let entries = self.store.refreshed()?;
        if claim.is_none() || !entries.is_done(ramp) {
            return Ok(false);
        }
        let heads = || entries.of(ramp..ramp + 1).map(Entry::head);
        let Some(first) = heads().find(|head| head.has(Head::FAILED)) else { return Ok(false) };
        remove(&self.folder.complete())?;
        for value in heads().map(|head| head.value).filter(|value| *value >= first.value) {
            // A process that was killed just after it had finished the value may have left this file.
            remove(&self.folder.partial(ramp, value))?;
            self.store.push(Head::new(ramp, value, Head::VOID, f32::NAN), &[])?;
        }
        self.store.refreshed()?;
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
        let entries = self.store.refreshed()?;
        let timed = || entries.heads().map(|head| f64::from(head.seconds)).filter(|time| !time.is_nan());
        let seconds = timed().fold(0.0, |sum, time| sum + time);
        let all = (self.plan.ramp_count() * self.plan.value_count()) as f64;
        let left = f64::max(all - entries.heads().count() as f64, 0.0);
        Ok((seconds, left * seconds / timed().count() as f64))
    }
}
