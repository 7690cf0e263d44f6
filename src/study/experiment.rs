//! The trait of everything that can be studied.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::plan::derived_seed;
use super::{Column, Record, Table};
use crate::boundary::Boundary;
use crate::collision::CollisionRule;
use crate::observable::{Observer, Snapshot};
use crate::quantity::{finite, positive};
use crate::simulation::Checkpoint;
use crate::{Disk, Simulation};

/// A reason why an experiment cannot be: whatever error its parts gave.
pub type ExperimentError = Box<dyn std::error::Error + Send + Sync>;

/// The simulation of an experiment.
pub type Run<E> = Simulation<<E as Experiment>::Rule, <E as Experiment>::Boundary>;

/// A system to be studied, as the data of its parameters: what is simulated, what is measured, and what is
/// told of it.
///
/// A study is made of a serializable type of your own. Its fields are the parameters: a [`Plan`](super::Plan)
/// sets them by name (`"friction"`, `"base.amplitude"`), and its methods say what they mean. With
/// `#[serde(deny_unknown_fields)]` a slip of the pen in a plan is told; without, it is told only of
/// parameters that vary. [`VibratedBox`](super::vibrated_box::VibratedBox) is one such type.
///
/// # Contract
/// 1. All methods are functions of the parameters and their arguments: no clock, no other random numbers.
///    This is what makes the files of a study the same bytes, however they come about.
/// 2. [`rule`](Self::rule) and [`boundary`](Self::boundary) are what the simulation of [`build`](Self::build)
///    has: a run is resumed with them.
/// 3. Samples and observer read back as they were written, in a format that does not describe itself: no
///    `#[serde(untagged)]`, `flatten`, or `skip_serializing_if` in them. A study notices, and says so.
///
/// A study guarantees: `sample` is called at the times of the protocol, in order; the observer has seen
/// everything since the value has settled, and is kept, written and read back where a run is interrupted.
///
/// ```
/// use granular_edmd::boundary::Container;
/// use granular_edmd::collision::Smooth;
/// use granular_edmd::observable::{CollisionCounts, Snapshot};
/// use granular_edmd::study::{Axis, Column, Control, Experiment, ExperimentError, Plan, Protocol, Study};
/// use granular_edmd::{Disk, initial};
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
///     fn rule(&self) -> Result<Smooth, ExperimentError> {
///         Ok(Smooth::new(self.loss)?)
///     }
///     fn boundary(&self) -> Result<Container, ExperimentError> {
///         Ok(Container::closed(20.0, 20.0)?)
///     }
///     fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
///         let disks = initial::lattice(&self.boundary()?, self.disks, 0.5)?;
///         Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
///     }
///     fn sample(&self, snapshot: &Snapshot<'_>, _: &mut ()) -> f64 {
///         snapshot.mean(|disk| 0.5 * disk.velocity().length_squared())
///     }
///     fn columns() -> Vec<Column<Self>> {
///         vec![Column::sampled("energy", "energy", |energy| *energy)]
///     }
/// }
///
/// let plan = Plan::new(Cooling { disks: 50, loss: 0.0 }, Protocol::new(0, 5, 1), 1)?;
/// let plan = plan.with_axis(Axis::new("loss", [0.0, 0.1]))?;
/// # let folder = std::env::temp_dir().join(format!("granular-edmd-experiment-{}", std::process::id()));
/// let study = Study::open_or_create(&folder, &plan)?;
/// study.run(&Control::default())?;
/// let last = |ramp| Ok::<_, ExperimentError>(study.record(ramp, 0)?.ok_or("not done")?.samples()[4]);
/// assert!(last(1)? < last(0)?);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an experiment",
    label = "an `Experiment` is expected here",
    note = "implement `study::Experiment` for the type whose fields are your parameters"
)]
pub trait Experiment: Clone + Serialize + DeserializeOwned + Send + Sync {
    /// Rule of the collisions.
    type Rule: CollisionRule;
    /// The walls.
    type Boundary: Boundary;
    /// Observer of the collisions; `()` for none.
    type Observer: Observer + Default + Serialize + DeserializeOwned;
    /// Data kept of each moment of sampling: numbers, lists, anything that can be written.
    type Sample: Serialize + DeserializeOwned;

