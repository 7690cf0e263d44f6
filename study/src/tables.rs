//! Tables of records, written row by row. The header and the rows come from the same columns.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use granular_edmd::file::Draft;
use granular_edmd::observable::Heading;
use granular_edmd::statistics::Estimate;

use super::experiment::record::Leg;
use super::experiment::{Column, Kind, OF_TABLES, Table, find, of_error};
use super::folder::create;
use super::parameters::Scalar;
use super::plan::ramp::Bracket;
use super::plan::values::MOST_TRIED;
use super::{Experiment, Plan, Record, Study, StudyError};

impl<E: Experiment> Study<E> {
    /// Returns whether the folder has tables of all values.
    pub fn has_tables(&self) -> bool {
        self.folder.complete().exists() && files(&self.plan, self.folder()).all(|file| file.exists())
    }

    /// Writes the tables of all finished records into the folder of the study, and returns the number of
    /// records.
    ///
    /// A run does this when all ramps are done. Call it earlier to see the results so far. Tables are written
    /// row by row, so they may be larger than memory.
    ///
    /// # Errors
    /// If a record is damaged or missing, or a file cannot be read or written.
    pub fn write_tables(&self) -> Result<usize, StudyError> {
        let _lock = self.folder.lock()?;
        self.write_locked()
    }

    /// Writes the tables into the folder of the study, whose lock the caller holds, and notes if they have
    /// all values.
    pub(super) fn write_locked(&self) -> Result<usize, StudyError> {
        self.folder.put(&self.provenance().text())?;
        let (finished, are_all) = self.tables(self.folder())?;
        if are_all {
            self.folder.mark_complete()?;
        }
        Ok(finished)
    }

    /// Writes the tables of all finished records into another folder, and returns the number of records.
    ///
    /// # Errors
    /// The same as for [`Self::write_tables`], and if the folder already has a file with the name of a table.
    pub fn write_tables_to(&self, folder: impl AsRef<Path>) -> Result<usize, StudyError> {
        let folder = folder.as_ref();
        create(folder)?;
        if let Some(path) = files(&self.plan, folder).find(|path| path.exists()) {
            return Err(StudyError::refused(&path, "exists already; choose another folder for tables"));
        }
        self.tables(folder).map(|(finished, _)| finished)
    }

    /// Writes tables. Returns the number of records in them, and whether these are all records of the plan.
    fn tables(&self, folder: &Path) -> Result<(usize, bool), StudyError> {
        self.store.refresh()?;
        let mut tables = Tables::new(&self.plan, folder)?;
        let (mut finished, mut are_all) = (0, true);
        // Only a selection of the records is compared with the present rule and walls, since making walls
        // takes longer than reading a small record.
        let stride = 1 + self.store.heads().count() / MOST_TRIED;
        for ramp in 0..self.plan.ramp_count() {
            let mut seen = Vec::new();
            for entry in self.store.of(ramp..ramp + 1) {
                let is_tried = finished % stride == 0;
                let record = if is_tried { self.read(&entry)? } else { self.read_unproven(&entry)? };
                tables.add(&record)?;
                seen.push(self.plan.seen(&record));
                finished += 1;
            }
            // In a complete or damaged study, a missing record is an error: a table that lacks a row must not
            // look complete.
            let (is_done, damage) = (self.store.is_done(ramp), self.store.damage(self.store.block_of(ramp)));
            are_all &= is_done;
            if !is_done && (self.folder.complete().exists() || damage.is_some()) {
                let missing =
                    || StudyError::damaged(self.folder(), format!("a record of ramp {ramp} is missing"));
                return Err(damage.unwrap_or_else(missing));
            }
            tables.end_ramp(ramp, &self.plan.brackets(&seen))?;
        }
        tables.finish()?;
        Ok((finished, are_all))
    }
}

/// The tables of a study that are being written. They get their final names once all of them are complete.
struct Tables<'a, E: Experiment> {
    plan: &'a Plan<E>,
    columns: Vec<Column<E>>,
    values: Rows,
    samples: Rows,
    points: Rows,
    transitions: Option<Rows>,
    more: Vec<(Table<E>, Rows)>,
    described: Rows,
    /// The repeats so far, for each value of the present point.
    repeats: Vec<Vec<Repeat>>,
}

