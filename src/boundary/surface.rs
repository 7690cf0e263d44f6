//! Surfaces of walls: their normals, their velocities, and their responses to a touch, also in owned form.

use std::fmt;
use std::sync::Arc;

use glam::DVec2;

use crate::collision::CollisionRule;
#[cfg(feature = "serde")]
use crate::collision::KnownRule;
use crate::collision::laws::hostile_contacts;
use crate::quantity::positive;
use crate::{Fingerprint, Kind, ParameterError};

/// The surface of a wall at the point of a touch.
///
/// ```
/// use granular_edmd::boundary::{Response, Surface};
/// use granular_edmd::collision::Elastic;
/// use granular_edmd::glam::DVec2;
///
/// let belt = Surface::new(DVec2::Y, DVec2::new(0.3, 0.0));
/// assert!(matches!(belt.response, Response::Shared));
/// assert!(matches!(belt.with_response(Response::Rule(&Elastic)).response, Response::Rule(_)));
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Surface<'a> {
    /// Unit vector from the wall to the disk.
    pub normal: DVec2,
    /// Velocity of the wall.
    pub velocity: DVec2,
    /// Response to the touch.
    pub response: Response<'a>,
    /// Kind of the wall, which rules find in the contact.
    pub kind: Kind,
    /// Radius of the surface, for the contact that a rule sees: infinite for a straight surface, negative for
    /// a hollow one.
    pub radius: f64,
    /// Mass that resists along the normal; infinite unless the wall [reacts](super::Boundary::react).
    pub mass: f64,
    /// Angular velocity of the surface, counterclockwise.
    pub angular_velocity: f64,
}

impl<'a> Surface<'a> {
    /// Creates a straight surface with this unit normal and this velocity, which follows the rule of the
    /// disks and has the kind [`Kind::WALL`].
    #[inline]
    pub const fn new(normal: DVec2, velocity: DVec2) -> Self {
        Self {
            normal,
            velocity,
            response: Response::Shared,
            kind: Kind::WALL,
            radius: f64::INFINITY,
            mass: f64::INFINITY,
            angular_velocity: 0.0,
        }
    }

    /// Returns the same surface with another response.
    #[must_use]
    #[inline]
    pub const fn with_response(self, response: Response<'a>) -> Self {
        Self { response, ..self }
    }

    /// Returns the same surface with another kind.
    #[must_use]
    #[inline]
    pub const fn with_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// Returns the same surface with this radius: positive for the outside of a circle, negative for its
    /// inside.
    ///
    /// ```
    /// use granular_edmd::boundary::Surface;
    /// use granular_edmd::glam::DVec2;
    /// assert_eq!(Surface::new(DVec2::Y, DVec2::ZERO).radius, f64::INFINITY);
    /// assert_eq!(Surface::new(DVec2::Y, DVec2::ZERO).with_radius(-10.0).radius, -10.0);
    /// ```
    #[must_use]
    #[inline]
    pub const fn with_radius(self, radius: f64) -> Self {
        Self { radius, ..self }
    }

    /// Returns the same surface for a wall of this mass, which is guided along its normal.
    ///
    /// The rule then sees a reduced mass that is smaller than the mass of the disk, and the boundary receives
    /// the opposite impulse in [`react`](super::Boundary::react). Along its surface, the wall is held.
    #[must_use]
    #[inline]
    pub const fn with_mass(self, mass: f64) -> Self {
        Self { mass, ..self }
    }

    /// Returns the same surface for a wall that turns at this angular velocity, counterclockwise.
    ///
    /// Rolling friction acts on the spin of the disk relative to this angular velocity. The velocity of the
    /// surface is given separately.
    ///
    /// ```
    /// use granular_edmd::boundary::Surface;
    /// use granular_edmd::glam::DVec2;
    /// let drum = Surface::new(DVec2::Y, DVec2::new(3.6, 0.0)).with_radius(-9.0).with_angular_velocity(0.4);
    /// assert_eq!((drum.velocity.x, drum.angular_velocity), (3.6, 0.4));
    /// ```
    #[must_use]
    #[inline]
    pub const fn with_angular_velocity(self, angular_velocity: f64) -> Self {
        Self { angular_velocity, ..self }
    }
}

/// Response of a wall to a touch.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub enum Response<'a> {
    /// The wall follows the collision rule of the disks, as a partner with the mass of the surface.
    Shared,
    /// The wall follows its own rule, as a partner with the mass of the surface.
    Rule(&'a dyn CollisionRule),
    /// The wall re-emits the disk thermally.
    Thermal(Thermal),
    /// The wall takes the disk out of the run.
    ///
    /// Observers see a last collision, after which the disk has no spin, and moves with the wall: a wall
    /// without a mass takes all of the relative momentum, and a wall with a mass as much as gives both the
    /// same velocity. The spin is lost.
    Absorbing,
}

