//! Tables of measurements as text, and observables with names for their numbers.

use std::io::{self, Write};

use super::{Observable, Series, Snapshot};
use crate::statistics::{Estimate, Histogram};

/// The name and the unit of a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heading {
    name: String,
    unit: String,
}

impl Heading {
    /// Creates the heading of a column.
    ///
    /// The unit is in words, such as `length/time`, or `1` for a pure number.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }

    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the unit.
    pub fn unit(&self) -> &str {
        &self.unit
    }
}

impl<N: Into<String>, U: Into<String>> From<(N, U)> for Heading {
    /// Creates a heading from its name and unit.
    fn from((name, unit): (N, U)) -> Self {
        Self::new(name, unit)
    }
}

/// An observable whose values are rows of numbers, each number with a name and a unit.
///
/// [`OrderParameters`](super::OrderParameters), [`CenterOfMass`](super::CenterOfMass),
/// [`Energies`](super::Energies), [`Temperatures`](super::Temperatures),
/// [`TemperaturesAboutFlow`](super::TemperaturesAboutFlow) and [`HexaticOrder`](super::HexaticOrder) are
/// tabular, and so are tuples of them, and an [`OfKind`](super::OfKind) around them.
/// [`named`](super::MeasuredBy::named) makes a closure tabular.
///
/// # Contract
/// `add_numbers` adds one number for each heading, in the same order. Names consist of ASCII letters, digits
/// and underscores.
///
/// ```
/// use granular_edmd::observable::{Heading, Observable, Snapshot, Tabular};
///
/// /// The momentum of all disks.
/// struct Momentum;
///
/// impl Observable for Momentum {
///     type Value = [f64; 2];
///     fn measure(&self, snapshot: &Snapshot<'_>) -> [f64; 2] {
///         snapshot.disks().iter().fold([0.0; 2], |[x, y], disk| {
///             let momentum = disk.mass() * disk.velocity();
///             [x + momentum.x, y + momentum.y]
///         })
///     }
/// }
///
/// impl Tabular for Momentum {
///     fn headings(&self) -> Vec<Heading> {
///         ["momentum_x", "momentum_y"].map(|name| Heading::new(name, "mass length/time")).into()
///     }
///     fn add_numbers(&self, value: &[f64; 2], row: &mut Vec<f64>) {
///         row.extend(value);
///     }
/// }
///
/// let mut row = Vec::new();
/// Momentum.add_numbers(&[1.0, 2.0], &mut row);
/// assert_eq!(row.len(), Momentum.headings().len());
/// ```
#[diagnostic::on_unimplemented(
    message = "the values of `{Self}` have no names for a table",
    label = "a `Tabular` observable is expected here",
    note = "a closure gets a name by `measured_by(…).named(\"name\", \"unit\")`",
    note = "a custom observable implements `observable::Tabular`"
)]
pub trait Tabular: Observable {
    /// Returns the names and units of the columns.
    fn headings(&self) -> Vec<Heading>;

    /// Appends the numbers of a value to a row.
    fn add_numbers(&self, value: &Self::Value, row: &mut Vec<f64>);
}

/// Implements `Tabular` for an observable: each column by its name, its unit and its number.
macro_rules! tabular {
    ($observable:ty, $value:ident => { $($name:literal [$unit:expr]: $number:expr),+ $(,)? }) => {
        impl Tabular for $observable {
            fn headings(&self) -> Vec<Heading> {
                vec![$(Heading::new($name, $unit)),+]
            }

            fn add_numbers(&self, $value: &Self::Value, row: &mut Vec<f64>) {
                row.extend([$($number),+]);
            }
        }
    };
}

pub(super) use tabular;

/// An observable of one number, with its name and unit; made by
/// [`MeasuredBy::named`](super::MeasuredBy::named).
#[derive(Debug, Clone)]
pub struct Named<Q> {
    observable: Q,
    heading: Heading,
}

impl<Q> Named<Q> {
    pub(super) fn new(observable: Q, name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { observable, heading: Heading::new(name, unit) }
    }
}

impl<Q: Observable> Observable for Named<Q> {
    type Value = Q::Value;

    fn measure(&self, snapshot: &Snapshot<'_>) -> Q::Value {
        self.observable.measure(snapshot)
    }
}

