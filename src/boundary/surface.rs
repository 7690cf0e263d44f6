//! What a disk meets when it touches a wall.

use std::fmt;

use glam::DVec2;

use crate::ParameterError;
use crate::collision::CollisionRule;
use crate::quantity::positive;

/// The surface of a wall at the point of a touch.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// Unit vector from the wall to the disk.
    pub normal: DVec2,
    /// Velocity of the wall.
    pub velocity: DVec2,
    /// What the touch does to the disk.
    pub response: Response<'a>,
}

/// What a touch does to a disk.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub enum Response<'a> {
    /// The collision rule of the disks among themselves, with a partner of infinite mass.
    Shared,
    /// A rule of the wall's own, with a partner of infinite mass.
    Rule(&'a dyn CollisionRule),
    /// Thermal re-emission.
    Thermal(Thermal),
}

impl fmt::Debug for Response<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shared => formatter.write_str("Shared"),
            Self::Rule(_) => formatter.write_str("Rule(..)"),
            Self::Thermal(thermal) => formatter.debug_tuple("Thermal").field(thermal).finish(),
        }
    }
}

/// A stochastic wall: a disk that touches it leaves as if from a gas of this temperature at rest behind the wall.
///
/// The normal speed has the flux-weighted density `$(m v/T_0)\,e^{-m v^2/2T_0}$`; the tangential velocity and the
/// angular velocity are normal with variances `$T_0/m$` and `$T_0/I$`. The slip variant redraws the normal speed
/// only (the base of Ramírez, Risso, Cordero, PRL 85, 1230 (2000)).
///
/// ```
/// use granular_edmd::boundary::Thermal;
/// assert_eq!(Thermal::new(1.0)?.temperature(), 1.0);
/// assert!(Thermal::new(-1.0).is_err());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawThermal"))]
pub struct Thermal {
    temperature: f64,
    slip: bool,
}

impl Thermal {
    /// A wall of the temperature `$T_0$` for translation and rotation.
    ///
    /// # Errors
    /// If the temperature is not finite and positive.
    pub fn new(temperature: f64) -> Result<Self, ParameterError> {
        Ok(Self { temperature: positive("wall temperature", temperature)?, slip: false })
    }

    /// The same wall, leaving tangential and angular velocity as they are.
    pub const fn with_slip(self) -> Self {
        Self { slip: true, ..self }
    }

    /// `$T_0$`, in units of energy.
    pub const fn temperature(&self) -> f64 {
        self.temperature
    }

    /// Whether tangential and angular velocity are left as they are.
    pub const fn slip(&self) -> bool {
        self.slip
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, rename = "Thermal")]
struct RawThermal {
    temperature: f64,
    slip: bool,
}

#[cfg(feature = "serde")]
impl TryFrom<RawThermal> for Thermal {
    type Error = ParameterError;

    fn try_from(raw: RawThermal) -> Result<Self, ParameterError> {
        Ok(Self { slip: raw.slip, ..Self::new(raw.temperature)? })
    }
}
