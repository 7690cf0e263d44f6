//! Observables with names for their numbers.

use super::{Observable, Snapshot};

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