    /// Returns the rule of these parameters.
    ///
    /// # Errors
    /// If there is none.
    fn rule(&self) -> Result<Self::Rule, ExperimentError>;

    /// Returns the walls of these parameters.
    ///
    /// # Errors
    /// If there are none.
    fn boundary(&self) -> Result<Self::Boundary, ExperimentError>;

    /// Returns the disks at the start.
    ///
    /// # Errors
    /// If they do not fit.
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError>;

    /// Returns gravity, which points down.
    fn gravity(&self) -> f64 {
        0.0
    }

    /// Returns the time of a cycle, the unit of a [`Protocol`](super::Protocol): the period of what drives
    /// the disks.
    fn cycle(&self) -> f64 {
        1.0
    }

    /// Returns the observer that a value begins with.
    fn observer(&self) -> Self::Observer {
        Self::Observer::default()
    }

    /// Returns the sample of this moment. The observer may be read and changed: emptied for the interval
    /// until the next sample, or used to add up over all samples.
    fn sample(&self, snapshot: &Snapshot<'_>, observer: &mut Self::Observer) -> Self::Sample;

    /// Returns the columns of the tables, each said once: its name, its unit, and its value.
    fn columns() -> Vec<Column<Self>>;

    /// Returns tables beyond those of values and samples, of profiles for example.
    fn tables() -> Vec<Table<Self>> {
        Vec::new()
    }

    /// Builds the simulation of a first value.
    ///
    /// # Errors
    /// If that cannot be.
    fn build(&self, seed: u64) -> Result<Run<Self>, ExperimentError> {
        Ok(Simulation::builder(self.rule()?, self.boundary()?)
            .disks(self.disks(derived_seed(seed, 0))?)
            .gravity(self.gravity())
            .seed(derived_seed(seed, 1))
            .build()?)
    }

    /// Takes a simulation of other parameters, those of the value before, to these ones.
    ///
    /// Unless said otherwise, rule, walls and gravity become those of these parameters; walls that are the
    /// same, by their fingerprint, stay.
    ///
    /// # Errors
    /// If the disks do not fit into the walls.
    fn change(&self, simulation: &mut Run<Self>) -> Result<(), ExperimentError> {
        simulation.set_rule(self.rule()?);
        let boundary = self.boundary()?;
        let is_same =
            boundary.fingerprint().is_some_and(|new| Some(new) == simulation.boundary().fingerprint());
        if !is_same {
            simulation.set_boundary(boundary)?;
        }
        if self.gravity() != simulation.gravity() {
            simulation.set_gravity(self.gravity())?;
        }
        Ok(())
    }

    /// Checks that the parameters have a meaning. A plan asks for each of its values, before anything is run.
    ///
    /// # Errors
    /// If they do not.
    fn check(&self) -> Result<(), ExperimentError> {
        self.rule()?;
        self.boundary()?;
        finite("gravity", self.gravity())?;
        positive("cycle", self.cycle())?;
        Ok(())
    }

    /// Returns whether a parameter, by its whole name, can change with the disks in place.
    fn can_be_ramped(parameter: &str) -> bool {
        let _ = parameter;
        true
    }

    /// Checks what was read from a file, beyond its checksum, its place and its time: says why it cannot be
    /// of these parameters.
    ///
    /// # Errors
    /// The reason, if there is one.
    fn check_measured(
        &self,
        samples: &[Self::Sample],
        observer: &Self::Observer,
        state: &Checkpoint,
    ) -> Result<(), &'static str> {
        let _ = (samples, observer, state);
        Ok(())
    }

    /// Returns the name of the state that a record shows, for a ramp that is refined
    /// ([`Ramp::with_refinement`](super::Ramp::with_refinement)); `None` if it shows none.
    fn state(record: &Record<Self>) -> Option<String> {
        let _ = record;
        None
    }
}
