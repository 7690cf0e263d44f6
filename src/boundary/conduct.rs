//! Responses of walls in owned form.

use std::fmt;
use std::sync::Arc;

use super::{Response, Thermal};
use crate::Fingerprint;
use crate::collision::CollisionRule;
#[cfg(feature = "serde")]
use crate::collision::KnownRule;

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
