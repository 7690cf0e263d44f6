//! The paper's system: equal disks in a box over a vibrating or hot base.
//!
//! [`VibratedBox`] is the experiment. It implements [`Experiment`] as a custom type would. A [`Sample`] holds
//! the measured quantities. A [`Record`] of the box has additional methods for the flow: order parameters,
//! densest layer, energy change and noise.

use std::sync::LazyLock;

use granular_edmd::boundary::{Container, Thermal, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Frictional, KnownRule};
use granular_edmd::observable::{
    Accumulator, CenterOfMass, Collision, ConvectionOrder, DenseLayer, Energies, EnergyChange, HeightProfile,
    Observable, Observer, OrderParameters, Snapshot, Temperatures,
};
use granular_edmd::quantity::accept;
use granular_edmd::statistics::{BlockedMean, Estimate};
use granular_edmd::wall::{BiParabolic, Sinusoidal, WallMotion};
use granular_edmd::{Disk, Fingerprint, Gravity, ParameterError, initial};

use super::analysis::StateCriteria;
use super::experiment::{Meanings, meanings};
use super::{Column, Experiment, ExperimentError, Record, Table};
use crate::analysis::thermal_noise;

/// The meanings of the parameters and of the columns of the tables.
static MEANINGS: Meanings = LazyLock::new(|| meanings(include_str!("vibrated_box/meanings.txt")));

/// Radius of the disks: their diameter and mass are the units.
const RADIUS: f64 = 0.5;

/// Largest number of disks in a box.
const MOST_DISKS: usize = 1 << 24;

/// A box of equal disks as data: their number, their collisions and their driving. Diameter and mass of a
/// disk are the units.
///
/// Other parameters are set as fields: `experiment.base_inelasticity = Some(0.0)`. Disks start on a lattice
/// with Maxwellian velocities. All parameters are checked when the box is put into a [`Plan`](super::Plan).
///
/// ```
/// use granular_edmd_study::vibrated_box::{Base, VibratedBox};
/// // The paper's vibrated box.
/// let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
/// let experiment = VibratedBox::new(1000, 60.0, base)
///     .with_height(150.0)
///     .with_gravity(0.015625)
///     .with_friction(0.0605)
///     .with_contact_duration(1e-4);
/// assert_eq!(experiment.friction, 0.0605);
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct VibratedBox {
    /// Number of disks.
    pub disks: usize,
    /// Width $`L_x`$.
    pub width: f64,
    /// Height $`L_y`$, or `None` without a lid.
    pub height: Option<f64>,
    /// Gravity $`g`$.
    #[serde(default)]
    pub gravity: f64,
    /// Inelasticity $`q`$: the normal one, and also the tangential one unless `tangential_inelasticity` is
    /// given.
    #[serde(default)]
    pub inelasticity: f64,
    /// Tangential inelasticity $`q_t`$, if it differs from $`q`$.
    pub tangential_inelasticity: Option<f64>,
    /// Friction $`\kappa`$: the static one, and also the dynamic one unless `dynamic_friction` is given.
    #[serde(default)]
    pub friction: f64,
    /// Dynamic friction $`\kappa_d`$, if it differs from $`\kappa`$.
    pub dynamic_friction: Option<f64>,
    /// Inelasticity of the walls, normal and tangential, if it differs from the disks'.
    pub wall_inelasticity: Option<f64>,
    /// Inelasticity of the base alone, if it differs from the walls'.
    pub base_inelasticity: Option<f64>,
    /// Tangential inelasticity $`q_t`$ of the base alone, if it differs from the normal inelasticity of the
    /// base.
    pub base_tangential_inelasticity: Option<f64>,
    /// Friction of the walls, static and dynamic, if it differs from the disks'.
    pub wall_friction: Option<f64>,
    /// Contact duration $`t_c`$, or `None` without the model [`ContactDuration`].
    pub contact_duration: Option<f64>,
    /// Temperature of the velocities at the start.
    #[serde(default = "one")]
    pub initial_temperature: f64,
    /// The sides.
    #[serde(default)]
    pub sides: Sides,
    /// Source of the motion of the disks.
    pub base: Base,
}

const fn one() -> f64 {
    1.0
}

