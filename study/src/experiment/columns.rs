//! Columns of tables, each defined once by its name, unit and value; and the meanings of column names.

use std::fmt;
use std::sync::LazyLock;

use granular_edmd::observable::Heading;
use granular_edmd::statistics::Estimate;

use crate::parameters::Scalar;
use crate::{Experiment, Record};

type OfSample<E> = Box<dyn Fn(&<E as Experiment>::Sample) -> Scalar + Send + Sync>;
type OfRecord<E, T> = Box<dyn Fn(&Record<E>) -> T + Send + Sync>;

/// A column of the tables of a study: its name, its unit, and its value as a function of a sample or of a
/// record.
///
/// ```
/// use granular_edmd_study::{Column, vibrated_box::{Sample, VibratedBox}};
/// // A row for each sample, and a mean with its error for each value.
/// let height: Column<VibratedBox> = Column::sampled("height", "diameter", |sample: &Sample| sample.height);
/// // A number for each value.
/// let overlap: Column<VibratedBox> =
///     Column::of_record("max_overlap", "diameter", |record| record.counters().max_overlap);
/// assert_eq!((height.name(), overlap.unit()), ("height", "diameter"));
/// ```
pub struct Column<E: Experiment> {
    pub(crate) heading: Heading,
    pub(crate) kind: Kind<E>,
    pub(crate) in_samples: bool,
    pub(crate) in_values: bool,
}

pub(crate) enum Kind<E: Experiment> {
    Sample(OfSample<E>),
    Record(OfRecord<E, Scalar>),
    Estimate(OfRecord<E, Estimate>),
}

impl<E: Experiment> Column<E> {
    /// Creates a column from a quantity of each sample.
    ///
    /// The table of samples shows the quantity itself. The table of values shows its mean, with the error and
    /// the number of independent samples. For only one of these tables, use [`Self::of_sample`] or
    /// [`Self::averaged`].
    pub fn sampled<T: Into<Scalar>>(
        name: impl Into<String>,
        unit: impl Into<String>,
        value: impl Fn(&E::Sample) -> T + Send + Sync + 'static,
    ) -> Self {
        let kind = Kind::Sample(Box::new(move |sample| value(sample).into()));
        Self { heading: Heading::new(name, unit), kind, in_samples: true, in_values: true }
    }

    /// Creates a column of the table of samples from a quantity of each sample.
    pub fn of_sample<T: Into<Scalar>>(
        name: impl Into<String>,
        unit: impl Into<String>,
        value: impl Fn(&E::Sample) -> T + Send + Sync + 'static,
    ) -> Self {
        Self { in_values: false, ..Self::sampled(name, unit, value) }
    }

    /// Creates a column of the table of values from the mean of a quantity of each sample, with its error.
    pub fn averaged<T: Into<Scalar>>(
        name: impl Into<String>,
        unit: impl Into<String>,
        value: impl Fn(&E::Sample) -> T + Send + Sync + 'static,
    ) -> Self {
        Self { in_samples: false, ..Self::sampled(name, unit, value) }
    }

    /// Creates a column of the table of values from a quantity of each record.
    pub fn of_record<T: Into<Scalar>>(
        name: impl Into<String>,
        unit: impl Into<String>,
        value: impl Fn(&Record<E>) -> T + Send + Sync + 'static,
    ) -> Self {
        let kind = Kind::Record(Box::new(move |record| value(record).into()));
        Self { heading: Heading::new(name, unit), kind, in_samples: false, in_values: true }
    }

    /// Creates a column of the table of values from a quantity with an error, computed from each record.
    pub fn estimated(
        name: impl Into<String>,
        unit: impl Into<String>,
        value: impl Fn(&Record<E>) -> Estimate + Send + Sync + 'static,
    ) -> Self {
        let (heading, kind) = (Heading::new(name, unit), Kind::Estimate(Box::new(value)));
        Self { heading, kind, in_samples: false, in_values: true }
    }

    /// Returns the name of the column.
    pub fn name(&self) -> &str {
        self.heading.name()
    }

    /// Returns the unit of the column.
    pub fn unit(&self) -> &str {
        self.heading.unit()
    }

