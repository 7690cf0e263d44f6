//! Responses of walls in owned form.

use std::fmt;
use std::sync::Arc;

use super::{Response, Thermal};
use crate::Fingerprint;
use crate::collision::CollisionRule;

/// The response of a wall to a touch, in owned form. [`Response`] lends it out.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub(super) enum Conduct {
    #[default]
    Shared,
    Rule(OwnRule),
    Thermal(Thermal),
}

impl Conduct {
    pub(super) fn rule(rule: impl CollisionRule + Send + Sync + 'static) -> Self {
        Self::Rule(OwnRule::new(rule))
    }

    #[inline]
    pub(super) fn response(&self) -> Response<'_> {
        match self {
            Self::Shared => Response::Shared,
            Self::Rule(own) => Response::Rule(&*own.rule),
            Self::Thermal(thermal) => Response::Thermal(*thermal),
        }
    }

    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        Some(match self {
            Self::Shared => Fingerprint::of("Shared"),
            Self::Rule(own) => Fingerprint::of("Rule").part(own.rule.fingerprint()?),
            Self::Thermal(thermal) => thermal.fingerprint(),
        })
    }
}

/// A rule of any type.
///
/// A rule of the crate is known as such, and goes to files and back. A rule of your own cannot.
#[derive(Clone)]
pub(super) struct OwnRule {
    rule: Arc<dyn CollisionRule + Send + Sync>,
    #[cfg(feature = "serde")]
    known: Option<file::Known>,
}

impl OwnRule {
    fn new<R: CollisionRule + Send + Sync + 'static>(rule: R) -> Self {
        #[cfg(feature = "serde")]
        let known = file::Known::of(&rule);
        Self {
            rule: Arc::new(rule),
            #[cfg(feature = "serde")]
            known,
        }
    }
}

impl fmt::Debug for OwnRule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("..")
    }
}

/// Rules in files.
#[cfg(feature = "serde")]
mod file {
    use std::any::Any;

    use serde::ser::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::OwnRule;
    use crate::collision::{
        ContactDuration, Elastic, ElasticBelow, Frictional, LeastRebound, Rough, Smooth, SpeedDependent,
    };

    /// The rules of the crate.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case", rename = "Rule")]
    pub(super) enum Known {
        Elastic(Elastic),
        Smooth(Smooth),
        Rough(Rough),
        Frictional(Frictional),
        SmoothWithContactDuration(ContactDuration<Smooth>),
        RoughWithContactDuration(ContactDuration<Rough>),
        FrictionalWithContactDuration(ContactDuration<Frictional>),
        SpeedDependent(SpeedDependent),
        SpeedDependentWithContactDuration(ContactDuration<SpeedDependent>),
        SmoothWithElasticBelow(ElasticBelow<Smooth>),
        RoughWithElasticBelow(ElasticBelow<Rough>),
        FrictionalWithElasticBelow(ElasticBelow<Frictional>),
        SpeedDependentWithElasticBelow(ElasticBelow<SpeedDependent>),
        SmoothWithLeastRebound(LeastRebound<Smooth>),
        RoughWithLeastRebound(LeastRebound<Rough>),
        FrictionalWithLeastRebound(LeastRebound<Frictional>),
        SpeedDependentWithLeastRebound(LeastRebound<SpeedDependent>),
    }

    impl Known {
        pub(super) fn of(rule: &dyn Any) -> Option<Self> {
            rule.downcast_ref()
                .copied()
                .map(Self::Elastic)
                .or_else(|| rule.downcast_ref().copied().map(Self::Smooth))
                .or_else(|| rule.downcast_ref().copied().map(Self::Rough))
                .or_else(|| rule.downcast_ref().copied().map(Self::Frictional))
                .or_else(|| rule.downcast_ref().copied().map(Self::SmoothWithContactDuration))
                .or_else(|| rule.downcast_ref().copied().map(Self::RoughWithContactDuration))
                .or_else(|| rule.downcast_ref().copied().map(Self::FrictionalWithContactDuration))
                .or_else(|| rule.downcast_ref().copied().map(Self::SpeedDependent))
                .or_else(|| rule.downcast_ref().copied().map(Self::SpeedDependentWithContactDuration))
                .or_else(|| rule.downcast_ref().copied().map(Self::SmoothWithElasticBelow))
                .or_else(|| rule.downcast_ref().copied().map(Self::RoughWithElasticBelow))
                .or_else(|| rule.downcast_ref().copied().map(Self::FrictionalWithElasticBelow))
                .or_else(|| rule.downcast_ref().copied().map(Self::SpeedDependentWithElasticBelow))
                .or_else(|| rule.downcast_ref().copied().map(Self::SmoothWithLeastRebound))
                .or_else(|| rule.downcast_ref().copied().map(Self::RoughWithLeastRebound))
                .or_else(|| rule.downcast_ref().copied().map(Self::FrictionalWithLeastRebound))
                .or_else(|| rule.downcast_ref().copied().map(Self::SpeedDependentWithLeastRebound))
        }

        fn owned(self) -> OwnRule {
            match self {
                Self::Elastic(rule) => OwnRule::new(rule),
                Self::Smooth(rule) => OwnRule::new(rule),
                Self::Rough(rule) => OwnRule::new(rule),
                Self::Frictional(rule) => OwnRule::new(rule),
                Self::SmoothWithContactDuration(rule) => OwnRule::new(rule),
                Self::RoughWithContactDuration(rule) => OwnRule::new(rule),
                Self::FrictionalWithContactDuration(rule) => OwnRule::new(rule),
                Self::SpeedDependent(rule) => OwnRule::new(rule),
                Self::SpeedDependentWithContactDuration(rule) => OwnRule::new(rule),
                Self::SmoothWithElasticBelow(rule) => OwnRule::new(rule),
                Self::RoughWithElasticBelow(rule) => OwnRule::new(rule),
                Self::FrictionalWithElasticBelow(rule) => OwnRule::new(rule),
                Self::SpeedDependentWithElasticBelow(rule) => OwnRule::new(rule),
                Self::SmoothWithLeastRebound(rule) => OwnRule::new(rule),
                Self::RoughWithLeastRebound(rule) => OwnRule::new(rule),
                Self::FrictionalWithLeastRebound(rule) => OwnRule::new(rule),
                Self::SpeedDependentWithLeastRebound(rule) => OwnRule::new(rule),
            }
        }
    }

    impl Serialize for OwnRule {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let own = "a collision rule that is not of granular-edmd cannot be serialized";
            self.known.ok_or_else(|| S::Error::custom(own))?.serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for OwnRule {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            Known::deserialize(deserializer).map(Known::owned)
        }
    }
}
