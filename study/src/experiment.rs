//! The trait `Experiment`, which defines the system of a study; and the types in its methods: records, and
//! columns of tables.

pub(super) mod record;

use std::fmt;
use std::sync::LazyLock;

use granular_edmd::boundary::Boundary;
use granular_edmd::collision::CollisionRule;
use granular_edmd::observable::{Heading, Observer, Snapshot};
use granular_edmd::quantity::positive;
use granular_edmd::statistics::Estimate;
use granular_edmd::{Disk, Fingerprint, Gravity, Simulation};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::ExperimentError;
use super::sliced::{SavedDriving, Start};
use crate::Record;
use crate::parameters::Scalar;

/// The simulation of an experiment.
pub type Run<E> = Simulation<<E as Experiment>::Rule, <E as Experiment>::Boundary>;

/// A system under study, given by its parameters: its simulation, its measurements, and the columns of its
/// tables.
///
/// An experiment is your own serializable type. Its fields are the parameters, which a [`Plan`](super::Plan)
/// sets by name (`"friction"`, `"base.amplitude"`), and its methods say what the parameters mean. With
/// `#[serde(deny_unknown_fields)]`, any misspelled name in a plan is an error. Without this attribute, a
/// misspelled name is an error only if it is the name of a parameter that varies.
/// [`VibratedBox`](super::vibrated_box::VibratedBox) is one such type.
///
/// # Contract
/// 1. All methods are functions of the parameters and their arguments: they use no clock and no other random
///    numbers. The files of a study therefore have the same bytes, however often it is interrupted.
/// 2. [`rule`](Self::rule) and [`boundary`](Self::boundary) return the rule and the walls of the simulation
///    that [`build`](Self::build) makes, since a run is resumed with this rule and these walls.
/// 3. Samples and the observer must read back as they were written. The format is binary, without names of
///    fields, so their types must not have `#[serde(untagged)]`, `flatten`, or `skip_serializing_if`. A study
///    that cannot read them back ends with an error.
///
/// A *value* is the run at one value of the parameters. A study guarantees that it calls `sample` at the
/// times of the protocol, in order, and that the observer has by then seen everything since the end of
/// settling. When a run is interrupted, the study writes the observer and reads it back.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Smooth;
/// use granular_edmd::observable::{CollisionCounts, Snapshot};
/// use granular_edmd_study::{Axis, Column, Control, Experiment, ExperimentError, Plan, Protocol, Study};
/// use granular_edmd::{Disk, Fingerprint, initial};
/// use serde::{Deserialize, Serialize};
///
/// /// A gas that cools, in a closed box.
/// #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
/// #[serde(deny_unknown_fields)]
/// struct Cooling {
///     disks: usize,
///     loss: f64,
/// }
///
/// impl Experiment for Cooling {
///     type Rule = Smooth;
///     type Boundary = Container;
///     type Observer = ();
///     type Sample = f64;
///
///     fn revision() -> Fingerprint {
///         Fingerprint::of("Cooling 1")
///     }
///     fn rule(&self) -> Result<Smooth, ExperimentError> {
///         Ok(Smooth::from_inelasticity(self.loss)?)
///     }
///     fn boundary(&self) -> Result<Container, ExperimentError> {
///         Ok(Container::closed(20.0, 20.0)?)
///     }
///     fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
///         let disks = initial::lattice(&self.boundary()?, self.disks, 0.5)?;
///         Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
///     }
///     fn observer(&self) -> Result<(), ExperimentError> {
///         Ok(())
///     }
///     fn sample(&self, snapshot: &Snapshot<'_>, _: &mut ()) -> f64 {
///         snapshot.mean(|disk| 0.5 * disk.velocity().length_squared())
///     }
///     fn columns() -> Vec<Column<Self>> {
///         vec![Column::sampled("energy", "energy", |energy| *energy)]
///     }
/// }
///
/// let plan = Plan::new(Cooling { disks: 50, loss: 0.0 }, Protocol::new(0, 5, 1)?, 1)?;
/// let plan = plan.with_axis(Axis::new("loss", [0.0, 0.1])?)?;
/// # let folder = std::env::temp_dir().join(format!("granular-edmd-experiment-{}", std::process::id()));
/// let study = Study::open_or_create(&folder, &plan)?;
/// study.run(&Control::default())?;
/// let last = |ramp| Ok::<_, ExperimentError>(study.record(ramp, 0)?.ok_or("not done")?.samples()[4]);
/// assert!(last(1)? < last(0)?);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an experiment",
    label = "an `Experiment` is expected here",
    note = "implement `Experiment` for the type whose fields are your parameters"
)]
#[expect(unused_variables, reason = "what is shown need not be looked at")]
pub trait Experiment: Clone + Serialize + DeserializeOwned + Send + Sync {
    /// Type of the collision rule.
    type Rule: CollisionRule;
    /// Type of the walls.
    type Boundary: Boundary;
    /// Type of the observer; `()` for none. A field that serde skips is not saved: no state may stand in it.
    type Observer: Observer + Serialize + DeserializeOwned;
    /// Type of a sample's data: numbers, lists, or any other type that can be serialized.
    type Sample: Serialize + DeserializeOwned;

