//! The results of a study: records, points, transitions and progress, and tables of the records.

use std::path::Path;

use super::experiment::record::{Contents, Outcome, Record, check, check_state};
use super::folder::{self, Lock, Mark, sealed};
use super::plan::refinement::{Bracket, Seen};
use super::plan::values::tried;
use super::tables::{self, Tables};
use super::{Experiment, Plan, Point, Study, StudyError};

/// Number of ramps whose first records are read ahead of a table.
const AHEAD: usize = 4096;

/// Progress of a ramp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RampStatus {
    /// All values of the ramp have a record.
    Done,
    /// A process is doing the ramp.
    Running,
    /// A process has begun the ramp, and none is doing it now.
    Begun,
    /// No process has begun the ramp.
    Waiting,
}

impl<E: Experiment> Study<E> {
    /// Returns the record of a value; `None` if it is not finished.
    ///
    /// # Errors
    /// If there is no such ramp, or the file is damaged, of another study, of other code, or cannot be read.
    pub fn record(&self, ramp: usize, value: usize) -> Result<Option<Record<E>>, StudyError> {
        self.check_ramp(ramp)?;
        let path = self.folder.record(ramp, value);
        let Some(contents) = sealed::read_sealed::<Contents<_, _>>(&path)? else { return Ok(None) };
        self.check_origin(&contents.origin, ramp, value, &path)?;
        let spans = |at| self.plan.ramp().is_some_and(|ramp| ramp.spans(at));
        if contents.at.is_some_and(|at| !spans(at)) {
            return Err(sealed::damaged(&path, "it is outside the ramp"));
        }
        let record = Record { experiment: self.plan.experiment_at(ramp, contents.at)?, contents };
        check_record(&record, &self.plan).map_err(|reason| sealed::damaged(&path, reason))?;
        // Accepted code differs from this program on purpose.
        match record.changed_part().filter(|_| self.is_ours(&record.contents.origin)) {
            Some(part) => Err(StudyError::Changed { path, part }),
            None => Ok(Some(record)),
        }
    }