impl VibratedBox {
    /// Creates an open box of smooth elastic disks without gravity, at the initial temperature 1.
    pub const fn new(disks: usize, width: f64, base: Base) -> Self {
        Self {
            disks,
            width,
            height: None,
            gravity: 0.0,
            inelasticity: 0.0,
            tangential_inelasticity: None,
            friction: 0.0,
            dynamic_friction: None,
            wall_inelasticity: None,
            base_inelasticity: None,
            base_tangential_inelasticity: None,
            wall_friction: None,
            contact_duration: None,
            initial_temperature: 1.0,
            sides: Sides::Hard,
            base,
        }
    }

    /// Returns the same box under a lid at this height.
    pub const fn with_height(self, height: f64) -> Self {
        Self { height: Some(height), ..self }
    }

    /// Returns the same box with this gravity.
    pub const fn with_gravity(self, gravity: f64) -> Self {
        Self { gravity, ..self }
    }

    /// Returns the same box with the inelasticity $`q = q_n = q_t`$.
    pub const fn with_inelasticity(self, inelasticity: f64) -> Self {
        Self { inelasticity, tangential_inelasticity: None, ..self }
    }

    /// Returns the same box with the friction $`\kappa = \kappa_s = \kappa_d`$.
    pub const fn with_friction(self, friction: f64) -> Self {
        Self { friction, dynamic_friction: None, ..self }
    }

    /// Returns the same box under the contact-duration model, [`ContactDuration`].
    pub const fn with_contact_duration(self, duration: f64) -> Self {
        Self { contact_duration: Some(duration), ..self }
    }

    /// Returns the rule of walls with these inelasticities, or `None` if the walls have the disks' rule.
    fn wall_rule(
        &self,
        normal: Option<f64>,
        tangential: Option<f64>,
    ) -> Result<Option<KnownRule>, ExperimentError> {
        if normal.or(tangential).or(self.wall_friction).is_none() {
            return Ok(None);
        }
        let mut walls = normal.into_iter().fold(self.clone(), Self::with_inelasticity);
        walls.tangential_inelasticity = tangential.or(walls.tangential_inelasticity);
        let walls = self.wall_friction.into_iter().fold(walls, Self::with_friction);
        walls.rule().map(Some)
    }
}

impl Experiment for VibratedBox {
    type Rule = KnownRule;
    type Boundary = Container;
    type Observer = Measurement;
    type Sample = Sample;

    /// The box is part of this crate, whose number `RESULTS` already changes when results do.
    fn revision() -> Fingerprint {
        Fingerprint::of("VibratedBox")
    }

