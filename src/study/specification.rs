//! A study as data.

use std::fmt;

use super::errors::SpecificationError;
use super::{Axis, Leg, Parameter, Protocol, Ramp, System};
use crate::quantity::accept;

/// Most values of a study, all ramps together.
const MOST_VALUES: usize = 1_000_000;

/// Largest seed: a study file has no larger integers.
const LARGEST_SEED: u64 = i64::MAX as u64;

/// What a study does, as data: a system, how each value is sampled, what is ramped, and what is swept.
///
/// The axes of the sweep span a grid; each of its points is a ramp, independent of all others, and each step of a ramp
/// is a *value*. Without axes there is one ramp, without a ramp one value in each. A value is repeated on an axis to get
/// independent runs of it.
///
/// A point is a function of specification, index and seed alone. The seed of a ramp is
/// `$\mathrm{BLAKE3}(\text{seed}, \text{index})$`, the first eight bytes.
///
/// ```
/// use granular_edmd::study::{Parameter, Specification};
///
/// let specification = Specification::from_toml(
///     r#"
///     seed = 1
///     system = { disks = 100, width = 20.0, height = 50.0, gravity = 0.0156, base.bi_parabolic = { amplitude = 0.1, angular_frequency = 10.0 } }
///     protocol = { settle = 100, samples = 10, every = 10 }
///     ramp = { parameter = "friction", values = [0.01, 0.02, 0.03], course = "up_and_down" }
///     sweep = [{ parameter = "inelasticity", values = [0.0, 0.01] }]
///     "#,
/// )?;
/// assert_eq!((specification.ramps(), specification.values()), (2, 5));
/// assert_eq!(specification.system(1, 4)?.get(Parameter::Friction), Some(0.01));
/// assert_eq!(Specification::from_toml(&specification.to_toml()?)?, specification);
///
/// let error = Specification::from_toml("seed = 1\nsede = 2").unwrap_err();
/// assert!(error.to_string().contains("unknown field `sede`"));
/// # Ok::<(), granular_edmd::study::SpecificationError>(())
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "RawSpecification")]
pub struct Specification {
    seed: u64,
    system: System,
    protocol: Protocol,
    ramp: Option<Ramp>,
    sweep: Vec<Axis>,
}

impl Specification {
    /// A study of one system.
    ///
    /// # Errors
    /// If a value is out of range, the disks do not fit, or the seed is not below `$2^{63}$`.
    pub fn new(system: System, protocol: Protocol, seed: u64) -> Result<Self, SpecificationError> {
        Self { seed, system, protocol, ramp: None, sweep: Vec::new() }.checked()
    }

    /// The same study with a ramp in each point.
    ///
    /// # Errors
    /// If the parameter cannot be ramped, is swept, or is none of the system's, or its values are out of range or do not
    /// increase.
    pub fn with_ramp(self, ramp: Ramp) -> Result<Self, SpecificationError> {
        Self { ramp: Some(ramp), ..self }.checked()
    }

    /// The same study with one more axis; that of the last one changes fastest.
    ///
    /// # Errors
    /// If the parameter varies already or is none of the system's, or a value is out of range.
    pub fn with_axis(mut self, axis: Axis) -> Result<Self, SpecificationError> {
        self.sweep.push(axis);
        self.checked()
    }

    /// The study that a text in TOML describes.
    ///
    /// # Errors
    /// If it is not TOML, a field is unknown or missing, or a value is as it should not be; the error names it.
    pub fn from_toml(text: &str) -> Result<Self, SpecificationError> {
        toml::from_str(text).map_err(|error| SpecificationError::Toml(error.to_string()))
    }

    /// The study in TOML.
    ///
    /// # Errors
    /// If it cannot be written so.
    pub fn to_toml(&self) -> Result<String, SpecificationError> {
        toml::to_string(self).map_err(|error| SpecificationError::Toml(error.to_string()))
    }

    /// How values are sampled.
    pub const fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// The seed of all seeds.
    pub const fn seed(&self) -> u64 {
        self.seed
    }

    /// How many ramps there are.
    pub fn ramps(&self) -> usize {
        self.sweep.iter().map(|axis| axis.values().len()).product()
    }

    /// How many values each ramp has.
    pub fn values(&self) -> usize {
        self.ramp.as_ref().map_or(1, Ramp::len)
    }

