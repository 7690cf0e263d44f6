//! Settings of a run, and the plan by which they change.

use std::fmt;

use granular_edmd::ParameterError;
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::wall::BiParabolic;

/// What the sliders set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Friction $`\kappa`$, static and dynamic.
    pub friction: f64,
    /// Inelasticity $`q`$, normal and tangential.
    pub inelasticity: f64,
    /// Gravity $`g`$.
    pub gravity: f64,
    /// Amplitude $`A`$ of the base.
    pub amplitude: f64,
    /// Angular frequency $`\omega`$ of the base.
    pub angular_frequency: f64,
}

pub(crate) type Rule = ContactDuration<Frictional>;

impl Setting {
    /// Returns the motion of the base.
    pub(crate) fn base(&self) -> Result<BiParabolic, ParameterError> {
        BiParabolic::new(self.amplitude, self.angular_frequency)
    }

    /// Returns the rule, whose contact duration is this share of the time in which a disk with the speed of
    /// the base moves by its diameter.
    pub(crate) fn rule(&self, contact_duration: f64) -> Result<Rule, ParameterError> {
        self.base()?;
        let speed = self.amplitude * self.angular_frequency;
        ContactDuration::new(
            Frictional::from_inelasticity(self.inelasticity, self.inelasticity, self.friction)?,
            contact_duration / speed,
        )
    }

    /// Returns the temperature of the first velocities.
    pub(crate) fn temperature(&self) -> f64 {
        let speed = self.amplitude * self.angular_frequency;
        0.5 * speed * speed
    }

    fn parse(text: &str) -> Result<Self, Mistake> {
        let numbers = text.split(',').map(|number| number.trim().parse::<f64>());
        let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().map_err(|_| Mistake(text.to_owned()))?;
        let [friction, inelasticity, gravity, amplitude, angular_frequency] = numbers[..] else {
            return Err(Mistake(text.to_owned()));
        };
        Ok(Self { friction, inelasticity, gravity, amplitude, angular_frequency })
    }
}

/// The first setting, and the whole oscillations after which others follow.
///
/// As text, and in the address of the page: `0:κ,q,g,A,ω;N:κ,q,g,A,ω;…`.
///
/// ```
/// let plan: rolls::Plan = "0:0.03,0,0.015625,0.1,10;600:0.08,0,0.015625,0.1,10".parse()?;
/// assert_eq!(plan.first().friction, 0.03);
/// assert_eq!(plan.later()[0].0, 600);
/// assert!("5:0.03".parse::<rolls::Plan>().is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    first: Setting,
    later: Vec<(u64, Setting)>,
}

impl Plan {
    /// Returns the setting at the start.
    pub const fn first(&self) -> &Setting {
        &self.first
    }

    /// Returns the settings that follow, each with its oscillation.
    pub fn later(&self) -> &[(u64, Setting)] {
        &self.later
    }
}

impl std::str::FromStr for Plan {
    type Err = Mistake;

    fn from_str(text: &str) -> Result<Self, Mistake> {
        let step = |text: &str| {
            let mistake = || Mistake(text.to_owned());
            let (when, setting) = text.split_once(':').ok_or_else(mistake)?;
            Ok((when.trim().parse::<u64>().map_err(|_| mistake())?, Setting::parse(setting)?))
        };
        let steps: Vec<(u64, Setting)> = text.split(';').map(step).collect::<Result<_, Mistake>>()?;
        let ascends = steps.windows(2).all(|pair| pair[0].0 < pair[1].0);
        match steps.split_first() {
            Some((&(0, first), later)) if ascends => Ok(Self { first, later: later.to_vec() }),
            _ => Err(Mistake(text.to_owned())),
        }
    }
}

/// A text that is no plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Mistake(String);

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "no plan of the form 0:κ,q,g,A,ω;N:κ,q,g,A,ω with ascending N: {:?}", self.0)
    }
}

impl std::error::Error for Mistake {}