    /// Iterates over all finished records, ramp by ramp, and reads them one by one.
    pub fn records(&self) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        (0..self.plan.ramp_count()).flat_map(|ramp| self.ramp_records(ramp))
    }

    /// Iterates over all finished records of a ramp, and reads them one by one.
    ///
    /// If there is no such ramp, the only item is an error.
    pub fn ramp_records(&self, ramp: usize) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        let missing = self.check_ramp(ramp).err();
        let values = if missing.is_some() { 0 } else { self.plan.value_count() };
        let own = (0..values).filter_map(move |value| self.record(ramp, value).transpose());
        // The values of a refinement have no gaps, and their number is known only at the end.
        let is_refined = self.plan.is_refined() && missing.is_none();
        let more = (values..)
            .take_while(move |_| is_refined)
            .map_while(move |value| self.record(ramp, value).transpose());
        missing.into_iter().map(Err).chain(own).chain(more)
    }

    /// Returns a value at a point of the grid, with all its finished repeats; `None` if there are none.
    ///
    /// # Errors
    /// If there is no such point, or a record is damaged, of another study, or cannot be read.
    pub fn point(&self, index: usize, value: usize) -> Result<Option<Point<E>>, StudyError> {
        let points = self.plan.point_count();
        if index >= points {
            return Err(StudyError::NoSuchPoint { point: index, points });
        }
        let repeats = self.plan.repeats();
        let ramps = index * repeats..(index + 1) * repeats;
        let records = ramps.filter_map(|ramp| self.record(ramp, value).transpose());
        Ok(Point::of(index, value, records.collect::<Result<_, _>>()?))
    }

    /// Iterates over all values at all points of the grid that have a finished repeat, and reads them one by
    /// one.
    ///
    /// The values that a refinement adds differ between repeats, and are not among them.
    pub fn points(&self) -> impl Iterator<Item = Result<Point<E>, StudyError>> {
        let values = move |index| (0..self.plan.value_count()).map(move |value| (index, value));
        let places = (0..self.plan.point_count()).flat_map(values);
        places.filter_map(|(index, value)| self.point(index, value).transpose())
    }

    /// Returns the transitions that a refined ramp has bracketed; empty before all of them are.
    ///
    /// # Errors
    /// If there is no such ramp, or a record is damaged, of another study, or cannot be read.
    pub fn transitions(&self, ramp: usize) -> Result<Vec<Bracket>, StudyError> {
        let seen: Vec<Seen> = self
            .ramp_records(ramp)
            .map(|record| Ok(self.plan.seen(&record?)))
            .collect::<Result<_, StudyError>>()?;
        Ok(self.brackets(&seen))
    }

    fn brackets(&self, seen: &[Seen]) -> Vec<Bracket> {
        self.plan.ramp().map_or_else(Vec::new, |ramp| ramp.brackets(seen))
    }

    /// Returns the progress of a ramp.
    ///
    /// # Errors
    /// If there is no such ramp.
    pub fn status(&self, ramp: usize) -> Result<RampStatus, StudyError> {
        self.check_ramp(ramp)?;
        let mark = self.folder.marks(ramp..ramp + 1)?[0];
        Ok(self.status_of(ramp, mark, self.folder.log_of(ramp).exists()))
    }

    /// Returns the progress of all ramps.
    ///
    /// It is much faster than [`Self::status`] of each of them.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn all_status(&self) -> Result<Vec<RampStatus>, StudyError> {
        let ramps = self.plan.ramp_count();
        // In this order, a ramp that is done meanwhile is done.
        let begun = self.folder.all_begun(ramps)?;
        let marks = self.folder.marks(0..ramps)?;
        Ok((0..ramps).map(|ramp| self.status_of(ramp, marks[ramp], begun[ramp])).collect())
    }

    fn status_of(&self, ramp: usize, mark: Mark, is_begun: bool) -> RampStatus {
        match (mark, is_begun) {
            (Mark::Done | Mark::Failed, _) => RampStatus::Done,
            (Mark::Open, false) => RampStatus::Waiting,
            (Mark::Open, true) if Lock::is_taken(&self.folder.log_of(ramp)) => RampStatus::Running,
            (Mark::Open, true) => RampStatus::Begun,
        }
    }

    /// Returns ramp and value of those values that stalled or failed, in the ramps that are done.
    ///
    /// # Errors
    /// If a record of such a ramp is damaged, or files cannot be read.
    pub fn failed(&self) -> Result<Vec<[usize; 2]>, StudyError> {
        let marks = self.folder.marks(0..self.plan.ramp_count())?.into_iter().enumerate();
        let ramps = marks.filter(|(_, mark)| *mark == Mark::Failed).map(|(ramp, _)| ramp);
        ramps.flat_map(|ramp| self.failed_in(ramp)).collect()
    }

    fn failed_in(&self, ramp: usize) -> impl Iterator<Item = Result<[usize; 2], StudyError>> {
        let all = self.ramp_records(ramp);
        let failed =
            all.filter(|record| !record.as_ref().is_ok_and(|record| record.outcome().reason().is_none()));
        failed.map(|record| record.map(|record| [record.ramp_index(), record.value_index()]))
    }

    /// Removes the failed values of a ramp that is done, and all values after the first of them, since they
    /// started from other states. The next run does them again. Returns whether there were any.
    ///
    /// The same code fails again, with the same bytes: call this for code whose changes were
    /// [accepted](Self::accept_changes). A ramp that another process does is left alone.
    ///
    /// # Errors
    /// If there is no such ramp, plan or code of the study have changed, or files cannot be read or removed.
    pub fn forget_failed(&self, ramp: usize) -> Result<bool, StudyError> {
        self.check_ramp(ramp)?;
        self.check_unchanged()?;
        let Some((_lock, _)) = self.folder.take(ramp)? else { return Ok(false) };
        if self.folder.marks(ramp..ramp + 1)? != [Mark::Failed] {
            return Ok(false);
        }
        let Some([_, first]) = self.failed_in(ramp).next().transpose()? else { return Ok(false) };
        self.folder.mark_incomplete()?;
        self.folder.mark(ramp, Mark::Open)?;
        self.folder.remove_records(ramp, first).map(|()| true)
    }

    /// Returns the seconds of one processor that the finished values took, and those that the others will
    /// take if they are like them; the latter is NaN before a value is finished.
    ///
    /// Both are about right: they follow from the logs of 1024 ramps at most, and a value that was
    /// interrupted logs its last piece alone.
    pub fn seconds(&self, all: &[RampStatus]) -> (f64, f64) {
        let ramps: Vec<usize> = (0..all.len()).filter(|&ramp| all[ramp] != RampStatus::Waiting).collect();
        let looked: Vec<_> = tried(ramps.len()).map(|index| self.folder.logged(ramps[index])).collect();
        let scale = ramps.len() as f64 / looked.len().max(1) as f64;
        let values: Vec<Option<f64>> = looked.into_iter().flatten().collect();
        let timed: Vec<f64> = values.iter().copied().flatten().collect();
        let seconds: f64 = timed.iter().sum();
        let left = (all.len() * self.plan.value_count()) as f64 - scale * values.len() as f64;
        (scale * seconds, f64::max(left, 0.0) * seconds / timed.len() as f64)
    }

    /// Returns whether the folder has tables of all values.
    pub fn has_tables(&self) -> bool {
        self.folder.is_complete() && tables::files(&self.plan, self.folder()).all(|file| file.exists())
    }

    /// Writes the tables of all finished records into the folder of the study, and returns the number of
    /// these records.
    ///
    /// A run does this when all ramps are done. Call it earlier to look at what is there. Tables are written
    /// row by row, so they may be larger than memory.
    ///
    /// # Errors
    /// If a record is damaged or missing, or a file cannot be read or written.
    pub fn write_tables(&self) -> Result<usize, StudyError> {
        let _lock = self.folder.lock()?;
        self.tables(self.folder())
    }

    /// Writes the tables of all finished records into another folder, and returns the number of these
    /// records.
    ///
    /// # Errors
    /// The same as for [`Self::write_tables`], and if the folder has a table of one of these names.
    pub fn write_tables_to(&self, folder: impl AsRef<Path>) -> Result<usize, StudyError> {
        let folder = folder.as_ref();
        folder::create(folder)?;
        if let Some(path) = tables::files(&self.plan, folder).find(|path| path.exists()) {
            return Err(StudyError::Taken { path });
        }
        self.tables(folder)
    }

    /// Writes tables, and returns the number of records in them.
    pub(super) fn tables(&self, folder: &Path) -> Result<usize, StudyError> {
        let marks = self.folder.marks(0..self.plan.ramp_count())?;
        let mut tables = Tables::new(&self.plan, folder)?;
        let mut finished = 0;
        for (ramp, mark) in marks.into_iter().enumerate() {
            if ramp.is_multiple_of(AHEAD) {
                self.folder.read_ahead(ramp..self.plan.ramp_count().min(ramp + AHEAD));
            }
            let mut seen = Vec::new();
            for record in self.ramp_records(ramp) {
                let record = record?;
                tables.add(&record)?;
                seen.push(self.plan.seen(&record));
                finished += 1;
            }
            // A table that lacks a row must not look complete.
            if mark != Mark::Open && seen.len() < self.plan.value_count() {
                let path = self.folder.record(ramp, seen.len());
                return Err(sealed::damaged(&path, "a record of a ramp that is done is missing"));
            }
            tables.end_ramp(ramp, &self.brackets(&seen))?;
        }
        tables.finish()?;
        Ok(finished)
    }
}

