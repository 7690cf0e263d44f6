//! The results of a study: records, points and transitions, and tables of all of them.

use super::errors::StudyError;
use super::record::{Contents, Record};
use super::refinement::{Bracket, Seen};
use super::tables::Tables;
use super::{Experiment, Point, Study, file};

impl<E: Experiment> Study<E> {
    /// Returns the record of a value; `None` if it is not finished.
    ///
    /// # Errors
    /// If there is no such ramp, or the file is damaged, of another study, or cannot be read.
    pub fn record(&self, ramp: usize, value: usize) -> Result<Option<Record<E>>, StudyError> {
        self.check_ramp(ramp)?;
        let path = self.folder.record(ramp, value);
        let Some(contents) = file::read_sealed::<Contents<_, _>>(&path)? else { return Ok(None) };
        self.check_origin(&contents.origin, ramp, value, &path)?;
        let spans = |at| self.plan.ramp().is_some_and(|ramp| ramp.spans(at));
        if contents.at.is_some_and(|at| !spans(at)) {
            return Err(file::damaged(&path, "it is outside the ramp"));
        }
        let record = Record { experiment: self.plan.experiment_at(ramp, contents.at)?, contents };
        record.check(&self.plan).map_err(|reason| file::damaged(&path, reason))?;
        match record.changed_part() {
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
        let seen: Vec<Seen> =
            self.ramp_records(ramp).map(|record| Ok(record?.seen())).collect::<Result<_, StudyError>>()?;
        Ok(self.brackets(&seen))
    }

    fn brackets(&self, seen: &[Seen]) -> Vec<Bracket> {
        self.plan.ramp().map_or_else(Vec::new, |ramp| ramp.brackets(seen))
    }

    /// Writes the tables of all finished records, and returns the number of these records.
    ///
    /// A run does this when all ramps are done. Call it earlier to look at what is there.
    ///
    /// # Errors
    /// If a record is damaged, or a file cannot be read or written.
    pub fn write_tables(&self) -> Result<usize, StudyError> {
        let mut tables = Tables::new(&self.plan);
        let mut finished = 0;
        for ramp in 0..self.plan.ramp_count() {
            let mut seen = Vec::new();
            for record in self.ramp_records(ramp) {
                let record = record?;
                tables.add(&record);
                seen.push(record.seen());
                finished += 1;
            }
            tables.end_ramp(ramp, &self.brackets(&seen));
        }
        let tables = tables.finish();
        self.folder.write_tables(tables.iter().map(|(name, text)| (name.as_str(), text.as_str())))?;
        Ok(finished)
    }
}