impl<Q: Observable> Tabular for Named<Q>
where
    Q::Value: Copy + Into<f64>,
{
    fn headings(&self) -> Vec<Heading> {
        vec![self.heading.clone()]
    }

    fn add_numbers(&self, value: &Q::Value, row: &mut Vec<f64>) {
        row.push((*value).into());
    }
}

/// The unit of a stress in two dimensions.
pub(super) const STRESS: &str = "mass/time^2";

/// The unit of an energy or a temperature.
pub(super) const ENERGY: &str = "energy";

/// A measurement whose results are rows of numbers, each number with a name and a unit.
///
/// All measurements of this module are tables: a [`Series`] has a row for each time, a
/// [`PairCorrelation`](super::PairCorrelation) for each distance, [`Fields`](super::Fields) for each cell. A
/// number with an error has three columns: its mean `x`, its standard error `x_error`, and `x_samples`, the
/// number of independent samples behind it. In a column `wall`, collisions of two disks have the value `NaN`.
/// A [`Sampled`](super::Sampled) accumulator is written like the accumulator itself.
///
/// # Contract
/// Each row has one number for each heading, in the same order.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::{Accumulator, HeightProfile, Snapshot, Table};
/// use granular_edmd::{Disk, glam::DVec2};
///
/// let mut profile = HeightProfile::new(0.0, 4.0, 2)?;
/// let disk = Disk::new(DVec2::new(1.0, 3.0), 0.5)?;
/// profile.add(&Snapshot::new(0.0, &[disk], Domain::new(0.0, 2.0, 0.0, 4.0), 1.0));
/// let mut table = Vec::new();
/// profile.write_csv(&mut table)?;
/// assert!(table.starts_with(b"height [length],packing_fraction\n1.0,0.0\n3.0,0.196"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a table",
    note = "a `Series` is one if its observable is `Tabular`"
)]
pub trait Table {
    /// Returns the names and units of the columns.
    fn headings(&self) -> Vec<Heading>;

    /// Iterates over the rows.
    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_>;

    /// Writes the table as comma-separated values: a line of headings, such as `center_y [length]`, and a
    /// line for each row.
    ///
    /// The heading of a pure number has no unit. Reading the numbers back gives the same bits. An undefined
    /// number is `NaN`.
    ///
    /// ```
    /// use granular_edmd::boundary::Domain;
    /// use granular_edmd::observable::{
    ///     CenterOfMass, Observer, OrderParameters, SampleTimes, Series, Snapshot, Table,
    /// };
    ///
    /// let mut series = Series::new((OrderParameters, CenterOfMass), SampleTimes::every(0.5)?);
    /// series.on_sample(&Snapshot::new(0.5, &[], Domain::new(0.0, 4.0, 0.0, 6.0), 1.0));
    /// let mut table = Vec::new();
    /// series.write_csv(&mut table)?;
    /// let heading = "time [time],one_roll [length/time],two_rolls [length/time],\
    ///                center_x [length],center_y [length]";
    /// assert_eq!(String::from_utf8(table)?, format!("{heading}\n0.5,0.0,0.0,NaN,NaN\n"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the writer fails, two columns have the same name, a name or a unit has characters that a table
    /// cannot hold, or a row breaks the contract.
    fn write_csv(&self, mut out: impl Write) -> io::Result<()>
    where
        Self: Sized,
    {
        let headings = self.headings();
        check(&headings)?;
        writeln!(out, "{}", headings.iter().map(label).collect::<Vec<_>>().join(","))?;
        for row in self.rows() {
            if row.len() != headings.len() {
                let message = format!("a row has {} numbers for {} headings", row.len(), headings.len());
                return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
            }
            let cells: Vec<String> = row.iter().map(|number| format!("{number:?}")).collect();
            writeln!(out, "{}", cells.join(","))?;
        }
        out.flush()
    }
}