    /// Returns the meanings of parameters and columns by name, with units, ranges and defaults.
    ///
    /// The command `explain` prints the meanings. A new plan shows them as comments, also those of parameters
    /// that the plan leaves out. By default, there are none.
    fn meanings() -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// Returns the revision of this type's code. A study stores the revision, and compares it whenever it is
    /// opened.
    ///
    /// Values from different code must not be mixed, so a study with another revision is refused.
    /// `Fingerprint::of(include_str!("main.rs"))`, with the name of the file that contains the experiment,
    /// changes by itself with every edit of the file, even of a comment. `Fingerprint::of("Cooling 2")`
    /// changes when you raise the number: do so whenever the rule, walls, disks, observer or sample give
    /// other numbers than before. Code in other files, and in other crates, is covered only if you add it
    /// with [`Fingerprint::text`]. A study also compares the names and units of all columns, and the number
    /// [`RESULTS`](granular_edmd::RESULTS) of the engine.
    fn revision() -> Fingerprint;

    /// Returns the collision rule that these parameters define.
    ///
    /// # Errors
    /// If the parameters do not give a rule.
    fn rule(&self) -> Result<Self::Rule, ExperimentError>;

    /// Returns the walls that these parameters define.
    ///
    /// # Errors
    /// If the parameters do not give walls.
    fn boundary(&self) -> Result<Self::Boundary, ExperimentError>;

    /// Returns the disks at the start. [`build`](Self::build) passes the seed of the ramp.
    ///
    /// All parts of a run may take this seed, since they draw from separate
    /// [streams](granular_edmd::random).
    ///
    /// A plan can ask for any number of disks: refuse a number that does not fit into memory before you
    /// allocate a vector for it.
    ///
    /// # Errors
    /// If the disks do not fit.
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError>;

    /// Returns gravity. `into` converts a number into gravity that points down.
    fn gravity(&self) -> Gravity {
        Gravity::NONE
    }

    /// Returns the duration of a cycle, the unit of time of a [`Protocol`](super::Protocol), such as the
    /// period of a vibrating base.
    ///
    /// The first value of a ramp counts cycles from time 0. A value whose cycle differs from the previous
    /// value's counts cycles from its own start. At this time, the walls may be at any phase.
    fn cycle(&self) -> f64 {
        1.0
    }

    /// Returns the observer at the start of a value.
    ///
    /// # Errors
    /// If these parameters do not give one.
    fn observer(&self) -> Result<Self::Observer, ExperimentError>;