    fn rule(&self) -> Result<KnownRule, ExperimentError> {
        let tangential = self.tangential_inelasticity.unwrap_or(self.inelasticity);
        let dynamic = self.dynamic_friction.unwrap_or(self.friction);
        let rule = Frictional::from_inelasticity(self.inelasticity, tangential, self.friction)?
            .with_dynamic_friction(dynamic)?;
        Ok(match self.contact_duration {
            None => rule.into(),
            Some(duration) => Box::new(ContactDuration::new(KnownRule::from(rule), duration)?).into(),
        })
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        let mut container = match self.height {
            Some(height) => Container::closed(self.width, height)?,
            None => Container::open(self.width)?,
        };
        if let Some(rule) = self.wall_rule(self.wall_inelasticity, None)? {
            let sides = [Wall::Left, Wall::Right].into_iter().filter(|_| self.sides != Sides::Periodic);
            for wall in sides.chain(self.height.map(|_| Wall::Lid)) {
                container = container.with_rule(wall, rule.clone())?;
            }
        }
        let base = self.base_inelasticity.or(self.wall_inelasticity);
        if let Some(rule) = self.wall_rule(base, self.base_tangential_inelasticity)? {
            container = container.with_rule(Wall::Floor, rule)?;
        }
        let container = match self.sides {
            Sides::Hard => container,
            Sides::Elastic => container.with_rule(Wall::Left, Elastic)?.with_rule(Wall::Right, Elastic)?,
            Sides::Periodic => container.with_periodic_sides()?,
        };
        self.base.under(container)
    }

    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        if self.disks == 0 {
            return Err(ParameterError::new("number of disks", "at least 1", 0.0).into());
        }
        // Without a lid, disks that fall upwards would never come back, and would rise ever farther.
        let stays = self.height.is_some() || self.gravity >= 0.0;
        accept(stays, "gravity of a box without a lid", "not negative", self.gravity)?;
        // An open box has room for any number of disks, so a limit keeps a mistyped number from using up all
        // memory.
        accept(self.disks <= MOST_DISKS, "number of disks", "at most 2^24", self.disks as f64)?;
        let disks = initial::lattice(&self.boundary()?, self.disks, RADIUS)?;
        Ok(initial::with_maxwellian_velocities(disks, self.initial_temperature, seed)?)
    }

    fn gravity(&self) -> Gravity {
        self.gravity.into()
    }

    /// Returns the period of the base, or 1 if the base does not oscillate.
    fn cycle(&self) -> f64 {
        self.base.period().unwrap_or(1.0)
    }

    fn observer(&self) -> Result<Measurement, ExperimentError> {
        Ok(Measurement::default())
    }

    fn sample(&self, snapshot: &Snapshot<'_>, measurement: &mut Measurement) -> Sample {
        measurement.sample(snapshot)
    }

    fn meanings() -> &'static [(&'static str, &'static str)] {
        &MEANINGS
    }

    /// No column has the name of a parameter, since the parameter could then not vary.
    fn columns() -> Vec<Column<Self>> {
        vec![
            Column::of_record("state", "", |record| Self::state(record).unwrap_or_default()),
            Column::sampled("one_roll", "velocity", |s: &Sample| s.one_roll),
            Column::averaged("one_roll_magnitude", "velocity", |s: &Sample| s.one_roll.abs()),
            Column::sampled("two_rolls", "velocity", |s: &Sample| s.two_rolls),
            Column::sampled("center_of_mass_height", "diameter", |s: &Sample| s.height),
            Column::sampled("translational_energy", "energy", |s: &Sample| s.translational_energy),
            Column::sampled("rotational_energy", "energy", |s: &Sample| s.rotational_energy),
            Column::sampled("vertical_temperature", "energy", |s: &Sample| s.vertical_temperature),
            Column::of_sample("collisions", "1", |s: &Sample| s.collisions),
            Column::of_sample("energy_change", "energy", Sample::known_change),
            Column::estimated("energy_change", "energy", Record::energy_change),
            Column::of_record("thermal_noise", "velocity", Record::thermal_noise),
            Column::of_record("densest_packing", "1", |record| {
                record.densest_layer().map_or(f64::NAN, |layer| layer.packing_fraction)
            }),
            Column::of_record("densest_height", "diameter", |record| {
                record.densest_layer().map_or(f64::NAN, |layer| layer.height)
            }),
            Column::of_record("collisions", "1", |record| record.counters().disk_collisions),
            Column::of_record("wall_collisions", "1", |record| record.counters().wall_collisions),
            Column::of_record("contact_duration_collisions", "1", |record| {
                record.counters().contact_duration_collisions
            }),
            Column::of_record("max_overlap", "diameter", |record| record.counters().max_overlap),
            Column::of_record("warnings", "1", |record| record.counters().warnings().len() as f64),
        ]
    }

    fn tables() -> Vec<Table<Self>> {
        vec![Table::new("profiles", [("layer_height", "diameter"), ("packing_fraction", "1")], |record| {
            record.profile().map(|(height, fraction)| vec![height, fraction]).collect()
        })]
    }

    /// Returns the name of the convective regime; `None` without samples.
    fn state(record: &Record<Self>) -> Option<String> {
        let (noise, layer) = (record.thermal_noise(), record.densest_layer());
        let criteria = StateCriteria::default().with_base_speed(record.experiment().base.speed());
        let found = criteria.and_then(|criteria| criteria.classify(&record.order(), noise, layer));
        found.ok().map(|found| found.regime().to_string())
    }

    /// Returns false for parameters that cannot change along a ramp: the size and the sides of the box, the
    /// number of disks, the initial temperature, `slip`, and the frequency, whose change would make the base
    /// jump.
    fn can_be_ramped(parameter: &str) -> bool {
        let name = parameter.rsplit('.').next().unwrap_or(parameter);
        let fixed = ["disks", "width", "height", "sides", "angular_frequency", "slip", "initial_temperature"];
        !fixed.contains(&name)
    }
}

