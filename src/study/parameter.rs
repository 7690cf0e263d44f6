//! The parameters that a study varies.

use std::fmt;

/// A control parameter of a [`System`](super::System), by its name in a study file.
///
/// ```
/// use granular_edmd::study::Parameter;
/// assert_eq!(Parameter::ContactDuration.to_string(), "contact_duration");
/// assert!(Parameter::Friction.can_be_ramped() && !Parameter::Width.can_be_ramped());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Parameter {
    /// Friction `$\kappa$`: static, and dynamic unless the system gives that for itself.
    Friction,
    /// Dynamic friction `$\kappa_d$`.
    DynamicFriction,
    /// Inelasticity `$q$`: normal, and tangential unless the system gives that for itself.
    Inelasticity,
    /// Tangential inelasticity `$q_t$`.
    TangentialInelasticity,
    /// Gravity `$g$`.
    Gravity,
    /// Amplitude `$A$` of an oscillating base.
    Amplitude,
    /// Angular frequency `$\omega$` of an oscillating base.
    AngularFrequency,
    /// Temperature `$T_0$` of a thermal base.
    Temperature,
    /// Contact duration `$t_c$`.
    ContactDuration,
    /// Width `$L_x$`.
    Width,
    /// Height `$L_y$`.
    Height,
}

impl Parameter {
    /// Its name in study files and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::DynamicFriction => "dynamic_friction",
            Self::Inelasticity => "inelasticity",
            Self::TangentialInelasticity => "tangential_inelasticity",
            Self::Gravity => "gravity",
            Self::Amplitude => "amplitude",
            Self::AngularFrequency => "angular_frequency",
            Self::Temperature => "temperature",
            Self::ContactDuration => "contact_duration",
            Self::Width => "width",
            Self::Height => "height",
        }
    }

    /// Whether it can change with the disks in place: the size of the box cannot, and another frequency would make the
    /// base jump. Those vary between ramps, as an [`Axis`](super::Axis).
    pub const fn can_be_ramped(self) -> bool {
        !matches!(self, Self::AngularFrequency | Self::Width | Self::Height)
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}