/// One repeat of a value.
struct Repeat {
    /// The estimates of the columns with errors, in their order.
    estimates: Vec<Estimate>,
    /// True if the value stalled, failed or reached a limit in this repeat.
    is_failed: bool,
}

/// A table that is being written to its file.
struct Rows {
    path: PathBuf,
    draft: Draft,
}

impl Rows {
    fn begin(folder: &Path, name: &str) -> Result<Self, StudyError> {
        let path = file(folder, name);
        let draft = Draft::of(&path).map_err(StudyError::io("write", &path))?;
        Ok(Self { path, draft })
    }

    /// Adds a row: the text of its first cells, and further cells.
    fn push(&mut self, first: &str, cells: impl IntoIterator<Item = Scalar>) -> Result<(), StudyError> {
        let row = row(first, cells) + "\n";
        self.draft.write_all(row.as_bytes()).map_err(StudyError::io("write", &self.path))
    }
}

/// Returns the text of a row: the text of its first cells, then further cells. A NaN gives an empty cell,
/// which every reader of tables takes for a missing value. With the text `NaN`, some readers compute wrong
/// means.
fn row(first: &str, cells: impl IntoIterator<Item = Scalar>) -> String {
    let mut row = String::with_capacity(256);
    row.push_str(first);
    for cell in cells {
        // The first cell of a row is never empty.
        row.push_str(if row.is_empty() { "" } else { "," });
        if !cell.number().is_some_and(f64::is_nan) {
            // Writing to a string does not fail.
            let _ = write!(row, "{cell}");
        }
    }
    row
}

/// Returns the cells of a mean: the mean, its error, and its number of independent samples.
fn cells(estimate: &Estimate) -> [Scalar; 3] {
    [estimate.mean(), estimate.standard_error(), estimate.independent_samples()].map(Scalar::from)
}

/// The subject of a row: one value, all repeats of a value, or, without a value, a transition.
#[derive(Debug, Clone, Copy)]
struct Place {
    ramp: usize,
    value: Option<usize>,
    leg: Option<Leg>,
    /// Value of the ramped parameter.
    at: Option<f64>,
    /// True if the row stands for all repeats together.
    is_point: bool,
}

impl Place {
    /// Returns the names and cells of the leading columns.
    fn leading<E: Experiment>(self, plan: &Plan<E>) -> Vec<(&str, Scalar)> {
        let repeats = plan.repeats();
        let (name, index) = if self.is_point { ("point", self.ramp / repeats) } else { ("ramp", self.ramp) };
        let mut cells = vec![(name, index.into())];
        cells.extend(self.value.map(|value| ("value", value.into())));
        cells.push(("leg", self.leg.map_or_else(String::new, |leg| leg.to_string()).into()));
        cells.extend((!self.is_point && repeats > 1).then(|| ("repeat", (self.ramp % repeats).into())));
        cells.extend(plan.parameters_at(self.ramp, self.at));
        cells
    }

    /// Returns the text of the leading cells of a row.
    fn first<E: Experiment>(self, plan: &Plan<E>) -> String {
        row("", self.leading(plan).into_iter().map(|(_, cell)| cell))
    }
}