impl Response<'_> {
    /// Returns whether disks may push the wall along its surface. The rule of the disks is not known.
    pub(super) fn has_friction(&self) -> bool {
        match self {
            Self::Thermal(thermal) => !thermal.slip(),
            Self::Rule(rule) => hostile_contacts()
                .map(|contact| rule.impulse(&contact))
                .any(|impulse| impulse.tangential() != 0.0 || impulse.couple() != 0.0),
            Self::Shared | Self::Absorbing => true,
        }
    }
}

impl fmt::Debug for Response<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shared => formatter.write_str("Shared"),
            Self::Rule(_) => formatter.write_str("Rule(..)"),
            Self::Thermal(thermal) => formatter.debug_tuple("Thermal").field(thermal).finish(),
            Self::Absorbing => formatter.write_str("Absorbing"),
        }
    }
}

/// A thermal wall: a disk that touches it leaves like a disk from a gas at rest behind the wall, at the
/// wall's temperature.
///
/// The normal speed has the flux-weighted density $`(m v/T_0)\,e^{-m v^2/2T_0}`$; the tangential velocity and
/// the angular velocity are Gaussian with variances $`T_0/m`$ and $`T_0/I`$. The slip variant redraws only
/// the normal speed, as the base of Ramírez, Risso and Cordero, PRL 85, 1230 (2000), does.
///
/// A wall of mass $`M`$ recoils: the speed relative to it has this density for the reduced mass $`m M/(m +
/// M)`$, and the momentum along the normal is conserved. If the wall turns, the gas behind it turns with it,
/// and so do the disks that the wall emits.
///
/// ```
/// use granular_edmd::boundary::Thermal;
/// assert_eq!(Thermal::new(1.0)?.temperature(), 1.0);
/// assert!(Thermal::new(-1.0).is_err());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Thermal {
    temperature: f64,
    slip: bool,
}

impl Thermal {
    /// Creates a wall with the same temperature for translation and rotation.
    ///
    /// # Errors
    /// If the temperature is not finite and positive.
    pub fn new(temperature: f64) -> Result<Self, ParameterError> {
        Ok(Self { temperature: positive("wall temperature", temperature)?, slip: false })
    }

    /// Returns the same wall with slip: the tangential and the angular velocity stay unchanged.
    pub const fn with_slip(self) -> Self {
        Self { slip: true, ..self }
    }

    /// Returns the temperature, in units of energy.
    pub const fn temperature(&self) -> f64 {
        self.temperature
    }

    /// Returns whether the tangential and the angular velocity stay unchanged.
    pub const fn slip(&self) -> bool {
        self.slip
    }

    pub(super) fn fingerprint(&self) -> Fingerprint {
        Fingerprint::of(if self.slip { "Thermal with slip" } else { "Thermal" }).number(self.temperature())
    }
}

crate::gate::from_file! {
    Thermal { temperature: f64, slip: bool } => Ok(Self { slip, ..Self::new(temperature)? })
}

/// The response of a wall to a touch, in the owned form that a wall keeps. [`Response`] borrows it.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub(super) enum Conduct {
    #[default]
    Shared,
    Rule(OwnRule),
    Thermal(Thermal),
    /// Removes disks at their first touch.
    Absorbing,
    /// Removes disks when their centers reach the wall.
    AbsorbingCenters,
}

impl Conduct {
    pub(super) fn rule(rule: impl CollisionRule + Send + Sync + 'static) -> Self {
        Self::Rule(OwnRule(Arc::new(rule)))
    }

    #[inline]
    pub(super) fn response(&self) -> Response<'_> {
        match self {
            Self::Shared => Response::Shared,
            Self::Rule(own) => Response::Rule(&*own.0),
            Self::Thermal(thermal) => Response::Thermal(*thermal),
            Self::Absorbing | Self::AbsorbingCenters => Response::Absorbing,
        }
    }

    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        Some(match self {
            Self::Shared => Fingerprint::of("Shared"),
            Self::Rule(own) => Fingerprint::of("Rule").part(own.0.fingerprint()?),
            Self::Thermal(thermal) => thermal.fingerprint(),
            Self::Absorbing => Fingerprint::of("Absorbing"),
            Self::AbsorbingCenters => Fingerprint::of("AbsorbingCenters"),
        })
    }
}

/// A rule of any type. Files can hold the [known](CollisionRule::known) rules.
#[derive(Clone)]
pub(super) struct OwnRule(Arc<dyn CollisionRule + Send + Sync>);

impl fmt::Debug for OwnRule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("..")
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for OwnRule {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let own = "only the rules of granular-edmd, and remedies and tables of these, can be serialized";
        self.0.known().ok_or_else(|| serde::ser::Error::custom(own))?.serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for OwnRule {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        KnownRule::deserialize(deserializer).map(|rule| Self(Arc::new(rule)))
    }
}
