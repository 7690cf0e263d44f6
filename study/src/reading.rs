//! The results of a study: records, points, transitions and progress, and tables of the records.

use std::path::Path;

use super::experiment::record::{Contents, Outcome, Record, check, check_state};
use super::plan::refinement::{Bracket, Seen};
use super::plan::values::MOST_TRIED;
use super::store::{Claimed, Entry, Marks};
use super::tables::{self, Tables};
use super::whole::{self, damaged};
use super::{Experiment, Plan, Point, Study, StudyError};

/// Progress of a ramp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RampStatus {
    /// All values of the ramp have a record.
    Done,
    /// A process is running the ramp.
    Running,
    /// A part of the ramp is finished, and no process is known to be running the ramp.
    Begun,
    /// No value of the ramp is finished.
    Waiting,
}

impl<E: Experiment> Study<E> {
    /// Returns the record of a value, or `None` if the value is not finished.
    ///
    /// # Errors
    /// If there is no such ramp, or the record is damaged, of another study, of other code, or cannot be
    /// read.
    pub fn record(&self, ramp: usize, value: usize) -> Result<Option<Record<E>>, StudyError> {
        self.check_ramp(ramp)?;
        if let Some(record) = self.known_record(ramp, value)? {
            return Ok(Some(record));
        }
        let entry = self.store.refreshed()?.find(ramp, value);
        match (entry, self.store.damage()) {
            (Some(entry), _) => self.read(&entry).map(Some),
            (None, Some(error)) => Err(error),
            (None, None) => Ok(None),
        }
    }

    /// Returns the record of a value, if it was finished when the store was last read.
    pub(super) fn known_record(&self, ramp: usize, value: usize) -> Result<Option<Record<E>>, StudyError> {
        self.store.known().find(ramp, value).map(|entry| self.read(&entry)).transpose()
    }

    /// Reads a record of the store.
    pub(super) fn read(&self, entry: &Entry) -> Result<Record<E>, StudyError> {
        let record = self.read_unproven(entry)?;
        // Accepted code differs from this program on purpose.
        let is_ours = self.is_ours(&record.contents.origin);
        let last = self.plan.protocol().last_of(record.contents.steps);
        match record.changed_part(&last).filter(|_| is_ours) {
            Some(part) => Err(StudyError::changed(&self.store.log_of(entry), part)),
            None => Ok(record),
        }
    }

    /// Reads a record of the store without making the rule and the walls to compare their fingerprints.
    fn read_unproven(&self, entry: &Entry) -> Result<Record<E>, StudyError> {
        let (head, path) = (entry.head(), self.store.log_of(entry));
        let contents: Contents<_, _> = self.store.read(entry)?;
        self.check_origin(&contents.origin, head.ramp, head.value, &path)?;
        let told = |reason| damaged(&path, format!("value {} of ramp {}: {reason}", head.value, head.ramp));
        let spans = |at| self.plan.ramp().is_some_and(|ramp| ramp.spans(at));
        if contents.at.is_some_and(|at| !spans(at)) {
            return Err(told("it is outside the ramp".to_owned()));
        }
        let record = Record { experiment: self.plan.experiment_at(head.ramp, contents.at)?, contents };
        check_record(&record, &self.plan).map_err(told)?;
        Ok(record)
    }