    /// The parameters that vary: of the axes in their order, then of the ramp.
    pub fn varied(&self) -> impl Iterator<Item = Parameter> {
        let ramped = self.ramp.iter().map(Ramp::parameter);
        self.sweep.iter().map(Axis::parameter).chain(ramped)
    }

    /// The seed of a ramp.
    pub fn ramp_seed(&self, ramp: usize) -> u64 {
        derived_seed(self.seed, ramp as u64)
    }

    /// The way on which a value is come to; `None` without a ramp.
    pub fn leg(&self, value: usize) -> Option<Leg> {
        self.step(value).map(|(leg, _)| leg)
    }

    /// The system of a value.
    ///
    /// # Errors
    /// If there are not so many ramps or values.
    pub fn system(&self, ramp: usize, value: usize) -> Result<System, SpecificationError> {
        accept(ramp < self.ramps(), "index of a ramp", "below the number of ramps", ramp as f64)?;
        accept(value < self.values(), "index of a value", "below the number of values", value as f64)?;
        let mut rest = ramp;
        let mut system = self.system.clone();
        for axis in self.sweep.iter().rev() {
            system = system.with(axis.parameter(), axis.values()[rest % axis.values().len()])?;
            rest /= axis.values().len();
        }
        match (&self.ramp, self.step(value)) {
            (Some(ramp), Some((_, at))) => system.with(ramp.parameter(), at),
            _ => Ok(system),
        }
    }

    fn step(&self, value: usize) -> Option<(Leg, f64)> {
        self.ramp.as_ref().and_then(|ramp| ramp.at(value))
    }

    /// The specification, if it can be carried out.
    fn checked(self) -> Result<Self, SpecificationError> {
        accept(self.seed <= LARGEST_SEED, "seed", "below 2^63", self.seed as f64)?;
        self.protocol.check()?;
        self.ramp.iter().try_for_each(Ramp::check)?;
        self.sweep.iter().try_for_each(Axis::check)?;
        self.check_names()?;
        self.check_count()?;
        self.check_systems()?;
        Ok(self)
    }

    /// That no parameter varies twice.
    fn check_names(&self) -> Result<(), SpecificationError> {
        let varied: Vec<Parameter> = self.varied().collect();
        match varied.iter().enumerate().find(|&(index, parameter)| varied[..index].contains(parameter)) {
            Some((_, &parameter)) => Err(SpecificationError::VariesTwice { parameter }),
            None => Ok(()),
        }
    }

    fn check_count(&self) -> Result<(), SpecificationError> {
        let lengths = self.sweep.iter().map(|axis| axis.values().len()).chain([self.values()]);
        let count = lengths.map(|length| length as u128).fold(1_u128, u128::saturating_mul);
        if count > MOST_VALUES as u128 {
            return Err(SpecificationError::TooMany { count, most: MOST_VALUES });
        }
        Ok(())
    }

    /// That all systems have a meaning, and the disks fit into each box.
    fn check_systems(&self) -> Result<(), SpecificationError> {
        let mut roomy: Option<System> = None;
        for ramp in 0..self.ramps() {
            let first = self.system(ramp, 0)?;
            if !roomy.is_some_and(|system| system.has_walls_of(&first)) {
                first.check_room()?;
            }
            roomy = Some(first);
            (0..self.values()).try_for_each(|value| self.system(ramp, value)?.check())?;
        }
        Ok(())
    }
}

/// The study as in its file.
impl fmt::Display for Specification {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.to_toml().map_err(|_| fmt::Error)?)
    }
}

/// A seed for one of many things that need one.
pub(super) fn derived_seed(seed: u64, index: u64) -> u64 {
    let bytes = [seed.to_le_bytes(), index.to_le_bytes()].concat();
    let hash = blake3::hash(&bytes);
    let mut first = [0; 8];
    first.copy_from_slice(&hash.as_bytes()[..8]);
    u64::from_le_bytes(first)
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "Specification")]
struct RawSpecification {
    seed: u64,
    system: System,
    protocol: Protocol,
    ramp: Option<Ramp>,
    #[serde(default)]
    sweep: Vec<Axis>,
}

impl TryFrom<RawSpecification> for Specification {
    type Error = SpecificationError;

    fn try_from(raw: RawSpecification) -> Result<Self, SpecificationError> {
        let RawSpecification { seed, system, protocol, ramp, sweep } = raw;
        Self { seed, system, protocol, ramp, sweep }.checked()
    }
}
