//! What is simulated.

use super::errors::SpecificationError;
use super::rule::Rule;
use super::{Base, Parameter, Sides};
use crate::boundary::{Container, Wall};
use crate::collision::{ContactDuration, Elastic, Frictional};
use crate::quantity::{accept, finite};
use crate::{Disk, ParameterError, initial};

/// Radius of the disks: their diameter and mass are the units.
const RADIUS: f64 = 0.5;

/// Most disks of a study.
const MOST_DISKS: usize = 1 << 24;

/// A box of equal disks as data: how many, how they collide, what moves them. Diameter and mass of a disk are the units.
///
/// Disks start on a lattice with Maxwellian velocities. Values are checked where the system enters a
/// [`Specification`](super::Specification).
///
/// ```
/// use granular_edmd::study::{Base, Parameter, System};
/// // The paper's vibrated box.
/// let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
/// let system = System::new(1000, 60.0, base)
///     .with_height(150.0)
///     .with_gravity(0.015625)
///     .with_friction(0.0605)
///     .with_contact_duration(1e-4);
/// assert_eq!(system.get(Parameter::Friction), Some(0.0605));
/// assert_eq!(system.get(Parameter::Temperature), None);
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct System {
    disks: usize,
    width: f64,
    height: Option<f64>,
    #[serde(default)]
    gravity: f64,
    #[serde(default)]
    inelasticity: f64,
    tangential_inelasticity: Option<f64>,
    #[serde(default)]
    friction: f64,
    dynamic_friction: Option<f64>,
    contact_duration: Option<f64>,
    #[serde(default = "one")]
    initial_temperature: f64,
    #[serde(default)]
    sides: Sides,
    base: Base,
}

const fn one() -> f64 {
    1.0
}

