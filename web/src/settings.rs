//! What the sliders say, and what a simulation is made of.

use granular_edmd::ParameterError;
use granular_edmd::prelude::*;

/// The paper's box: number of disks of diameter 1, width and height.
pub const DISKS: usize = 1000;
pub const WIDTH: f64 = 60.0;
pub const HEIGHT: f64 = 150.0;

/// Contact duration, as a part of the time in which the base goes a diameter.
pub const CONTACT_DURATION: f64 = 1e-4;

/// The parameters that change while a simulation runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    pub friction: f64,
    pub inelasticity: f64,
    pub gravity: f64,
    pub amplitude: f64,
    pub angular_frequency: f64,
}

impl Settings {
    /// Returns the rule of these settings.
    ///
    /// # Errors
    /// If a number is out of its range.
    pub fn rule(&self) -> Result<ContactDuration<Frictional>, ParameterError> {
        let duration = CONTACT_DURATION / (self.amplitude * self.angular_frequency);
        ContactDuration::new(Frictional::new(self.inelasticity, self.friction)?, duration)
    }

    /// Returns the motion of the base.
    ///
    /// # Errors
    /// If a number is not finite and positive.
    pub fn base(&self) -> Result<BiParabolic, ParameterError> {
        BiParabolic::new(self.amplitude, self.angular_frequency)
    }

    /// Returns the box.
    ///
    /// # Errors
    /// If the base cannot move so.
    pub fn container(&self) -> Result<Container, Box<dyn std::error::Error>> {
        Ok(Container::closed(WIDTH, HEIGHT)?.with_motion(Wall::Floor, self.base()?)?)
    }

    /// Returns the duration of an oscillation.
    #[must_use]
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / self.angular_frequency
    }

    /// Tells whether the base moves in the same way.
    #[must_use]
    pub fn has_the_base_of(&self, other: &Self) -> bool {
        self.amplitude == other.amplitude && self.angular_frequency == other.angular_frequency
    }
}