impl<'a, E: Experiment> Tables<'a, E> {
    /// Begins tables with a first line and no rows.
    fn new(plan: &'a Plan<E>, folder: &Path) -> Result<Self, StudyError> {
        let columns = E::columns();
        let mut described = Rows::begin(folder, "columns")?;
        described.push("table,column,unit,meaning", [])?;
        let mut begin = |name: &str, place: Place, own: Vec<Heading>| -> Result<Rows, StudyError> {
            let leading = place.leading(plan).into_iter().map(|(name, _)| Heading::new(name, ""));
            let headings: Vec<Heading> = leading.chain(own).collect();
            for heading in &headings {
                let meaning = meaning(plan, &columns, name, heading.name());
                described.push(name, [heading.name().into(), heading.unit().into(), meaning.into()])?;
            }
            let mut rows = Rows::begin(folder, name)?;
            rows.push("", headings.iter().map(|heading| heading.name().into()))?;
            Ok(rows)
        };
        let (leg, at) = plan.step(0).unzip();
        let first = Place { ramp: 0, value: Some(0), leg, at, is_point: false };
        let in_values = columns.iter().filter(|column| column.in_values);
        let own = in_values.clone().flat_map(Column::headings);
        let values = begin("values", first, between(&["seed", "made_by", "outcome", "samples"], own))?;
        let sampled = columns.iter().filter(|column| column.in_samples).map(|column| column.heading.clone());
        let time = std::iter::once(Heading::new("time", "time"));
        let samples = begin("samples", first, time.chain(sampled).collect())?;
        let own = in_values.filter(|column| column.has_error()).flat_map(Column::headings);
        let point = Place { is_point: true, ..first };
        let points = begin("points", point, between(&["repeats", "failed"], own))?;
        let refined = plan.ramp().filter(|_| plan.is_refined());
        let transitions = refined.map(|ramp| {
            let near = ["near", "far"].map(|side| format!("{}_{side}", ramp.parameter()));
            let own = near.into_iter().chain(["from_state", "to_state"].map(str::to_owned));
            let place = Place { value: None, at: None, ..first };
            begin("transitions", place, own.map(|name| Heading::new(name, "")).collect())
        });
        let transitions = transitions.transpose()?;
        let more = E::tables().into_iter().map(|table| {
            let rows = begin(table.name(), first, table.columns().to_vec())?;
            Ok((table, rows))
        });
        let more = more.collect::<Result<_, StudyError>>()?;
        let repeats = Vec::new();
        Ok(Self { plan, columns, values, samples, points, transitions, more, described, repeats })
    }

    /// Adds the rows of a record; records come in their order.
    fn add(&mut self, record: &Record<E>) -> Result<(), StudyError> {
        let (ramp, value) = (record.ramp_index(), Some(record.value_index()));
        let place = Place { ramp, value, leg: record.leg(), at: record.ramped_value(), is_point: false };
        let first = place.first(self.plan);
        self.add_value(record, &first)?;
        for (time, sample) in record.times().iter().zip(record.samples()) {
            let of_sample = self.columns.iter().filter(|column| column.in_samples);
            let cells = of_sample.filter_map(|column| column.of(sample));
            self.samples.push(&first, [Scalar::from(*time)].into_iter().chain(cells))?;
        }
        for (table, rows) in &mut self.more {
            for cells in (table.rows)(record) {
                // Missing numbers are empty cells.
                let cells = cells.into_iter().chain(std::iter::repeat(f64::NAN)).take(table.columns().len());
                rows.push(&first, cells.map(Scalar::from))?;
            }
        }
        Ok(())
    }

    fn add_value(&mut self, record: &Record<E>, first: &str) -> Result<(), StudyError> {
        // A double cannot represent every 64-bit integer. With a letter before the digits, every reader of
        // tables takes the seed for text.
        let seed = format!("x{:016x}", record.seed());
        let (maker, outcome) = (record.contents.origin.maker.cell(), record.outcome().name());
        let mut row = vec![seed.into(), maker.into(), outcome.into(), record.samples().len().into()];
        let mut estimates = Vec::new();
        for column in self.columns.iter().filter(|column| column.in_values) {
            if let Some(estimate) = column.estimate(record) {
                row.extend(cells(&estimate));
                estimates.push(estimate);
            } else if let Kind::Record(value) = &column.kind {
                row.push(value(record));
            }
        }
        row.push(self.not_converged(&estimates));
        self.values.push(first, row)?;
        // A refinement has different values in each repeat.
        let value = record.value_index();
        if value < self.plan.value_count() {
            self.repeats.resize_with(self.repeats.len().max(value + 1), Vec::new);
            self.repeats[value].push(Repeat { estimates, is_failed: record.outcome().reason().is_some() });
        }
        Ok(())
    }

    /// Returns the names, separated by spaces, of the columns whose error is only a lower bound, since they
    /// have too few independent samples.
    fn not_converged(&self, estimates: &[Estimate]) -> Scalar {
        let columns = self.columns.iter().filter(|column| column.in_values && column.has_error());
        let found = columns.zip(estimates).filter(|(_, estimate)| !estimate.is_converged());
        found.map(|(column, _)| column.name()).collect::<Vec<_>>().join(" ").into()
    }