impl System {
    /// Smooth elastic disks in an open box without gravity, of initial temperature 1.
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
            contact_duration: None,
            initial_temperature: 1.0,
            sides: Sides::Hard,
            base,
        }
    }

    /// The same system under a lid at this height.
    pub const fn with_height(self, height: f64) -> Self {
        Self { height: Some(height), ..self }
    }

    /// The same system with this gravity.
    pub const fn with_gravity(self, gravity: f64) -> Self {
        Self { gravity, ..self }
    }

    /// The same system with the inelasticity `$q = q_n = q_t$`.
    pub const fn with_inelasticity(self, inelasticity: f64) -> Self {
        Self { inelasticity, tangential_inelasticity: None, ..self }
    }

    /// The same system with a tangential inelasticity `$q_t$` of its own.
    pub const fn with_tangential_inelasticity(self, tangential: f64) -> Self {
        Self { tangential_inelasticity: Some(tangential), ..self }
    }

    /// The same system with the friction `$\kappa = \kappa_s = \kappa_d$`.
    pub const fn with_friction(self, friction: f64) -> Self {
        Self { friction, dynamic_friction: None, ..self }
    }

    /// The same system with a dynamic friction `$\kappa_d$` of its own.
    pub const fn with_dynamic_friction(self, dynamic: f64) -> Self {
        Self { dynamic_friction: Some(dynamic), ..self }
    }

    /// The same system under the contact-duration model, [`ContactDuration`].
    pub const fn with_contact_duration(self, duration: f64) -> Self {
        Self { contact_duration: Some(duration), ..self }
    }

    /// The same system with these sides.
    pub const fn with_sides(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }

    /// The same system, started at this temperature.
    pub const fn with_initial_temperature(self, temperature: f64) -> Self {
        Self { initial_temperature: temperature, ..self }
    }

    /// How many disks there are.
    pub const fn disks(&self) -> usize {
        self.disks
    }

    /// What moves the disks.
    pub const fn base(&self) -> &Base {
        &self.base
    }

    /// The value of a parameter, if the system has it.
    pub fn get(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::Friction => Some(self.friction),
            Parameter::DynamicFriction => Some(self.dynamic_friction.unwrap_or(self.friction)),
            Parameter::Inelasticity => Some(self.inelasticity),
            Parameter::TangentialInelasticity => {
                Some(self.tangential_inelasticity.unwrap_or(self.inelasticity))
            }
            Parameter::Gravity => Some(self.gravity),
            Parameter::ContactDuration => self.contact_duration,
            Parameter::Width => Some(self.width),
            Parameter::Height => self.height,
            Parameter::Amplitude | Parameter::AngularFrequency | Parameter::Temperature => {
                self.base.get(parameter)
            }
        }
    }

    /// The same system with another value of a parameter.
    ///
    /// # Errors
    /// If the base has no such parameter.
    pub fn with(mut self, parameter: Parameter, value: f64) -> Result<Self, SpecificationError> {
        match parameter {
            Parameter::Friction => self.friction = value,
            Parameter::DynamicFriction => self.dynamic_friction = Some(value),
            Parameter::Inelasticity => self.inelasticity = value,
            Parameter::TangentialInelasticity => self.tangential_inelasticity = Some(value),
            Parameter::Gravity => self.gravity = value,
            Parameter::ContactDuration => self.contact_duration = Some(value),
            Parameter::Width => self.width = value,
            Parameter::Height => self.height = Some(value),
            Parameter::Amplitude | Parameter::AngularFrequency | Parameter::Temperature => {
                self.base = self.base.with(parameter, value)?;
            }
        }
        Ok(self)
    }

    /// A cycle, the unit of time of a protocol: a period of the base, or 1 if it does not oscillate.
    pub fn cycle(&self) -> f64 {
        self.base.period().unwrap_or(1.0)
    }

    pub(super) fn gravity(&self) -> Result<f64, ParameterError> {
        finite("gravity", self.gravity)
    }

    pub(super) fn rule(&self) -> Result<Rule, ParameterError> {
        let tangential = self.tangential_inelasticity.unwrap_or(self.inelasticity);
        let dynamic = self.dynamic_friction.unwrap_or(self.friction);
        let rule = Frictional::from_inelasticity(self.inelasticity, tangential)?
            .with_friction(self.friction, dynamic)?;
        Ok(match self.contact_duration {
            None => Rule::Plain(rule),
            Some(duration) => Rule::Lasting(ContactDuration::new(rule, duration)?),
        })
    }

    pub(super) fn container(&self) -> Result<Container, SpecificationError> {
        let container = match self.height {
            Some(height) => Container::closed(self.width, height)?,
            None => Container::open(self.width)?,
        };
        let container = match self.sides {
            Sides::Hard => container,
            Sides::Elastic => container.with_rule(Wall::Left, Elastic)?.with_rule(Wall::Right, Elastic)?,
            Sides::Periodic => container.with_periodic_sides(),
        };
        self.base.under(container)
    }

    pub(super) fn initial_disks(&self, seed: u64) -> Result<Vec<Disk>, SpecificationError> {
        let disks = initial::lattice(&self.container()?, self.disks, RADIUS)?;
        Ok(initial::with_maxwellian_velocities(disks, self.initial_temperature, seed)?)
    }

    /// Whether the walls of two systems are the same.
    pub(super) fn has_walls_of(&self, other: &Self) -> bool {
        (self.width, self.height, self.sides) == (other.width, other.height, other.sides)
            && self.base == other.base
    }

    /// That the disks fit in.
    pub(super) fn check_room(&self) -> Result<(), SpecificationError> {
        if self.disks == 0 {
            return Err(ParameterError::new("number of disks", "at least 1", 0.0).into());
        }
        // An open box has room for any number: a slip of the pen must not cost all memory.
        accept(self.disks <= MOST_DISKS, "number of disks", "at most 2^24", self.disks as f64)?;
        self.initial_disks(0).map(|_| ())
    }

    /// That everything in it has a meaning.
    pub(super) fn check(&self) -> Result<(), SpecificationError> {
        self.rule()?;
        self.gravity()?;
        self.container().map(|_| ())
    }
}