    /// Returns a sample of the present state.
    ///
    /// The method may read the observer. It may also reset the observer for the next interval, or let it
    /// accumulate over all samples.
    fn sample(&self, snapshot: &Snapshot<'_>, observer: &mut Self::Observer) -> Self::Sample;

    /// Returns the driving of a value, which kicks all disks at set times, or `None`.
    ///
    /// Each value has a separate driving with a separate seed. The driving begins with the value and is saved
    /// with it. Observers see the end and the start of a run at each kick, as in
    /// [`run_driven`](granular_edmd::Simulation::run_driven).
    ///
    /// # Errors
    /// If these parameters do not give one.
    fn driving(&self, seed: u64) -> Result<Option<Box<dyn SavedDriving>>, ExperimentError> {
        Ok(None)
    }

    /// Returns a companion: an additional observer that is not saved, such as a recorder, a closure or a
    /// channel.
    ///
    /// The companion sees the whole value, including its settling. A value that continues after an
    /// interruption gets a new companion. A companion's verdict counts like the observer's, so the verdict
    /// must follow from the run alone. Commands that play a value again, such as `replay`, make no companion.
    ///
    /// # Errors
    /// If the companion cannot be made: for example, it cannot write its file.
    fn companion(&self, start: &Start<'_>) -> Result<Option<Box<dyn Observer>>, ExperimentError> {
        Ok(None)
    }

    /// Returns the columns of the tables, each with its name, unit and value.
    fn columns() -> Vec<Column<Self>>;

    /// Returns additional tables, such as tables of profiles. The study writes them besides the tables of
    /// values and samples.
    fn tables() -> Vec<Table<Self>> {
        Vec::new()
    }

    /// Builds the simulation at the start of a ramp from the seed of the ramp.
    ///
    /// To repeat a run of a study, build it with the seed of its [`Record`].
    ///
    /// # Errors
    /// If the rule, the walls, the disks or the simulation cannot be made.
    fn build(&self, seed: u64) -> Result<Run<Self>, ExperimentError> {
        Ok(Simulation::builder(self.rule()?, self.boundary()?)
            .disks(self.disks(seed)?)
            .gravity(self.gravity())
            .seed(seed)
            .build()?)
    }

    /// Changes a simulation from the previous value's parameters to these parameters.
    ///
    /// By default, the simulation gets the rule, walls and gravity of these parameters. Walls with the same
    /// fingerprint stay unchanged. Walls that react, such as a [`Piston`](granular_edmd::wall::Piston), keep
    /// their present positions and velocities, whatever initial ones these parameters give.
    ///
    /// # Errors
    /// If the disks do not fit into the walls, or the new walls that react cannot take over the present
    /// state: there are more or fewer of them, or a piston is beyond its new stops.
    fn change(&self, simulation: &mut Run<Self>) -> Result<(), ExperimentError> {
        simulation.set_rule(self.rule()?);
        let mut boundary = self.boundary()?;
        let is_same =
            boundary.fingerprint().is_some_and(|new| Some(new) == simulation.boundary().fingerprint());
        if !is_same {
            if !simulation.boundary().state().is_empty() {
                // This makes the present the time origin, and the state the present one.
                simulation.set_gravity(self.gravity())?;
                boundary.set_time_origin(simulation.time());
                boundary.set_state(&simulation.boundary().state())?;
            }
            simulation.set_boundary(boundary)?;
        }
        if self.gravity() != simulation.gravity() {
            simulation.set_gravity(self.gravity())?;
        }
        Ok(())
    }

    /// Checks that the parameters are valid.
    ///
    /// A plan calls this before anything runs, for all values, or for a selection of 1024 if there are more.
    /// A run calls it for each value that it begins.
    ///
    /// # Errors
    /// If the parameters are not valid.
    fn check(&self) -> Result<(), ExperimentError> {
        self.rule()?;
        self.boundary()?;
        self.observer()?;
        self.gravity().checked()?;
        positive("cycle", self.cycle())?;
        Ok(())
    }

    /// Returns whether this parameter (by its full name, such as `base.amplitude`) may change while the disks
    /// stay in place. Return false for a frequency.
    fn can_be_ramped(parameter: &str) -> bool {
        true
    }

    /// Returns the name of the state in a record, for a refined ramp
    /// ([`Ramp::with_refinement`](super::Ramp::with_refinement)); `None` if the record shows no state.
    fn state(record: &Record<Self>) -> Option<String> {
        None
    }
}

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