    /// Returns the headings in the table of values. The heading of a mean is followed by the headings of its
    /// error and its number of independent samples.
    pub(crate) fn headings(&self) -> Vec<Heading> {
        let mut all = vec![self.heading.clone()];
        if self.has_error() {
            let [error, independent] = error_names(self.name());
            all.extend([Heading::new(error, self.unit()), Heading::new(independent, "")]);
        }
        all
    }

    /// Returns whether the values of the column have an error.
    pub(crate) const fn has_error(&self) -> bool {
        !matches!(self.kind, Kind::Record(_))
    }

    /// Returns the value for a sample, or `None` if the column is not computed from samples.
    pub(crate) fn of(&self, sample: &E::Sample) -> Option<Scalar> {
        match &self.kind {
            Kind::Sample(value) => Some(value(sample)),
            _ => None,
        }
    }

    /// Returns the estimate for a record, or `None` if the column has no error.
    pub(crate) fn estimate(&self, record: &Record<E>) -> Option<Estimate> {
        match &self.kind {
            Kind::Sample(value) => Some(record.mean(|sample| value(sample).number().unwrap_or(f64::NAN))),
            Kind::Estimate(value) => Some(value(record)),
            Kind::Record(_) => None,
        }
    }
}

impl<E: Experiment> fmt::Debug for Column<E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Column");
        debug.field("name", &self.name()).field("unit", &self.unit()).finish_non_exhaustive()
    }
}

/// A table besides the tables of values and samples, with any number of rows for each record.
///
/// ```
/// use granular_edmd_study::{Table, vibrated_box::VibratedBox};
/// let profiles: Table<VibratedBox> =
///     Table::new("profiles", [("height", "diameter"), ("packing_fraction", "1")], |record| {
///         record.profile().map(|(height, fraction)| vec![height, fraction]).collect()
///     });
/// assert_eq!(profiles.name(), "profiles");
/// ```
pub struct Table<E: Experiment> {
    name: String,
    columns: Vec<Heading>,
    pub(crate) rows: OfRecord<E, Vec<Vec<f64>>>,
}

impl<E: Experiment> Table<E> {
    /// Creates a table from its name, the names and units of its columns, and a function that returns the
    /// rows of each record.
    ///
    /// A row should have a number for each column: missing numbers become NaN, an empty cell of the file, and
    /// surplus numbers are ignored.
    pub fn new(
        name: impl Into<String>,
        columns: impl IntoIterator<Item: Into<Heading>>,
        rows: impl Fn(&Record<E>) -> Vec<Vec<f64>> + Send + Sync + 'static,
    ) -> Self {
        let columns = columns.into_iter().map(Into::into).collect();
        Self { name: name.into(), columns, rows: Box::new(rows) }
    }

    /// Returns the name of the table, which is the name of its file without the ending.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the headings of the columns.
    pub fn columns(&self) -> &[Heading] {
        &self.columns
    }
}

impl<E: Experiment> fmt::Debug for Table<E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Table");
        debug.field("name", &self.name).field("columns", &self.columns).finish_non_exhaustive()
    }
}

/// The columns that the tables of every study have.
pub(crate) static OF_TABLES: Meanings = LazyLock::new(|| meanings(include_str!("columns.txt")));

/// Names with their meanings.
pub(crate) type Meanings = LazyLock<Vec<(&'static str, &'static str)>>;

/// Reads a text that has a name and its meaning on each line.
pub(crate) fn meanings(text: &'static str) -> Vec<(&'static str, &'static str)> {
    text.lines().filter_map(|line| line.split_once(": ")).collect()
}

/// Returns the meaning of a column that follows a mean: its error or its number of independent samples.
pub(crate) fn of_error<E: Experiment>(columns: &[Column<E>], column: &str) -> Option<String> {
    columns.iter().filter(|mean| mean.has_error()).map(Column::name).find_map(|mean| {
        let numbers = ["Standard error of the mean", "Number of independent samples behind the mean"];
        let of = error_names(mean).into_iter().zip(numbers).find(|(name, _)| name == column);
        of.map(|(_, number)| format!("{number} of {mean}."))
    })
}

/// Returns the meaning of a name.
pub(crate) fn find(meanings: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    meanings.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
}

/// Returns the names of the two columns that follow a column of means: the error, and the number of
/// independent samples.
pub(crate) fn error_names(name: &str) -> [String; 2] {
    ["error", "independent_samples"].map(|ending| format!("{name}_{ending}"))
}