/// The base of the box, which gives the disks their energy.
///
/// In a plan: `base.bi_parabolic = { amplitude = 0.1, angular_frequency = 10.0 }` or
/// `base.thermal = { temperature = 1.0 }`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Base {
    /// The paper's vibrating base, [`BiParabolic`].
    BiParabolic {
        /// $`A`$.
        amplitude: f64,
        /// $`\omega`$.
        angular_frequency: f64,
    },
    /// A true sine, [`Sinusoidal`].
    Sinusoidal {
        /// $`A`$.
        amplitude: f64,
        /// $`\omega`$.
        angular_frequency: f64,
    },
    /// A thermal base, [`Thermal`].
    Thermal {
        /// $`T_0`$.
        temperature: f64,
        /// True if collisions with the base change neither the tangential nor the angular velocity.
        #[serde(default)]
        slip: bool,
    },
}

/// The sides of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Sides {
    /// Walls under the collision rule of the disks.
    #[default]
    Hard,
    /// Smooth elastic walls.
    Elastic,
    /// No side walls: a disk that leaves on one side enters on the other.
    Periodic,
}

impl Base {
    fn period(&self) -> Option<f64> {
        match *self {
            Self::BiParabolic { angular_frequency, .. } | Self::Sinusoidal { angular_frequency, .. } => {
                BiParabolic::new(1.0, angular_frequency).ok()?.period()
            }
            Self::Thermal { .. } => None,
        }
    }

    /// Returns the typical speed that the base gives to disks of mass 1.
    fn speed(&self) -> f64 {
        match *self {
            Self::BiParabolic { amplitude, angular_frequency }
            | Self::Sinusoidal { amplitude, angular_frequency } => amplitude * angular_frequency,
            Self::Thermal { temperature, .. } => temperature.sqrt(),
        }
    }

    /// Returns the container whose floor is this base.
    fn under(&self, container: Container) -> Result<Container, ExperimentError> {
        Ok(match *self {
            Self::BiParabolic { amplitude, angular_frequency } => {
                container.with_motion(Wall::Floor, BiParabolic::new(amplitude, angular_frequency)?)?
            }
            Self::Sinusoidal { amplitude, angular_frequency } => {
                container.with_motion(Wall::Floor, Sinusoidal::new(amplitude, angular_frequency)?)?
            }
            Self::Thermal { temperature, slip } => {
                let thermal = Thermal::new(temperature)?;
                container.with_temperature(Wall::Floor, if slip { thermal.with_slip() } else { thermal })?
            }
        })
    }
}

/// Largest number of bins of a profile. A bin is one diameter high.
const MOST_BINS: usize = 65_536;

/// Height of the profile of an open box, in diameters.
const OPEN_PROFILE: f64 = 256.0;

/// One sample of a value.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Sample {
    /// $`\Psi_1`$.
    pub one_roll: f64,
    /// $`\Psi_2`$.
    pub two_rolls: f64,
    /// Height of the center of mass.
    pub height: f64,
    /// $`\langle\tfrac12 m v^2\rangle`$.
    pub translational_energy: f64,
    /// $`\langle\tfrac12 I\omega^2\rangle`$.
    pub rotational_energy: f64,
    /// $`T_y`$.
    pub vertical_temperature: f64,
    /// Number of disk–disk collisions since the previous sample.
    pub collisions: u64,
    /// Mean energy change in these collisions, or 0 without collisions.
    pub energy_change: f64,
}

impl Sample {
    /// Returns the mean energy change, NaN without collisions.
    const fn known_change(&self) -> f64 {
        if self.collisions == 0 { f64::NAN } else { self.energy_change }
    }
}

/// The observer of the box: energy changes since the last sample, and the profile of all samples.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    change: EnergyChange,
    samples: u64,
    /// The packing fraction by height, summed over the samples.
    profile: Vec<f64>,
}

impl Observer for Measurement {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.change.on_collision(collision);
    }
}