    /// Adds the rows that depend on all records of a ramp.
    fn end_ramp(&mut self, ramp: usize, brackets: &[Bracket]) -> Result<(), StudyError> {
        for Bracket { leg, near, far, from, to } in brackets {
            let Some(rows) = &mut self.transitions else { break };
            let place = Place { ramp, value: None, leg: *leg, at: None, is_point: false };
            let own = [(*near).into(), (*far).into(), from.as_str().into(), to.as_str().into()];
            rows.push(&place.first(self.plan), own)?;
        }
        if (ramp + 1).is_multiple_of(self.plan.repeats()) {
            self.end_point(ramp)?;
        }
        Ok(())
    }

    /// Adds a row for each value of a point, for all finished repeats of the value together.
    fn end_point(&mut self, ramp: usize) -> Result<(), StudyError> {
        let all = std::mem::take(&mut self.repeats).into_iter().enumerate();
        for (value, repeats) in all.filter(|(_, repeats)| !repeats.is_empty()) {
            let (leg, at) = self.plan.step(value).unzip();
            let place = Place { ramp, value: Some(value), leg, at, is_point: true };
            let failed = repeats.iter().filter(|repeat| repeat.is_failed).count();
            let of_column = |column: usize| repeats.iter().map(move |repeat| repeat.estimates[column]);
            let columns = 0..repeats[0].estimates.len();
            let together: Vec<_> = columns.map(|column| Estimate::over_repeats(of_column(column))).collect();
            let counts = [repeats.len().into(), failed.into()].into_iter();
            let row = counts.chain(together.iter().flat_map(cells)).chain([self.not_converged(&together)]);
            self.points.push(&place.first(self.plan), row)?;
        }
        Ok(())
    }

    /// Renames the finished tables to their final names.
    fn finish(self) -> Result<(), StudyError> {
        let own = self.more.into_iter().map(|(_, rows)| rows);
        let all = [self.values, self.samples, self.points, self.described].into_iter();
        let mut all = all.chain(self.transitions).chain(own);
        all.try_for_each(|Rows { path, draft }| draft.finish().map_err(StudyError::io("write", &path)))
    }
}

/// Returns the files of all tables of a plan in a folder.
fn files<E: Experiment>(plan: &Plan<E>, folder: &Path) -> impl Iterator<Item = PathBuf> {
    let refined = plan.is_refined().then_some("transitions");
    let names = ["values", "samples", "points", "columns"].into_iter().chain(refined);
    let own = E::tables().into_iter().map(|table| table.name().to_owned());
    names.map(str::to_owned).chain(own).map(move |name| file(folder, &name))
}

fn file(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.csv"))
}

/// Returns the headings of a table between its leading columns and the last one.
fn between(first: &[&str], own: impl Iterator<Item = Heading>) -> Vec<Heading> {
    let plain = |name: &&str| Heading::new(*name, "");
    first.iter().map(plain).chain(own).chain([Heading::new("not_converged", "")]).collect()
}

/// Returns the meaning of a column of a table, or an empty text if the experiment gives none.
fn meaning<E: Experiment>(plan: &Plan<E>, columns: &[Column<E>], table: &str, column: &str) -> String {
    let whole_name = |name: &str| plan.varied().zip(&plan.varied).find(|(short, _)| *short == name);
    let parameter = |name: &str| whole_name(name).and_then(|(_, whole)| find(E::meanings(), whole));
    let side = |ending| column.strip_suffix(ending).filter(|_| table == "transitions");
    let sides = [("_near", "near side, from which the ramp came"), ("_far", "far side")];
    if let Some((name, side)) = sides.iter().find_map(|(ending, side_of)| Some((side(*ending)?, side_of))) {
        return format!("Value of {name} on the {side}.");
    }
    let own = find(&OF_TABLES, column).or_else(|| parameter(column)).or_else(|| find(E::meanings(), column));
    let own = own.map(|meaning| meaning.trim_end_matches(" Required.").to_owned());
    own.or_else(|| of_error(columns, column)).unwrap_or_default()
}