/// Implements `Table`: the columns of each row by their names, units and numbers, and after a semicolon by
/// names, units and estimates.
macro_rules! table {
    (
        $(#[$attribute:meta])*
        $table:ident $(<$part:ident: $bound:ident>)?, $this:ident: for $item:pat in $rows:expr;
        $($name:literal [$unit:expr]: $number:expr),+ $(; $($mean:literal [$of_mean:expr]: $estimate:expr),+)?
    ) => {
        $(#[$attribute])*
        impl $(<$part: $bound>)? crate::observable::Table for $table $(<$part>)? {
            fn headings(&self) -> Vec<crate::observable::Heading> {
                crate::observable::table::headings(&[$(($name, $unit)),+], &[$($(($mean, $of_mean)),+)?])
            }

            fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
                let ($this, row) = (self, crate::observable::table::row);
                Box::new($rows.map(move |$item| row(&[$($number),+], &[$($($estimate),+)?])))
            }
        }
    };
}

pub(super) use table;

impl<Q: Tabular> Table for Series<Q> {
    fn headings(&self) -> Vec<Heading> {
        [vec![Heading::new("time", "time")], self.observable().headings()].concat()
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        Box::new(self.iter().map(|(time, value)| {
            let mut row = vec![time];
            self.observable().add_numbers(value, &mut row);
            row
        }))
    }
}

impl Table for Histogram {
    fn headings(&self) -> Vec<Heading> {
        histogram_headings([("value", "1")])
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        histogram_rows([self])
    }
}

/// Returns the headings of numbers without errors, and after them the headings of numbers with errors.
pub(super) fn headings(exact: &[(&str, &str)], estimated: &[(&str, &str)]) -> Vec<Heading> {
    let exact = exact.iter().map(|&heading| heading.into());
    let estimated = estimated.iter().flat_map(|&(name, unit)| {
        [(name.to_owned(), unit), (format!("{name}_error"), unit), (format!("{name}_samples"), "1")]
    });
    exact.chain(estimated.map(Heading::from)).collect()
}

/// Returns a row under [`headings`].
pub(super) fn row(exact: &[f64], estimated: &[Estimate]) -> Vec<f64> {
    let numbers =
        |estimate: &Estimate| [estimate.mean(), estimate.standard_error(), estimate.independent_samples()];
    exact.iter().copied().chain(estimated.iter().flat_map(numbers)).collect()
}

/// Returns the headings of histograms side by side, from the names and units of the counted quantities.
pub(super) fn histogram_headings<const COUNT: usize>(names: [(&str, &str); COUNT]) -> Vec<Heading> {
    let columns = |(name, unit): (&str, &str)| {
        let inverse = if unit == "1" { unit.to_owned() } else { format!("1/({unit})") };
        let exact = [("low", unit), ("high", unit), ("count", "1")];
        let exact = exact.map(|(column, unit)| (format!("{name}_{column}"), unit));
        let exact = exact.each_ref().map(|(column, unit)| (column.as_str(), *unit));
        headings(&exact, &[(&format!("{name}_density"), &inverse)])
    };
    names.into_iter().flat_map(columns).collect()
}

/// Returns the rows of histograms side by side, all with the same number of bins.
pub(super) fn histogram_rows<const COUNT: usize>(
    histograms: [&Histogram; COUNT],
) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
    let mut bins = histograms.map(Histogram::bins);
    Box::new(std::iter::from_fn(move || {
        let mut all = Vec::with_capacity(6 * COUNT);
        for bins in &mut bins {
            let bin = bins.next()?;
            all.extend(row(&[bin.low, bin.high, bin.count as f64], &[bin.density]));
        }
        Some(all)
    }))
}

fn label(heading: &Heading) -> String {
    let (name, unit) = (heading.name(), heading.unit());
    if unit == "1" { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// Checks that all names differ, and that names and units need no quotes.
fn check(headings: &[Heading]) -> io::Result<()> {
    let refuse = |message: String| Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    for (index, heading) in headings.iter().enumerate() {
        let (name, unit) = (heading.name(), heading.unit());
        if name.is_empty() || !name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
            return refuse(format!(
                "the name of a column must be of letters, digits and underscores, but is {name:?}"
            ));
        }
        if unit.contains(['"', ',', '\\', '[', ']']) || unit.chars().any(char::is_control) {
            return refuse(format!("the unit of a column must be in plain words, but is {unit:?}"));
        }
        if headings[..index].iter().any(|other| other.name() == name) {
            return refuse(format!("two columns are named {name:?}"));
        }
    }
    Ok(())
}