    /// Iterates over all finished records, ramp by ramp, and reads them one by one.
    pub fn records(&self) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        self.records_of(0..self.plan.ramp_count())
    }

    /// Iterates over all finished records of a ramp, and reads them one by one.
    ///
    /// If there is no such ramp, the only item is an error.
    pub fn ramp_records(&self, ramp: usize) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        let missing = self.check_ramp(ramp).err();
        let ramps = if missing.is_some() { 0..0 } else { ramp..ramp + 1 };
        missing.into_iter().map(Err).chain(self.records_of(ramps))
    }

    fn records_of(
        &self,
        ramps: std::ops::Range<usize>,
    ) -> impl Iterator<Item = Result<Record<E>, StudyError>> {
        let (entries, error) = match self.store.refreshed() {
            Ok(entries) => (entries.of(ramps).copied().collect::<Vec<Entry>>(), None),
            Err(error) => (Vec::new(), Some(error)),
        };
        error.into_iter().map(Err).chain(entries.into_iter().map(|entry| self.read(&entry)))
    }

    /// Returns a value at a point of the grid, with all its finished repeats, or `None` if no repeat is
    /// finished.
    ///
    /// # Errors
    /// If there is no such point, or a record is damaged, of another study, or cannot be read.
    pub fn point(&self, index: usize, value: usize) -> Result<Option<Point<E>>, StudyError> {
        self.store.refreshed()?;
        self.known_point(index, value)
    }

    fn known_point(&self, index: usize, value: usize) -> Result<Option<Point<E>>, StudyError> {
        let count = self.plan.point_count();
        if index >= count {
            return Err(StudyError::Absent { what: "point", index, count });
        }
        let repeats = self.plan.repeats();
        let ramps = index * repeats..(index + 1) * repeats;
        let records = ramps.filter_map(|ramp| self.known_record(ramp, value).transpose());
        let records = records.collect::<Result<Vec<_>, _>>()?;
        Ok((!records.is_empty()).then_some(Point { index, value, records }))
    }

    /// Reads, one by one, all values that have a finished repeat, at all points of the grid.
    ///
    /// Values that a refinement adds are left out, since they differ between repeats.
    pub fn points(&self) -> impl Iterator<Item = Result<Point<E>, StudyError>> {
        let error = self.store.refreshed().err();
        let values = move |index| (0..self.plan.value_count()).map(move |value| (index, value));
        let places = (0..self.plan.point_count()).flat_map(values);
        let found = places.filter_map(|(index, value)| self.known_point(index, value).transpose());
        error.into_iter().map(Err).chain(found)
    }

    /// Returns the transitions that a refined ramp has bracketed; empty until all are bracketed.
    ///
    /// # Errors
    /// If there is no such ramp, or a record is damaged, of another study, or cannot be read.
    pub fn transitions(&self, ramp: usize) -> Result<Vec<Bracket>, StudyError> {
        let seen: Vec<Seen> = self
            .ramp_records(ramp)
            .map(|record| Ok(self.plan.seen(&record?)))
            .collect::<Result<_, StudyError>>()?;
        Ok(self.plan.brackets(&seen))
    }

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
        let (taken, unfinished) = (self.claims.taken()?, self.folder.unfinished()?);
        let entries = self.store.refreshed()?;
        let begun =
            entries.all().map(|entry| entry.head().ramp).chain(unfinished.iter().map(|place| place[0]));
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

    /// Returns whether all values have a record.
    pub(super) fn is_done(&self) -> Result<bool, StudyError> {
        let entries = self.store.refreshed()?;
        Ok((0..self.plan.ramp_count()).all(|ramp| entries.is_done(ramp)))
    }

    /// Returns the ramp and value indices of all values that stalled, failed or reached a limit.
    ///
    /// # Errors
    /// If files cannot be read.
    pub fn failed(&self) -> Result<Vec<[usize; 2]>, StudyError> {
        let entries = self.store.refreshed()?;
        let failed = entries.all().map(Entry::head).filter(|head| head.marks.has(Marks::FAILED));
        Ok(failed.map(|head| [head.ramp, head.value]).collect())
    }

    /// Marks the failed values of a finished ramp as unfinished, with all values after the first failed
    /// value, since a new result changes the states from which these start. The next run computes these
    /// values again. Returns whether there were failed values.
    ///
    /// The same code fails again, with the same bytes: call this for code whose changes were
    /// [accepted](Self::accept_changes), or with a longer limit of seconds. A ramp that another process is
    /// running is left alone.
    ///
    /// # Errors
    /// If there is no such ramp, the plan or the code of the study has changed, or files cannot be read or
    /// written.
    pub fn forget_failed(&self, ramp: usize) -> Result<bool, StudyError> {
        self.check_ramp(ramp)?;
        self.check_unchanged()?;
        let claimed = self.claims.claim(&(ramp..ramp + 1))?;
        let entries = self.store.refreshed()?;
        if matches!(claimed, Claimed::Theirs) || !entries.is_done(ramp) {
            return Ok(false);
        }
        let heads = || entries.of(ramp..ramp + 1).map(Entry::head);
        let Some(first) = heads().find(|head| head.marks.has(Marks::FAILED)) else { return Ok(false) };
        self.folder.mark_incomplete()?;
        let values = heads().map(|head| head.value).filter(|value| *value >= first.value);
        self.store.void(ramp, values)?;
        Ok(true)
    }

    /// Returns the processor seconds that the finished values took, and an estimate for the other values, if
    /// these are alike. The estimate is NaN before a value is finished.
    ///
    /// Both are estimates: for a value that was interrupted, only the last piece counts.
    ///
    /// # Errors
    /// If files cannot be read.
    pub fn seconds(&self) -> Result<(f64, f64), StudyError> {
        let entries = self.store.refreshed()?;
        let timed =
            || entries.all().map(|entry| f64::from(entry.head().seconds)).filter(|time| !time.is_nan());
        let seconds: f64 = timed().sum();
        let all = (self.plan.ramp_count() * self.plan.value_count()) as f64;
        let left = f64::max(all - entries.all().count() as f64, 0.0);
        Ok((seconds, left * seconds / timed().count() as f64))
    }

    /// Returns whether the folder has tables of all values.
    pub fn has_tables(&self) -> bool {
        self.folder.is_complete() && tables::files(&self.plan, self.folder()).all(|file| file.exists())
    }

    /// Writes the tables of all finished records into the folder of the study, and returns the number of
    /// these records.
    ///
    /// A run does this when all ramps are done. Call it earlier to see the results so far. Tables are written
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
        whole::create(folder)?;
        if let Some(path) = tables::files(&self.plan, folder).find(|path| path.exists()) {
            return Err(StudyError::refused(&path, "exists already; choose another folder for tables"));
        }
        self.tables(folder)
    }

    /// Writes tables, and returns the number of records in them.
    pub(super) fn tables(&self, folder: &Path) -> Result<usize, StudyError> {
        let entries = self.store.refreshed()?;
        let mut tables = Tables::new(&self.plan, folder)?;
        let mut finished = 0;
        // Making walls takes longer than reading a small record, so only a selection of records is compared.
        let stride = 1 + entries.all().count() / MOST_TRIED;
        for ramp in 0..self.plan.ramp_count() {
            let mut seen = Vec::new();
            for entry in entries.of(ramp..ramp + 1) {
                let is_tried = finished % stride == 0;
                let record = if is_tried { self.read(entry)? } else { self.read_unproven(entry)? };
                tables.add(&record)?;
                seen.push(self.plan.seen(&record));
                finished += 1;
            }
            // A table that lacks a row must not look complete.
            if !entries.is_done(ramp) && (self.folder.is_complete() || self.store.damage().is_some()) {
                let missing = || damaged(self.folder(), format!("a record of ramp {ramp} is missing"));
                return Err(self.store.damage().unwrap_or_else(missing));
            }
            tables.end_ramp(ramp, &self.plan.brackets(&seen))?;
        }
        tables.finish()?;
        Ok(finished)
    }
}

/// Checks that a record belongs to its ramp and value in a study, or returns the reason why it does not.
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