impl Measurement {
    /// Takes a sample, with the collisions since the previous sample.
    fn sample(&mut self, snapshot: &Snapshot<'_>) -> Sample {
        self.add_profile(snapshot);
        let change = std::mem::take(&mut self.change);
        let order = OrderParameters.measure(snapshot);
        let energies = Energies.measure(snapshot);
        Sample {
            one_roll: order.one_roll,
            two_rolls: order.two_rolls,
            height: CenterOfMass.measure(snapshot).y,
            translational_energy: energies.translational,
            rotational_energy: energies.rotational,
            vertical_temperature: Temperatures.measure(snapshot).vertical,
            collisions: change.disks().count(),
            energy_change: if change.disks().count() == 0 { 0.0 } else { change.disks().mean() },
        }
    }

    fn add_profile(&mut self, snapshot: &Snapshot<'_>) {
        let profile = profile(snapshot);
        self.samples += 1;
        self.profile.resize(profile.len(), 0.0);
        self.profile.iter_mut().zip(profile).for_each(|(sum, fraction)| *sum += fraction);
    }
}

/// Returns the packing fraction by height now.
fn profile(snapshot: &Snapshot<'_>) -> Vec<f64> {
    let top = snapshot.domain().top.min(MOST_BINS as f64);
    let bins = if snapshot.domain().top.is_finite() { top.ceil() } else { OPEN_PROFILE };
    let profile = HeightProfile::new(0.0, bins, bins as usize).and_then(|mut profile| {
        profile.add(snapshot)?;
        Ok(profile.iter().map(|(_, fraction)| fraction).collect())
    });
    // Creating the profile fails only for a height that is not positive, and a container's area is known.
    profile.unwrap_or_default()
}

/// Convection, layers and energy loss in a record of the box.
///
/// ```no_run
/// use granular_edmd_study::analysis::StateCriteria;
/// use granular_edmd_study::Study;
/// use granular_edmd_study::vibrated_box::VibratedBox;
///
/// for record in Study::<VibratedBox>::open("study")?.records() {
///     let record = record?;
///     let (noise, layer) = (record.thermal_noise(), record.densest_layer());
///     println!("{}", StateCriteria::default().classify(&record.order(), noise, layer)?.state());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl Record<VibratedBox> {
    /// Returns $`(\Psi_1, \Psi_2)`$ of each sample.
    pub fn order(&self) -> Vec<ConvectionOrder> {
        let order = |sample: &Sample| ConvectionOrder::new(sample.one_roll, sample.two_rolls);
        self.samples().iter().map(order).collect()
    }

    /// Returns the packing fraction by height, averaged over the samples: heights of the middles of bins of
    /// one diameter, and fractions.
    pub fn profile(&self) -> impl Iterator<Item = (f64, f64)> {
        let Measurement { samples, profile, .. } = self.observer();
        profile.iter().enumerate().map(|(bin, sum)| (bin as f64 + 0.5, sum / *samples as f64))
    }

    /// Returns the densest layer of the profile, or `None` without samples.
    pub fn densest_layer(&self) -> Option<DenseLayer> {
        DenseLayer::among(self.profile())
    }

    /// Returns the mean energy change in a collision of two disks, over all collisions.
    ///
    /// The mean is NaN without collisions, and the error is NaN if fewer than two samples have any.
    pub fn energy_change(&self) -> Estimate {
        let changes = self.samples().iter().map(Sample::known_change).filter(|change| !change.is_nan());
        if changes.clone().count() < 2 {
            return changes.collect::<BlockedMean>().estimate();
        }
        let collisions: f64 = self.samples().iter().map(|sample| sample.collisions as f64).sum();
        let total: f64 = self.samples().iter().map(|s| s.collisions as f64 * s.energy_change).sum();
        let mean = total / collisions;
        let per_sample = collisions / self.samples().len() as f64;
        // The error of a ratio is the error of the mean residual divided by the mean number of collisions.
        self.mean(|s| s.collisions as f64 * (s.energy_change - mean) / per_sample).about(mean)
    }

    /// Returns the standard deviation of $`\Psi_1`$ and $`\Psi_2`$ in a gas at rest with this temperature,
    /// $`\sqrt{T_y/2N}`$.
    pub fn thermal_noise(&self) -> f64 {
        let temperature = self.mean(|sample| sample.vertical_temperature).mean();
        thermal_noise(temperature, 1.0, self.experiment().disks).unwrap_or(f64::NAN)
    }
}