/// Checks that a record fits its place in a study, or returns the reason why it does not.
fn check_record<E: Experiment>(record: &Record<E>, plan: &Plan<E>) -> Result<(), String> {
    let Contents { origin, leg, at, outcome, end, measured, state, .. } = &record.contents;
    let protocol = plan.protocol();
    let most = protocol.cycles().saturating_mul(origin.value as u64 + 1);
    check(end.count <= most, "it is longer than the protocol")?;
    let samples = measured.samples.len() as u64;
    let is_short = *outcome != Outcome::Completed && samples < protocol.samples();
    check(samples == protocol.samples() || is_short, "its samples are not as many as in the protocol")?;
    let is_placed = match plan.step(origin.value) {
        Some((way, value)) => *leg == Some(way) && *at == Some(value),
        None => plan.is_refined() || at.is_none(),
    };
    check(is_placed, "its place in the ramp is not the plan's")?;
    let is_kept = state.is_some() == plan.keeps_state(origin.value);
    check(is_kept, "it keeps a state that it should not, or lacks one")?;
    if let Some(state) = state {
        let time = end.time(0.0, record.experiment.cycle());
        check_state(state, time..=time)?;
        check([state.rule(), state.boundary()] == record.contents.parts, "its state is of other parts")?;
    }
    measured.check(&record.experiment, state.as_ref())
}
